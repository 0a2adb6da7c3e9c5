#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/metrics.h"
#include "host/scene_runner.h"

namespace weft::host {

/// What scenes made by clients may cost, all together or each. Beyond them a scene is not made.
struct MakingLimits {
  std::size_t scenes = 16;                            ///< at a time
  std::size_t document_bytes = std::size_t{4} << 20;  ///< of one
  long nodes = 200'000;                               ///< of all of them, at their finest levels
  std::size_t colliders = 256;                        ///< balls and obstacles of one
  double work = 5e6;  ///< of its first step, in units of WorkLimit (interrupt.h), 20 ns
};

/// What is written down of all scenes.
struct LogFolders {
  std::filesystem::path record;  ///< a file NAME.weftrec of each scene, from its start on; empty: none
  std::filesystem::path data;    ///< a folder NAME of each scene, to go on from; empty: none
};

/// Why a scene was not made, for people and programs.
struct NotMade {
  enum class Why { bad_name, exists, too_large, full, problems, too_costly } why;
  std::string text;                      ///< a sentence
  std::vector<scene::Problem> problems;  ///< of its document
};

/// The scenes being served, by name. Every method may be called from any thread.
class Host {
 public:
  explicit Host(const protocol::Limits& limits = {}, const std::string& version = "",
                const MakingLimits& making = {}, const LogFolders& folders = {});
  /// Interrupts all scenes' steps, and waits for their threads.
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  /// One of the server's own. Throws std::invalid_argument if there is a scene of that name already.
  void add(scene::Scene scene);
  /// One that shows a recording, whose scene it is. Throws as add() and Recording::scene().
  void play(const Playing& playing);
  /// Those in the folder of data that clients have made.
  void restore_made();
  /// A client's, from a document as `weft check` reads it. May take a second: its first step is tried.
  std::optional<NotMade> make(const std::string& name, std::string_view document);
  enum class Ending { ended, unknown, own };
  /// Ends one that a client made: it steps no more, and is gone when its viewers are.
  Ending end(std::string_view name);

  /// The scene of that name, or nullptr.
  std::shared_ptr<SceneRunner> find(std::string_view name) const;
  /// In the order they were added.
  std::vector<std::shared_ptr<SceneRunner>> scenes() const;
  const protocol::Limits& limits() const { return limits_; }
  const MakingLimits& making() const { return making_; }
  /// Names this run of the server.
  const std::string& instance() const { return instance_; }
  Metrics& metrics() { return metrics_; }

  /// `[{"name","title","viewers","cloths"}]`, in the order they were added.
  nlohmann::json list() const;

 private:
  struct Served {
    std::shared_ptr<SceneRunner> runner;
    std::optional<long> nodes;  ///< of a client's
  };
  // These need mutex_.
  std::optional<NotMade> refusal(const std::string& name, long nodes) const;
  bool taken(std::string_view name) const;
  void start(scene::Scene scene, std::optional<long> nodes);

  const protocol::Limits limits_;
  const MakingLimits making_;
  const std::string instance_;
  const LogFolders folders_;
  Metrics metrics_;  // before the scenes, which count in it
  mutable std::mutex mutex_;
  std::vector<Served> scenes_;
  std::map<std::string, std::weak_ptr<SceneRunner>, std::less<>> ending_;  ///< that have viewers still
};

}  // namespace weft::host
