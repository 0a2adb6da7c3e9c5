#include "fabric/drape.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "cloth/core/random.h"
#include "fabric/shadow.h"
#include "fabric/specimen.h"

namespace weft::fabric {
namespace {

constexpr double kSpecimenRadius = 0.15, kDiscRadius = 0.09;  // m
constexpr double kDrapeGravity = 9.80665;                     // m/s2

double from_centre(int r, int c, int cells) {
  const double cell = 2 * kSpecimenRadius / cells;
  return std::hypot(c - cells / 2, r - cells / 2) * cell;
}

Specimen round_specimen(const Material& material, int cells) {
  SpecimenPlan plan;
  plan.material = material;
  plan.size = {2 * kSpecimenRadius, 2 * kSpecimenRadius};
  plan.rows = plan.cols = cells + 1;
  plan.gravity = kDrapeGravity;
  plan.tolerance = 1e-2;  // solved a hundred times tighter it reads the same within 0.002
  plan.there = [=](int r, int c) { return from_centre(r, c, cells) <= kSpecimenRadius; };
  plan.held = [=](int r, int c) { return from_centre(r, c, cells) <= kDiscRadius; };
  return Specimen(plan);
}

Shadow shadow_of(const Specimen& cloth) {
  constexpr double kPixel = 5e-4;  // m
  Shadow shadow(2 * kSpecimenRadius, kPixel);
  for (int r = 0; r + 1 < cloth.grid().rows; ++r) {
    for (int c = 0; c + 1 < cloth.grid().cols; ++c) {
      if (!cloth.face_there(r, c)) continue;
      const Vec3 a = cloth.at(r, c), b = cloth.at(r, c + 1), d = cloth.at(r + 1, c),
                 e = cloth.at(r + 1, c + 1);
      shadow.add(a, b, e);
      shadow.add(a, e, d);
    }
  }
  return shadow;
}

/// Highest places along a circle just inside the rim that stand out from their neighbours.
int folds_of(const Specimen& cloth, int cells) {
  constexpr int kAngles = 360;
  constexpr double kStandsOut = 2e-3;  // m
  const double radius = cells / 2.0 - 2;
  std::vector<double> height(kAngles);
  for (int i = 0; i < kAngles; ++i) {
    const double angle = 2 * std::numbers::pi * i / kAngles;
    const double u = cells / 2.0 + radius * std::cos(angle), v = cells / 2.0 + radius * std::sin(angle);
    const int c = static_cast<int>(u), r = static_cast<int>(v);
    const double s = u - c, t = v - r;
    height[static_cast<std::size_t>(i)] =
        (1 - s) * ((1 - t) * cloth.at(r, c).y() + t * cloth.at(r + 1, c).y()) +
        s * ((1 - t) * cloth.at(r, c + 1).y() + t * cloth.at(r + 1, c + 1).y());
  }
  // From the lowest place once round: a top counts when it has been left behind by so much.
  std::rotate(height.begin(), std::min_element(height.begin(), height.end()), height.end());
  int folds = 0;
  double low = height[0], high = height[0];
  bool rising = false;
  for (const double here : height) {
    if (rising) {
      high = std::max(high, here);
      if (here < high - kStandsOut) {
        ++folds;
        rising = false;
        low = here;
      }
    } else {
      low = std::min(low, here);
      if (here > low + kStandsOut) {
        rising = true;
        high = here;
      }
    }
  }
  return folds + (rising ? 1 : 0);  // back at the lowest place
}

}  // namespace

Drape drape(const Material& material, int cells) {
  Specimen cloth = round_specimen(material, cells);
  const double specimen = shadow_of(cloth).area();
  const double disc = std::numbers::pi * kDiscRadius * kDiscRadius;
  Random random(1);
  for (int r = 0; r <= cells; ++r) {
    for (int c = 0; c <= cells; ++c) {
      constexpr double kUneven = 1e-4;  // m: no cloth lies quite flat, and an even one would not fold
      if (cloth.there(r, c) && from_centre(r, c, cells) > kDiscRadius)
        cloth.put(r, c, cloth.at(r, c) + Vec3(0, kUneven * random.symmetric(), 0));
    }
  }
  // Folds that have formed may creep round for long. The shadow is read every second, until two seconds have
  // not changed it.
  constexpr double kStep = 0.05, kSame = 1e-3;  // s, of the coefficient
  constexpr int kStepsASecond = 20, kMostSeconds = 120;
  double coefficient = 1;
  int same = 0;
  for (int second = 0; second < kMostSeconds; ++second) {
    for (int n = 0; n < kStepsASecond; ++n) cloth.advance(kStep);
    const double before = std::exchange(coefficient, (shadow_of(cloth).area() - disc) / (specimen - disc));
    same = std::abs(coefficient - before) < kSame ? same + 1 : 0;
    if (same == 2) return {coefficient, folds_of(cloth, cells)};
  }
  throw NoRest("the specimen's shadow changes still after 120 s");
}

}  // namespace weft::fabric
