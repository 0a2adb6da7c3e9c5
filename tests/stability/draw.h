#pragma once
/// What random scenes are drawn with.
#include <cmath>
#include <cstdint>
#include <random>

#include "cloth/core/vec3.h"

namespace weft::stability {

/// Draws whose values the standard fixes: from the generator's bits, not through its distributions.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}

  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_() >> 11) * 0x1p-53);
  }
  /// Every decade as likely as the other.
  double decades(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  bool chance(double share) { return between(0, 1) < share; }
  int integer(int low, int high) {  // both included
    return low + static_cast<int>(random_() % static_cast<std::uint64_t>(high - low + 1));
  }
  Vec3 in_box(double half) {
    const double x = between(-half, half), y = between(-half, half), z = between(-half, half);
    return {x, y, z};
  }
  Vec3 direction() {
    Vec3 drawn = in_box(1);
    while (drawn.norm() < 0.1 || drawn.norm() > 1) drawn = in_box(1);
    return drawn.normalized();
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace weft::stability
