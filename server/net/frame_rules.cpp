#include "net/frame_rules.h"

#include <algorithm>
#include <array>
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
  /// First bytes of characters of so many bytes, and the range of the second; all further are 80..BF.
  struct Form {
    unsigned char first, last, least, most;
    std::size_t bytes;
  };
  static constexpr std::array<Form, 9> kForms{{{0x00, 0x7f, 0, 0, 1},
                                               {0xc2, 0xdf, 0x80, 0xbf, 2},
                                               {0xe0, 0xe0, 0xa0, 0xbf, 3},
                                               {0xe1, 0xec, 0x80, 0xbf, 3},
                                               {0xed, 0xed, 0x80, 0x9f, 3},
                                               {0xee, 0xef, 0x80, 0xbf, 3},
                                               {0xf0, 0xf0, 0x90, 0xbf, 4},
                                               {0xf1, 0xf3, 0x80, 0xbf, 4},
                                               {0xf4, 0xf4, 0x80, 0x8f, 4}}};
  while (!text.empty()) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const auto form = std::find_if(kForms.begin(), kForms.end(), [&](const Form& each) {
      return byte(0) >= each.first && byte(0) <= each.last;
    });
    if (form == kForms.end() || text.size() < form->bytes) return false;
    if (form->bytes > 1 && (byte(1) < form->least || byte(1) > form->most)) return false;
    for (std::size_t i = 2; i < form->bytes; ++i) {
      if ((byte(i) & 0xc0U) != 0x80U) return false;
    }
    text.remove_prefix(form->bytes);
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
