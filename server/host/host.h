#pragma once
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "host/metrics.h"
#include "host/scene_runner.h"

namespace weft::host {

/// The scenes being served, by name. Fill it first; after that every method may be called from any thread.
class Host {
 public:
  explicit Host(const protocol::Limits& limits = {}, const std::string& version = "");
  /// Interrupts all scenes' steps, and waits for their threads.
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  /// Throws std::invalid_argument if there is a scene of that name already.
  void add(scene::Scene scene);
  /// The scene of that name, or nullptr.
  SceneRunner* find(std::string_view name) const;
  const std::vector<std::unique_ptr<SceneRunner>>& scenes() const { return scenes_; }
  const protocol::Limits& limits() const { return limits_; }
  Metrics& metrics() { return metrics_; }

  /// `[{"name","title","viewers","cloths"}]`, in the order they were added.
  nlohmann::json list() const;

 private:
  protocol::Limits limits_;
  Metrics metrics_;  // before the scenes, which count in it
  std::vector<std::unique_ptr<SceneRunner>> scenes_;
};

}  // namespace weft::host
