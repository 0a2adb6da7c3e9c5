#pragma once
/// What a viewer's WebSocket frames must keep to beyond what Boost.Beast checks. No sockets here.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "host/rate_limiter.h"

namespace weft::net {

// Close codes of RFC 6455, section 7.4.1.
inline constexpr std::uint16_t kProtocolError = 1002;
inline constexpr std::uint16_t kNoText = 1007;
inline constexpr std::uint16_t kPolicyViolation = 1008;

/// The head of one frame (RFC 6455, section 5.2), and what it says if it closes.
struct FrameHead {
  std::size_t size = 0;                     ///< bytes of the head itself: 2 to 14
  std::uint64_t payload = 0;                ///< bytes that follow it
  bool control = false;                     ///< ping, pong or close
  bool final = true;                        ///< the last, or the only, fragment of its message
  std::optional<std::uint16_t> close_code;  ///< of a close that has one
  bool reason_is_text = true;               ///< what follows the code is UTF-8
};

/// The head of the frame that begins with `bytes`; nothing as long as they end before the head does. A close
/// frame of at most 125 bytes, as long as one may be, is read whole.
std::optional<FrameHead> parse_frame_head(std::string_view bytes);

/// Whether the text is UTF-8 (The Unicode Standard, table 3-7).
bool is_utf8(std::string_view text);

/// Whether an endpoint may send this close code (RFC 6455, section 7.4).
bool close_code_allowed(std::uint16_t code);

/// The rules for one connection. Whole messages are limited by host::Connection; control frames and fragments
/// that end no message are limited here, since they cost as much and never become a message.
class FrameRules {
 public:
  using TimePoint = host::RateLimiter::TimePoint;

  FrameRules(int frames_per_second, TimePoint now) : rate_(frames_per_second, now) {}

  /// The code to close with because of this frame, which came now; nothing if it is within the rules.
  std::optional<std::uint16_t> broken_by(const FrameHead& head, TimePoint now);

 private:
  host::RateLimiter rate_;
};

}  // namespace weft::net
