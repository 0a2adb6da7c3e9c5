#pragma once
/// What a viewer sends, held to FrameRules before the WebSocket reads it. No sockets here.
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include "net/frame_rules.h"

namespace weft::net {

/// Bytes received, of which a frame's head is handed on once it is whole and within the rules. In place of
/// the first frame that breaks a rule, and of all that follows, stands a close with the code it deserves: the
/// WebSocket answers it as it answers any close, with the same code, and ends.
class FrameGate {
 public:
  using TimePoint = FrameRules::TimePoint;

  FrameGate(int frames_per_second, TimePoint now) : rules_(frames_per_second, now) {}

  /// A short text that came in one frame; true if that was all there was to do with it.
  using Take = std::function<bool(std::string_view text)>;
  /// From now on such texts are shown to `take` first, and what it takes is not handed on: so that what comes
  /// most often need not go through the whole WebSocket.
  void show_texts_to(Take take) { take_ = std::move(take); }

  /// Where the next bytes received go; only while nothing is ready() and the gate is not shut(). Never empty.
  std::span<char> room();
  /// So many bytes have come there.
  void received(std::size_t count, TimePoint now);
  /// What may be handed on.
  std::string_view ready() const { return {bytes_.data() + begin_, checked_ - begin_}; }
  /// So many of them have been handed on.
  void taken(std::size_t count) { begin_ += count; }
  /// A rule was broken: nothing more is to be received.
  bool shut() const { return shut_; }

 private:
  void shut_with(std::uint16_t code);
  bool taken_aside(const FrameHead& head);

  static constexpr std::size_t kCapacity = 1024, kCloseBytes = 8;

  std::array<char, kCapacity + kCloseBytes> bytes_;
  /// Bytes before `begin_` are handed on, those before `checked_` may be, those before `end_` are received.
  std::size_t begin_ = 0, checked_ = 0, end_ = 0;
  std::uint64_t payload_left_ = 0;  ///< bytes of the last checked frame that have not come yet
  FrameRules rules_;
  bool fragmented_ = false;  ///< a message has begun and not ended
  bool shut_ = false;
  Take take_;
};

}  // namespace weft::net
