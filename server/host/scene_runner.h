#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "host/metrics.h"
#include "host/playing.h"
#include "host/scene_log.h"
#include "host/scene_request.h"
#include "host/step_clock.h"
#include "host/viewer.h"
#include "scene/scene.h"

namespace weft::host {

class LiveScene;
class StudyThread;

/// Runs one scene on a thread of its own: in real time, and while it is paused the steps asked for as fast as
/// they go. Every method may be called from any thread and returns at once: what is asked waits for the next
/// step boundary. With no viewers the scene sleeps.
class SceneRunner {
 public:
  /// Requests that may wait for the step boundary.
  static constexpr std::size_t kMaxWaiting = 1024;

  /// Counts in `metrics`, which must outlive it. `playing`: as in LiveScene.
  SceneRunner(scene::Scene scene, const protocol::Limits& limits, Metrics& metrics,
              const LogPlaces& places = {}, const std::optional<Playing>& playing = {});
  /// Interrupts the step in hand, and waits for the thread.
  ~SceneRunner();
  SceneRunner(const SceneRunner&) = delete;
  SceneRunner& operator=(const SceneRunner&) = delete;

  const std::string& name() const { return name_; }
  const std::string& title() const { return title_; }
  std::size_t cloths() const { return cloths_; }
  int viewers() const { return viewers_; }
  /// What /v1/scenes/NAME/meshes/`obstacle` answers; nullptr if that is not the number of a mesh.
  std::shared_ptr<const std::string> mesh(std::size_t obstacle) const {
    return obstacle < meshes_.size() ? meshes_[obstacle] : nullptr;
  }
  /// Steps since the epoch began.
  std::uint64_t frame() const { return frame_; }
  /// Simulated, s.
  double time() const { return static_cast<double>(frame()) * time_step_; }
  /// Records encoded since the scene was loaded: one a cloth, level and frame, however many viewers there
  /// are.
  std::uint64_t encodes() const { return encodes_; }

  /// The thread ends soon, within a step. Nothing is stepped or sent from then on.
  void request_stop() { thread_.request_stop(); }
  /// It has ended for good: its data go with it. Before request_stop().
  void forget() { forgotten_ = true; }
  /// For how long its thread has been busy without coming to a step boundary; 0 while it waits for the next.
  std::chrono::steady_clock::duration busy_for() const;

  /// Takes one of the scene's places for viewers; false if all are taken.
  bool reserve();
  /// Gives a place back.
  void give_back() { --viewers_; }
  /// The viewer, for whom there is a place, comes in as `visit`.
  void join(std::shared_ptr<Viewer> viewer, std::uint64_t visit);
  /// It leaves. Commands it gave before are still carried out. `lost`: its connection broke, it may come
  /// back.
  void leave(std::shared_ptr<Viewer> viewer, std::uint64_t visit, bool lost = false);
  /// Called on the scene's thread, when what was submitted before is carried out and answered.
  using Call = std::function<void()>;
  /// One command, or a call. False if too many wait; it is forgotten.
  bool submit(const std::shared_ptr<Viewer>& viewer, std::uint64_t visit,
              std::variant<SceneRequest, Call> what);

 private:
  struct Task;

  void run(const std::stop_token& stop);
  std::vector<Task> wait_for_work(const std::stop_token& stop);
  /// Until when it waits if nothing is asked.
  StepClock::TimePoint next_work() const;
  void carry_out(Task& task);
  void study_if_wanted();
  /// Whether a step was made.
  bool step_if_due();
  void count_step();
  void publish_if_due(bool stepped);
  void send_stats_if_due();
  /// Comings, goings and the outcome of a study are never refused: there are no more of them than
  /// connections.
  void post(Task task);

  const std::string name_, title_;
  const std::size_t cloths_;
  const int max_viewers_;
  const double time_step_;
  const std::vector<std::shared_ptr<const std::string>> meshes_;  ///< of the obstacles; nullptr for others
  std::atomic<int> viewers_{0};
  std::atomic<std::uint64_t> frame_{0}, encodes_{0};
  std::atomic<std::chrono::steady_clock::rep> busy_since_{0};  ///< 0: it waits

  std::atomic<bool> forgotten_{false};

  std::mutex mutex_;
  std::condition_variable_any work_;
  std::vector<Task> waiting_;  ///< guarded by mutex_

  // The thread's own.
  Metrics& metrics_;
  SceneMetrics scene_metrics_;
  std::unique_ptr<SceneLog> log_;  ///< if anything is written down
  const std::unique_ptr<LiveScene> live_;
  StepClock clock_;
  StepClock::TimePoint stats_due_{}, stats_sent_{}, publish_due_{};
  bool running_ = false;                       ///< in real time
  std::uint64_t steps_made_ = 0;               ///< in no real time, since the last stats
  std::unique_ptr<StudyThread> study_;         ///< from when it was first wanted
  std::optional<std::uint64_t> study_number_;  ///< of what it studies or has studied

  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace weft::host
