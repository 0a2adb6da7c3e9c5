#pragma once
#include <chrono>
#include <deque>
#include <optional>

namespace weft::host {

/// How long the way to a viewer and back takes, as pings of the WebSocket measure it: whoever is at the other
/// end answers them at once, however long it takes over frames, but they wait on the way behind frames.
class Way {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Seconds = std::chrono::duration<double>;

  /// A ping is sent; none waits for its answer.
  void asked(TimePoint now) { asked_ = now; }
  /// Its answer has come; nothing if none was asked for.
  void answered(TimePoint now);
  bool waits() const { return asked_.has_value(); }

  /// Of the way alone: the shortest of late, as others have waited behind frames; 0: not known.
  Seconds shortest() const;
  /// With what queues on it at present: the longest of the last few, that which waits counted.
  Seconds at_present(TimePoint now) const;

 private:
  std::optional<TimePoint> asked_;
  std::deque<Seconds> late_;
};

}  // namespace weft::host
