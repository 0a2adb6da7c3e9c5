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
    checked_ += head->size;
    payload_left_ = head->payload;
  }
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
