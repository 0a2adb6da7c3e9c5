#include "net/frame_rules.h"

#include <boost/locale/utf.hpp>
#include <limits>
#include <string>

namespace weft::net {
namespace {

constexpr unsigned kFinal = 0x80, kOpcode = 0x0f, kFirstControl = 8, kClose = 8;
constexpr unsigned kMasked = 0x80, kLength = 0x7f, kLength16 = 126, kLength64 = 127;
constexpr std::size_t kMaskBytes = 4, kCodeBytes = 2, kLongestControl = 125;

std::uint64_t big_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char byte : bytes) value = value << 8 | static_cast<unsigned char>(byte);
  return value;
}

}  // namespace

std::optional<FrameHead> parse_frame_head(std::string_view bytes) {
  if (bytes.size() < 2) return std::nullopt;
  const auto first = static_cast<unsigned char>(bytes[0]), second = static_cast<unsigned char>(bytes[1]);
  FrameHead head;
  head.control = (first & kOpcode) >= kFirstControl;
  head.final = (first & kFinal) != 0;
  head.payload = second & kLength;
  const std::size_t length_bytes = head.payload == kLength64 ? 8 : head.payload == kLength16 ? 2 : 0;
  const std::size_t mask_at = 2 + length_bytes;
  head.size = mask_at + ((second & kMasked) != 0 ? kMaskBytes : 0);
  if (bytes.size() < head.size) return std::nullopt;
  if (length_bytes > 0) head.payload = big_endian(bytes.substr(2, length_bytes));
  if ((first & kOpcode) != kClose || head.payload < kCodeBytes || head.payload > kLongestControl) return head;
  if (bytes.size() < head.size + head.payload) return std::nullopt;
  std::string said(bytes.substr(head.size, head.payload));
  if ((second & kMasked) != 0) {
    const std::string_view mask = bytes.substr(mask_at, kMaskBytes);
    for (std::size_t i = 0; i < said.size(); ++i) said[i] = static_cast<char>(said[i] ^ mask[i % kMaskBytes]);
  }
  head.close_code = static_cast<std::uint16_t>(big_endian(std::string_view(said).substr(0, kCodeBytes)));
  head.reason_is_text = is_utf8(std::string_view(said).substr(kCodeBytes));
  return head;
}

bool is_utf8(std::string_view text) {
  namespace utf = boost::locale::utf;
  for (const char* at = text.begin(); at != text.end();) {
    if (!utf::is_valid_codepoint(utf::utf_traits<char>::decode(at, text.end()))) return false;
  }
  return true;
}

bool close_code_allowed(std::uint16_t code) {
  constexpr std::uint16_t kFirstRegistered = 3000, kLastPrivate = 4999;
  const bool defined = (code >= 1000 && code <= 1003) || (code >= 1007 && code <= 1013);
  return defined || (code >= kFirstRegistered && code <= kLastPrivate);
}

std::optional<std::uint16_t> FrameRules::broken_by(const FrameHead& head, TimePoint now) {
  if (head.close_code && !close_code_allowed(*head.close_code)) return kProtocolError;
  if (!head.reason_is_text) return kNoText;
  if (head.payload > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    return kProtocolError;  // section 5.2: the highest bit of a length is 0
  if ((head.control || !head.final) && !rate_.allow(now)) return kPolicyViolation;
  return std::nullopt;
}

}  // namespace weft::net
