#pragma once
/// Numbers of any width one after the other, the lowest bit of each byte first: what Rice codes are written
/// in.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace weft::protocol {

/// Bits one after the other, the lowest of each byte first.
class BitWriter {
 public:
  /// For so many bits in all.
  explicit BitWriter(std::size_t most_bits) : bytes_(most_bits / 8 + 1 + sizeof(std::uint64_t)) {}

  void zeros(std::uint32_t count) { fill_ += count; }
  /// At most 32 bits.
  void value(std::uint32_t bits, int width) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes_.data() + fill_ / 8, sizeof word);
    word |= static_cast<std::uint64_t>(bits) << (fill_ % 8);
    std::memcpy(bytes_.data() + fill_ / 8, &word, sizeof word);
    fill_ += static_cast<std::size_t>(width);
  }
  std::span<const std::uint8_t> bytes() const { return std::span(bytes_).first((fill_ + 7) / 8); }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t fill_ = 0;
};

/// The same back.
class BitReader {
 public:
  explicit BitReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  /// Zeros before the next one; `most` + 1 if there are more, or the bytes end before it.
  std::uint32_t zeros(std::uint32_t most) {
    for (std::uint32_t count = 0; count <= most && at_ < 8 * bytes_.size(); ++count)
      if (next_bit()) return count;
    return most + 1;
  }
  /// So many bits are left.
  bool has(int width) const { return 8 * bytes_.size() - at_ >= static_cast<std::size_t>(width); }
  /// At most 25 bits, which lie in four bytes wherever they begin; has() them.
  std::uint32_t value(int width) {
    std::uint32_t word = 0;
    const std::size_t first = at_ / 8;
    at_ += static_cast<std::size_t>(width);
    for (std::size_t byte = first; 8 * byte < at_; ++byte)
      word |= static_cast<std::uint32_t>(bytes_[byte]) << (8 * (byte - first));
    return word >> ((at_ - static_cast<std::size_t>(width)) % 8) & ((1U << width) - 1);
  }
  /// Bytes that no bit was read of.
  std::size_t unread() const { return bytes_.size() - (at_ + 7) / 8; }
  /// The bits left over in the last byte read are 0.
  bool rest_is_zero() const { return at_ % 8 == 0 || bytes_[at_ / 8] >> (at_ % 8) == 0; }

 private:
  bool next_bit() {
    const bool bit = (bytes_[at_ / 8] >> (at_ % 8) & 1U) != 0;
    ++at_;
    return bit;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

}  // namespace weft::protocol
