#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "host/metrics.h"
#include "record/log_writer.h"
#include "record/recorder.h"
#include "scene/scene.h"

namespace weft::host {

class LiveScene;

/// For so long a viewer whose connection broke, or who was there before a restart, is waited for.
inline constexpr auto kSeatKept = std::chrono::seconds(5);

/// Where what happens in a scene is written down.
struct LogPlaces {
  std::filesystem::path record;  ///< a file that has all from when it is begun on; empty: none
  std::filesystem::path data;    ///< a folder with what it takes to go on after a restart; empty: none
  bool made = false;             ///< the scene is a client's, made while the server runs
  bool empty() const { return record.empty() && data.empty(); }
};

/// Writes down what happens in one scene. The folder of its data has files that each begin with a state and
/// go on with what was done after it; a new one is begun every second, and three are kept. Used by the
/// scene's thread alone; disks are waited for by another.
class SceneLog {
 public:
  static constexpr auto kStatePeriod = std::chrono::seconds(1);
  static constexpr std::size_t kKept = 3;
  /// Between what is written of a recording while nobody commands anything.
  static constexpr auto kRecordPeriod = std::chrono::milliseconds(250);
  /// Simulated, from one state in a recording to the next, s: it is gone to a time in it by way of these.
  static constexpr double kRecordedStates = 10;

  SceneLog(const scene::Scene& scene, LogPlaces places, SceneMetrics& metrics);

  /// Goes on from where the data end, if there are any of this scene and this build; files that are not are
  /// set aside, by another name. Then begins to write, and returns when its first state is there, so that no
  /// epoch comes twice.
  void begin(LiveScene& live);
  /// Writes down what has happened since the last call; `served`: by a command, perhaps beside the
  /// simulation, too.
  void tend(LiveScene& live, bool served);
  /// Its last state.
  void end(LiveScene& live);
  /// Its data are removed; nothing more is written.
  void forget();

 private:
  /// False if there was nothing to go on from.
  bool restore(LiveScene& live);
  bool go_on_from(LiveScene& live, const std::filesystem::path& file);
  /// Returns it; it is there once the writer has come to it.
  std::filesystem::path begin_file(LiveScene& live);
  std::shared_ptr<record::Recorder> recorder(record::LogWriter& writer, bool of_data) const;
  std::unique_ptr<record::LogWriter> writer(const char* what, std::size_t kept);

  const scene::Scene scene_;  ///< for its name, document and folder
  const LogPlaces places_;
  SceneMetrics& metrics_;
  std::unique_ptr<record::LogWriter> record_writer_, data_writer_;
  std::shared_ptr<record::Recorder> recording_, data_;
  const std::uint64_t recorded_steps_;  ///< kRecordedStates
  std::uint64_t next_recorded_state_;
  std::uint64_t next_file_ = 1;
  std::chrono::steady_clock::time_point state_due_{}, record_due_{};
  std::string service_;         ///< as it was written last
  std::uint64_t steps_at_ = 0;  ///< of the simulation, when the last state was written
  bool changed_ = false;        ///< by commands, since then
};

/// Scenes in a folder of data that clients made: their names and documents.
struct KeptScene {
  std::string name, document;
};
std::vector<KeptScene> made_scenes_in(const std::filesystem::path& data);
/// Returns when a scene's folder of data has a state, or after 2 s, as on a disk that is full.
void wait_until_kept(const std::filesystem::path& folder);
/// From now on it is no scene's, whatever happens; its SceneLog removes it (forget()).
void set_gone(const std::filesystem::path& folder);
/// What a process that was killed did not come to remove.
void remove_gone(const std::filesystem::path& data);

}  // namespace weft::host
