#pragma once
#include <cstddef>
#include <cstdint>

namespace weft {

/// 64 bits of some bytes (FNV-1a: Fowler, Noll, Vo): equal bytes have equal hashes, others hardly ever do.
class Fnv1a {
 public:
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * kPrime;
  }
  /// `value`'s own bytes: a type without padding.
  template <class T>
  void add(const T& value) {
    add(&value, sizeof value);
  }
  std::uint64_t value() const { return value_; }

 private:
  static constexpr std::uint64_t kPrime = 0x100000001b3;
  std::uint64_t value_ = 0xcbf29ce484222325;
};

}  // namespace weft
