#pragma once
#include <functional>
#include <thread>

#include "host/scene_quality.h"

namespace weft::host {

/// Studies a scene's cost on a thread of its own, at low priority. One study at a time runs in a process, the
/// others wait: two would disturb each other's figures, and the viewers.
class StudyThread {
 public:
  /// `done` is called once, on that thread, unless the study is given up before.
  StudyThread(SimulationDescription description, std::function<void(StudyOutcome)> done);
  /// Gives the study up, within one step of the scene, and waits for the thread.
  ~StudyThread() = default;
  StudyThread(const StudyThread&) = delete;
  StudyThread& operator=(const StudyThread&) = delete;

 private:
  std::jthread thread_;
};

}  // namespace weft::host
