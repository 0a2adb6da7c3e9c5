#pragma once
#include <cstdint>
#include <random>

namespace weft {

/// Random numbers with the same bits everywhere: the standard fixes those of std::mt19937_64, but not those
/// of its distributions nor of std::log.
class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}

  /// Uniform in [-1, 1): the generator's upper 53 bits.
  double symmetric() { return static_cast<double>(generator_() >> 11) * 0x1p-52 - 1.0; }
  /// Uniform in [low, high).
  double between(double low, double high) { return low + (high - low) * (symmetric() + 1) / 2; }
  /// Normal, of mean 0 and variance 1: a sum of 48 uniform ones, whose fourth moment is 2.975 instead of 3.
  double normal() {
    double sum = 0;
    for (int i = 0; i < 48; ++i) sum += symmetric();  // of variance 1/3 each
    return sum / 4;
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace weft
