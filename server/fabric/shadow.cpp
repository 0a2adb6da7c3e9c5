#include "fabric/shadow.h"

#include <algorithm>
#include <cmath>

namespace weft::fabric {
namespace {

/// No row of pixels lies on a specimen's grid: its border would be dark or not by rounding.
constexpr double kBetween = 0.31;

}  // namespace

Shadow::Shadow(double side, double pixel)
    : origin_(-side / 2 - kBetween * pixel),
      pixel_(pixel),
      pixels_(static_cast<int>(std::ceil(2 * side / pixel))),
      dark_(static_cast<std::size_t>(pixels_) * static_cast<std::size_t>(pixels_), 0) {}

void Shadow::add(const Vec3& a, const Vec3& b, const Vec3& c) {
  // In pixels; centres are whole numbers.
  const auto flat = [&](const Vec3& p) {
    return Vec2((p.x() - origin_) / pixel_ - 0.5, (p.z() - origin_) / pixel_ - 0.5);
  };
  const Vec2 p = flat(a), q = flat(b), s = flat(c);
  const auto twice_area = [](const Vec2& from, const Vec2& to, const Vec2& at) {
    return (to - from).x() * (at - from).y() - (to - from).y() * (at - from).x();
  };
  const double way = twice_area(p, q, s) < 0 ? -1 : 1;
  const auto within = [&](double low) { return std::clamp(static_cast<int>(low), 0, pixels_ - 1); };
  const Vec2 low = p.cwiseMin(q).cwiseMin(s), high = p.cwiseMax(q).cwiseMax(s);
  for (int z = within(std::ceil(low.y())); z <= within(std::floor(high.y())); ++z) {
    for (int x = within(std::ceil(low.x())); x <= within(std::floor(high.x())); ++x) {
      const Vec2 at(x, z);
      if (way * twice_area(p, q, at) >= 0 && way * twice_area(q, s, at) >= 0 &&
          way * twice_area(s, p, at) >= 0)
        dark_[static_cast<std::size_t>(z) * static_cast<std::size_t>(pixels_) + static_cast<std::size_t>(x)] =
            1;
    }
  }
}

double Shadow::area() const {
  return static_cast<double>(std::count(dark_.begin(), dark_.end(), 1)) * pixel_ * pixel_;
}

}  // namespace weft::fabric
