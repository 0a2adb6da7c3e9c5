#include "net/frame_gate.h"

#include <algorithm>

namespace weft::net {

std::span<char> FrameGate::room() {
  // At most a part of one head is kept.
  std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(checked_),
            bytes_.begin() + static_cast<std::ptrdiff_t>(end_), bytes_.begin());
  end_ -= checked_;
  begin_ = checked_ = 0;
  return std::span(bytes_).subspan(end_, kCapacity - end_);
}

void FrameGate::received(std::size_t count, TimePoint now) {
  end_ += count;
  while (checked_ < end_) {
    const std::size_t left = end_ - checked_;
    if (payload_left_ > 0) {
      const auto here = static_cast<std::size_t>(std::min<std::uint64_t>(payload_left_, left));
      payload_left_ -= here;
      checked_ += here;
      continue;
    }
    const auto head = parse_frame_head({bytes_.data() + checked_, left});
    if (!head) return;
    if (const auto code = rules_.broken_by(*head, now)) return shut_with(*code);
    if (taken_aside(*head)) continue;
    if (!head->control) fragmented_ = !head->final;
    checked_ += head->size;
    payload_left_ = head->payload;
  }
}

/// Of a message in fragments, of one that is not masked and of one that has come in part only the WebSocket
/// knows what to do.
bool FrameGate::taken_aside(const FrameHead& head) {
  constexpr unsigned char kWholeText = 0x81, kMaskBit = 0x80;
  constexpr std::size_t kShort = 125, kMaskSize = 4;
  const auto begin = bytes_.begin() + static_cast<std::ptrdiff_t>(checked_);
  if (!take_ || fragmented_ || static_cast<unsigned char>(begin[0]) != kWholeText ||
      (static_cast<unsigned char>(begin[1]) & kMaskBit) == 0 || head.payload > kShort)
    return false;
  const auto size = static_cast<std::size_t>(head.payload);
  if (end_ - checked_ < head.size + size) return false;
  std::array<char, kShort> text;
  const auto payload = begin + static_cast<std::ptrdiff_t>(head.size);
  const auto mask = payload - static_cast<std::ptrdiff_t>(kMaskSize);
  for (std::size_t i = 0; i < size; ++i)
    text[i] = static_cast<char>(payload[static_cast<std::ptrdiff_t>(i)] ^
                                mask[static_cast<std::ptrdiff_t>(i % kMaskSize)]);
  if (!take_({text.data(), size})) return false;
  std::copy(payload + static_cast<std::ptrdiff_t>(size), bytes_.begin() + static_cast<std::ptrdiff_t>(end_),
            begin);
  end_ -= head.size + size;
  return true;
}

void FrameGate::shut_with(std::uint16_t code) {
  shut_ = true;
  // Final, a close; masked with zeros; two bytes of payload.
  const std::array<unsigned, kCloseBytes> close{0x88, 0x82, 0, 0, 0, 0, code / 256U, code % 256U};
  std::transform(close.begin(), close.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(checked_),
                 [](unsigned byte) { return static_cast<char>(byte); });
  checked_ += kCloseBytes;
  end_ = checked_;
}

}  // namespace weft::net
