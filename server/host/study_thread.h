#pragma once
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "host/scene_quality.h"

namespace weft::host {

/// Studies a scene's cost on a thread of its own, at low priority. One study at a time runs in a process, the
/// others wait: two would disturb each other's figures, and the viewers. Its owner never waits for a study:
/// begin() and give_up() return at once, and the study in hand ends within milliseconds.
class StudyThread {
 public:
  /// `done` is called on that thread with a study's number and outcome, once for each that is not given up.
  explicit StudyThread(std::function<void(std::uint64_t, StudyOutcome)> done);
  /// Gives the study in hand up, and waits for the thread.
  ~StudyThread();
  StudyThread(const StudyThread&) = delete;
  StudyThread& operator=(const StudyThread&) = delete;

  /// Studies this scene, in place of the one in hand.
  void begin(std::uint64_t number, SimulationDescription description);
  /// The study in hand is of no use any more.
  void give_up();

 private:
  struct Job {
    std::uint64_t number;
    SimulationDescription description;
    std::stop_source stop;
  };
  void run(const std::stop_token& end);
  /// The next job, or nothing if the thread shall end.
  std::optional<Job> wait_for_job(const std::stop_token& end);
  void carry_out(Job& job);

  const std::function<void(std::uint64_t, StudyOutcome)> done_;
  std::mutex mutex_;
  std::condition_variable_any work_;
  std::optional<Job> next_;                     ///< guarded by mutex_
  std::stop_source in_hand_{std::nostopstate};  ///< the newest job's; guarded by mutex_
  std::jthread thread_;                         // last: it uses all of the above
};

}  // namespace weft::host
