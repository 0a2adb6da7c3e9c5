#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace weft::net {

/// The head of a message that a server sends in one frame: final, not masked (RFC 6455, section 5.2).
class MessageHead {
 public:
  enum class Kind : std::uint8_t { text = 1, binary = 2 };

  MessageHead() = default;
  /// `payload`: bytes of the message, which follow the head.
  MessageHead(Kind kind, std::uint64_t payload) {
    constexpr unsigned kWholeMessage = 0x80, kLengthInTwo = 126, kLengthInEight = 127;
    const int length = payload < kLengthInTwo ? 0 : payload <= 0xffff ? 2 : 8;
    add(kWholeMessage | static_cast<unsigned>(kind));
    add(length == 0 ? payload : length == 2 ? kLengthInTwo : kLengthInEight);
    for (int i = length - 1; i >= 0; --i) add(payload >> (8 * i));
  }
  std::span<const std::uint8_t> bytes() const { return std::span(bytes_).first(size_); }

 private:
  void add(std::uint64_t byte) { bytes_[size_++] = static_cast<std::uint8_t>(byte); }

  std::array<std::uint8_t, 10> bytes_{};
  std::size_t size_ = 0;
};

}  // namespace weft::net
