#pragma once
#include <chrono>

namespace weft::host {

/// When a scene's next step is due. Steps that take longer than their time push the schedule back: the
/// scene's clock slows, lost time is never caught up in a burst. Knows no clock of its own: the time is told.
class StepClock {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Seconds = std::chrono::duration<double>;

  /// `time_step` is the simulated time of a step, s.
  explicit StepClock(double time_step) : time_step_(time_step) {}

  /// The scene starts, or starts again after it stood still: the next step is due now.
  void start(TimePoint now);
  /// When the next step is due.
  TimePoint next() const { return next_; }
  /// One step was made, and ended now.
  void stepped(TimePoint now);

  /// Simulated seconds per real second, over the last whole second; 1 in real time.
  double rate() const { return rate_; }
  /// The clock runs behind: it lost more than a tenth of the last second, and has not run a second without
  /// loss since.
  bool slow() const { return slow_; }

 private:
  Seconds time_step_;
  TimePoint next_{};
  TimePoint window_start_{};
  Seconds lost_{0}, simulated_{0};  ///< within the window
  double rate_ = 1.0;
  bool slow_ = false;
};

}  // namespace weft::host
