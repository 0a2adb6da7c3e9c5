// Momenta, energies and the check for non-finite states, by hand.
#include "cloth/sheet/diagnostics.h"

#include <gtest/gtest.h>

#include <limits>

#include "fixtures.h"

namespace weft {
namespace {

using test::set;

/// Two moving nodes of 2 x 2: 2 kg at (1,0,0) with (0,3,0), 1 kg at (0,2,0) with (1,0,-1); the others rest.
template <class Real>
Particles<Real> two_movers() {
  Particles<Real> p = test::flat_sheet<Real>(2, 2, {1, 1});
  p.mass.at(0, 0) = 2;
  p.inverse_mass.at(0, 0) = Real(0.5);
  set(p.position, 0, 0, {1, 0, 0});
  set(p.velocity, 0, 0, {0, 3, 0});
  set(p.position, 1, 1, {0, 2, 0});
  set(p.velocity, 1, 1, {1, 0, -1});
  return p;
}

template <class Real>
class Diagnostics : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Diagnostics, Scalars);

TYPED_TEST(Diagnostics, MomentaAndEnergiesByHand) {
  const Particles<TypeParam> p = two_movers<TypeParam>();
  EXPECT_EQ(linear_momentum(p), Vec3(1, 6, -1));        // 2 (0,3,0) + (1,0,-1)
  EXPECT_EQ(angular_momentum(p), Vec3(-2, 0, 4));       // (1,0,0) x (0,6,0) + (0,2,0) x (1,0,-1)
  EXPECT_EQ(kinetic_energy(p), 0.5 * 2 * 9 + 0.5 * 2);  // 10 J
  // -sum m a.r with a = (0,-10,0): heights 0 and 2 m, and the two resting nodes at 0.5 and -0.5 m.
  EXPECT_NEAR(gravitational_energy(p, {0, -10, 0}), 20.0, 1e-12);
}

TYPED_TEST(Diagnostics, MassAndInertiaByHand) {
  // 2 kg at (1,0,0), 1 kg each at (0.5,0.5,0), (-0.5,-0.5,0) and (0,2,0).
  const Particles<TypeParam> p = two_movers<TypeParam>();
  EXPECT_EQ(total_mass(p), 5);
  EXPECT_LT((centre_of_mass(p) - Vec3(0.4, 0.4, 0)).norm(), 1e-15);
  Eigen::Matrix3d inertia;  // sum m (r^2 - r r^T)
  inertia << 4.5, -0.5, 0, -0.5, 2.5, 0, 0, 0, 7;
  EXPECT_EQ(inertia_about(Vec3(0, 0, 0), p), inertia);
  // Parallel axes: about a point it has more than about the centre, by 5 kg times the square of the way.
  const Vec3 way = Vec3(0.4, 0.4, 0);
  EXPECT_NEAR(inertia_about(centre_of_mass(p), p)(2, 2), 7 - 5 * way.squaredNorm(), 1e-12);
}

TYPED_TEST(Diagnostics, AHeldNodeHasNoKineticEnergy) {
  Particles<TypeParam> p = two_movers<TypeParam>();
  p.inverse_mass.at(0, 0) = 0;
  EXPECT_EQ(kinetic_energy(p), 1.0);
}

TYPED_TEST(Diagnostics, CentreIsTheMeanOfTheNodes) {
  // Eq. 7's centre of the cloth: (1,0,0), (0.5,0.5,0), (-0.5,-0.5,0), (0,2,0).
  EXPECT_EQ(centre(two_movers<TypeParam>()), Vec3(0.25, 0.5, 0));
}

TYPED_TEST(Diagnostics, OneBadNumberAnywhereIsFound) {
  // In the first and last node and in one inside, in each component, of positions and velocities.
  using Limits = std::numeric_limits<TypeParam>;
  Particles<TypeParam> p = test::flat_sheet<TypeParam>(17, 33, {2, 1});
  ASSERT_TRUE(is_finite(p));
  for (VectorField<TypeParam>* field : {&p.position, &p.velocity}) {
    for (Field<TypeParam>* component : {&field->x, &field->y, &field->z}) {
      for (const auto& [r, c] : {std::pair{0, 0}, {5, 16}, {16, 32}}) {
        for (TypeParam bad : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
          const TypeParam good = component->at(r, c);
          component->at(r, c) = bad;
          EXPECT_FALSE(is_finite(p)) << r << ", " << c << ": " << bad;
          component->at(r, c) = good;
        }
      }
    }
  }
  EXPECT_TRUE(is_finite(p));
}

TYPED_TEST(Diagnostics, HugeButFiniteIsFinite) {
  Particles<TypeParam> p = test::flat_sheet<TypeParam>(9, 9, {2, 2});
  p.position.x.at(3, 3) = std::numeric_limits<TypeParam>::max();
  p.position.x.at(3, 4) = std::numeric_limits<TypeParam>::max();
  p.velocity.y.at(8, 8) = std::numeric_limits<TypeParam>::lowest();
  EXPECT_TRUE(is_finite(p));
}

}  // namespace
}  // namespace weft
