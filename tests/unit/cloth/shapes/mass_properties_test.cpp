// What bodies weigh about their centres.
#include "cloth/shapes/mass_properties.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "meshes.h"

namespace weft {
namespace {

TEST(MassProperties, OfABoxAreTheTextbooks) {
  // (b^2 + c^2) / 12 of edges 1, 2, 3 m.
  const MassProperties box = mass_properties(Shape(Box{{0.5, 1, 1.5}}));
  EXPECT_LT((box.inertia.diagonal() - Vec3(13, 10, 5) / 12).norm(), 1e-15);
  EXPECT_EQ(box.centre, Vec3(0, 0, 0));
}

TEST(MassProperties, OfACapsuleAreItsSlices) {
  // Discs across the axis: of radius r, r^2 / 2 about it, r^2 / 4 + y^2 across it, weighed by r^2. Simpson's
  // rule has cubics exactly, and the discs' moments are polynomials of degree 4 in each of three parts; so
  // many slices leave 1e-9 of it.
  const double half = 0.6, radius = 0.25;
  const auto square = [&](double y) {
    const double beyond = std::max(0.0, std::abs(y) - half);
    return radius * radius - beyond * beyond;
  };
  double volume = 0, along = 0, across = 0;
  const auto integrate = [&](double from, double to) {
    constexpr int kSlices = 200;
    for (int i = 0; i <= kSlices; ++i) {
      const double weight = (to - from) * (i == 0 || i == kSlices ? 1 : i % 2 == 1 ? 4 : 2);
      const double y = from + (to - from) * i / kSlices, r2 = square(y);
      volume += weight * r2;
      along += weight * r2 * r2 / 2;
      across += weight * r2 * (r2 / 4 + y * y);
    }
  };
  integrate(-half - radius, -half);
  integrate(-half, half);
  integrate(half, half + radius);
  const Eigen::Matrix3d inertia = mass_properties(Shape(Capsule{half, radius})).inertia;
  EXPECT_LT((inertia.diagonal() - Vec3(across, along, across) / volume).norm(), 1e-9);
}

TEST(MassProperties, OfATetrahedronAreByHand) {
  // Corners 0, e1, e2, e3: the means of x, x^2 and x y are 1/4, 1/10 and 1/20; about the centre 3/80 and
  // -1/80. Far from the origin the same.
  const Vec3 far(100, -200, 300);
  TriangleList list{{far, far + Vec3::UnitX(), far + Vec3::UnitY(), far + Vec3::UnitZ()},
                    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const MassProperties found = mass_properties(list);
  EXPECT_LT((found.centre - far - Vec3(0.25, 0.25, 0.25)).norm(), 1e-12);
  const Eigen::Matrix3d expected =
      Eigen::Matrix3d::Constant(1.0 / 80) + (6.0 / 80 - 1.0 / 80) * Eigen::Matrix3d::Identity();
  EXPECT_LT((found.inertia - expected).norm(), 1e-12);
}

TEST(MassProperties, OfAMeshThatIsABoxAreTheBoxes) {
  const Vec3 half(0.5, 1, 1.5);
  const MassProperties mesh = mass_properties(test::box_mesh(half)), box = mass_properties(Shape(Box{half}));
  EXPECT_LT(mesh.centre.norm(), 1e-14);
  EXPECT_LT((mesh.inertia - box.inertia).norm(), 1e-14);
}

TEST(MassProperties, APlaneHasNone) {
  EXPECT_THROW(mass_properties(Shape(HalfSpace{})), std::invalid_argument);
}

}  // namespace
}  // namespace weft
