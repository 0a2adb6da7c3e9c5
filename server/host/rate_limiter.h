#pragma once
#include <algorithm>
#include <chrono>

namespace weft::host {

/// A bucket of one second's messages that fills at `per_second`.
class RateLimiter {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  RateLimiter(int per_second, TimePoint now) : rate_(per_second), tokens_(per_second), last_(now) {}

  /// Whether one more message is allowed now; takes its place if so.
  bool allow(TimePoint now) {
    tokens_ = std::min(rate_, tokens_ + rate_ * std::chrono::duration<double>(now - last_).count());
    last_ = now;
    if (tokens_ < 1.0) return false;
    tokens_ -= 1.0;
    return true;
  }

 private:
  double rate_, tokens_;
  TimePoint last_;
};

}  // namespace weft::host
