// What a change of the positions does to the springs' energy, against what their linearisation promises.
#include <gtest/gtest.h>

#include "cloth/sheet/springs.h"
#include "cloth/solver/node_arrays.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;
using test::flat_sheet;
using test::set;

template <class Real>
class SpringEnergy : public ::testing::Test {};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(SpringEnergy, Scalars);

/// u . K u of a spring as the implicit methods have it: its sideways stiffness is never negative.
double linear_stiffness(const Vec3& d, double rest_length, double stiffness, const Vec3& u) {
  const Vec3 n = d.normalized();
  const double along = n.dot(u), sideways = std::max(0.0, 1 - rest_length / d.norm());
  return stiffness * (along * along + sideways * (u.squaredNorm() - along * along));
}

TYPED_TEST(SpringEnergy, ModelErrorIsTheEnergyLessItsLinearisation) {
  // Single precision: single terms are rounded to an epsilon of the energies they are differences of, and
  // partly cancel.
  Material material;
  material.structural = 5000;
  material.shear = 500;
  material.bending = 50;
  const double tolerance = 64 * double(std::numeric_limits<TypeParam>::epsilon());
  for (const double size : {1e-2, 1.0}) {  // of the change; the springs' ends pass each other at 1
    Particles<TypeParam> sheet = flat_sheet<TypeParam>(11, 19, {2, 1}), moved(sheet.grid()),
                         uneven(sheet.grid());
    test::randomise(uneven.position, -0.02, 0.02, 7);
    test::randomise(moved.position, -size, size, 8);
    each_node(sheet.grid(), [&](int r, int c) {
      set(sheet.position, r, c, sheet.position_at(r, c) + uneven.position_at(r, c));
    });
    const Springs<TypeParam> springs(material, Discretization::continuum, {2, 1}, sheet.grid());
    double sum = 0, magnitude = 0, largest = 0, energy = 0;
    for (const test::ListedSpring& s : test::list_springs(springs.families(), sheet.grid())) {
      const Vec3 d = sheet.position_at(s.r0, s.c0) - sheet.position_at(s.r1, s.c1);
      const Vec3 u = moved.position_at(s.r0, s.c0) - moved.position_at(s.r1, s.c1);
      const double after = spring_energy(d + u, s.rest_length, s.stiffness);
      const double model = spring_energy(d, s.rest_length, s.stiffness) -
                           spring_force(d, s.rest_length, s.stiffness).dot(u) +
                           linear_stiffness(d, s.rest_length, s.stiffness, u) / 2;
      sum += after - model;
      magnitude += std::abs(after - model);
      largest = std::max(largest, std::abs(after - model));
      energy += after + model;
    }
    NodeArrays<TypeParam> arrays(sheet.grid(), 6);
    const auto position = arrays.vector(0), change = arrays.vector(3);
    each_node(sheet.grid(), [&](int r, int c) {
      const std::size_t i = sheet.grid().index(r, c);
      position.x[i] = sheet.position.x.at(r, c), change.x[i] = moved.position.x.at(r, c);
      position.y[i] = sheet.position.y.at(r, c), change.y[i] = moved.position.y.at(r, c);
      position.z[i] = sheet.position.z.at(r, c), change.z[i] = moved.position.z.at(r, c);
    });
    const kernels::SpringModelError error = springs.model_error(sheet.grid(), position, change);
    EXPECT_GT(magnitude, 1e-2 * energy);  // there is something to compare
    EXPECT_NEAR(error.sum / energy, sum / energy, tolerance) << size;
    EXPECT_NEAR(error.magnitude / energy, magnitude / energy, tolerance) << size;
    EXPECT_NEAR(error.largest / largest, 1, 1e3 * tolerance) << size;
  }
}

}  // namespace
}  // namespace weft
