#pragma once
#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace weft::net {

/// Keeps what clients can cause from filling the log: so many lines at once, and `per_second` more each
/// second; lines beyond are counted, and the next one tells how many. Any thread may use it.
class LogLimiter {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  explicit LogLimiter(double at_once = 20, double per_second = 1)
      : most_(at_once), per_second_(per_second), left_(at_once) {}

  /// What is to be appended to the line, "" or how many were left out before it; nothing if it is to be left
  /// out itself.
  std::optional<std::string> admit(TimePoint now) {
    const std::lock_guard lock(mutex_);
    const std::chrono::duration<double> passed = now - last_;
    left_ = std::min(most_, left_ + per_second_ * passed.count());
    last_ = now;
    if (left_ < 1) {
      ++left_out_;
      return std::nullopt;
    }
    left_ -= 1;
    if (left_out_ == 0) return "";
    return " (" + std::to_string(std::exchange(left_out_, 0)) + " more like it were not logged)";
  }

 private:
  std::mutex mutex_;
  double most_, per_second_, left_;
  TimePoint last_{};
  long left_out_ = 0;
};

}  // namespace weft::net
