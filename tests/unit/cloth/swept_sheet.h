#pragma once
// A blade that turns in one step over a sheet at rest in its plane takes along what is in its way.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "cloth/contact/recovery/contact.h"
#include "fixtures.h"

namespace weft::test {

/// A blade along its own y axis, `thick` m each side of it: up to `reach` from its middle its sides
/// are plane, and `end` is as far as it gets.
struct Blade {
  Shape shape;
  double thick, reach, end;
};

/// Turns it by 80 degrees about z over 33 x 33 nodes on 1.9 m x 1.9 m. A node within its reach and the angle
/// is taken along: on the blade's front. Those beyond stay. How many were swept.
template <class Real>
int expect_swept(const Blade& of, double rounding) {
  using std::numbers::pi;
  constexpr double kTurn = 80 * pi / 180;
  Particles<Real> sheet = flat_sheet<Real>(33, 33, {1.9, 1.9});
  const Particles<Real> before = sheet;
  Solid blade;
  blade.id = kFirstObstacle;
  blade.shape = of.shape;
  blade.turn = {0, 0, kTurn};
  blade.spin = blade.turn / kFrame;
  blade.rotation = Eigen::AngleAxisd(kTurn, Vec3::UnitZ()).toRotationMatrix();  // from along y
  std::vector<Solid> solids{blade};
  const VectorField<Real> start = sheet.position;
  Contact<Real> contact(sheet.grid());
  contact.resolve(sheet, solids, {0, 1, kFrame}, &start);
  const Vec3 front = blade.rotation * Vec3(-1, 0, 0);
  int swept = 0;
  each_node(sheet.grid(), [&](int r, int c) {
    const Vec3 place = before.position_at(r, c), now = sheet.position_at(r, c);
    const double distance = place.norm();
    EXPECT_FALSE(blade.placed(1).contains(now));
    // Of a half turn; the blade's other half comes round to the rest of the circle.
    const double angle = std::fmod(std::atan2(-place.x(), place.y()) + 2 * pi, pi);
    const double thickness = std::asin(std::min(1.0, of.thick / distance));
    if (distance > of.end || (angle > kTurn + thickness && angle < pi - thickness)) {
      EXPECT_EQ(now, place);
    } else if (distance < of.reach && distance > 0.1 && angle > thickness && angle < kTurn - thickness) {
      ++swept;
      const double side = place.dot(blade.rotation.col(1)) > 0 ? 1 : -1;  // which half of the blade
      EXPECT_NEAR(side * now.dot(front), of.thick, rounding) << place.transpose();
      EXPECT_GT(side * sheet.velocity_at(r, c).dot(front), 0);
    }
  });
  return swept;
}

}  // namespace weft::test
