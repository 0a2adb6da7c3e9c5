#include "host/step_clock.h"

namespace weft::host {
namespace {

/// Steps by which the schedule may lag before time is given up: evens out a late wake-up without a visible
/// burst.
constexpr double kSlackSteps = 2.0;
constexpr StepClock::Seconds kWindow{1.0};
/// Lost shares at which the clock counts as slow and as recovered: apart, so that viewers are not told each
/// second.
constexpr double kSlowShare = 0.10, kRecoveredShare = 0.02;

}  // namespace

void StepClock::start(TimePoint now) {
  next_ = now;
  window_start_ = now;
  lost_ = simulated_ = Seconds(0);
}

void StepClock::stepped(TimePoint now) {
  using Ticks = TimePoint::duration;
  next_ += std::chrono::duration_cast<Ticks>(time_step_);
  simulated_ += time_step_;
  const Seconds lag = now - next_;
  if (lag > kSlackSteps * time_step_) {
    lost_ += lag;
    next_ = now;
  }
  const Seconds window = now - window_start_;
  if (window < kWindow) return;
  // By what was lost and not by the wall clock: exactly 1 in real time, whatever step the window ends on.
  rate_ = simulated_ / (simulated_ + lost_);
  const double share = lost_ / (simulated_ + lost_);
  slow_ = share > (slow_ ? kRecoveredShare : kSlowShare);
  window_start_ = now;
  lost_ = simulated_ = Seconds(0);
}

}  // namespace weft::host
