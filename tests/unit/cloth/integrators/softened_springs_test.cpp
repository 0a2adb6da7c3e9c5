#include "cloth/integrators/softened_springs.h"

#include <gtest/gtest.h>

#include <limits>

#include "fixtures.h"

namespace weft {
namespace {

using test::flat_sheet;

/// A sheet of 1 m, 0.1 kg, of these constants.
template <class Real>
struct Stiff {
  explicit Stiff(double structural, double shear, double bending, double damping_time = 0)
      : particles(flat_sheet<Real>(17, 17, {1, 1})) {
    test::share_mass(particles, 0.1, Discretization::continuum);
    cloth.size = {1, 1};
    cloth.material = test::stiffnesses(structural, shear, bending);
    springs = Springs<Real>(cloth.material, cloth.discretization, cloth.size, particles.grid(), damping_time);
  }
  std::optional<Springs<Real>> softened(double h) const {
    return softened_springs(springs, cloth, particles.mass, h);
  }
  Particles<Real> particles;
  ClothDescription cloth;
  Springs<Real> springs;
};

TEST(SoftenedSprings, SpringsWhoseStiffnessHasItsDigitsStay) {
  EXPECT_FALSE(Stiff<float>(5000, 500, 5).softened(1.0 / 60));
  EXPECT_FALSE(Stiff<double>(5e7, 5e6, 5).softened(1.0 / 60));
}

/// The stiffest mode's w^2 h^2 in digits of the scalar.
template <class Real>
double digits_lost(const Springs<Real>& springs, const Field<Real>& mass, double h) {
  return springs.max_squared_frequency(mass) * h * h * double(std::numeric_limits<Real>::epsilon());
}

// Until the stiffest mode is tens of the scalar's last digits stiffer than inertia, not hundreds; what is
// soft stays.
TEST(SoftenedSprings, StiffOnesAreLoweredUntilTheyHave) {
  const double h = 1.0 / 60;
  const Stiff<float> sheet(1e10, 1e6, 5, 0.02);
  const double lost = digits_lost(sheet.springs, sheet.particles.mass, h);
  ASSERT_GT(lost, 100);
  const std::optional<Springs<float>> softened = sheet.softened(h);
  ASSERT_TRUE(softened);
  const double left = digits_lost(*softened, sheet.particles.mass, h);
  EXPECT_GT(left, 1);
  EXPECT_LT(left, 64);
  // No lower than that needs.
  EXPECT_FALSE(softened_springs(*softened, sheet.cloth, sheet.particles.mass, 0.5 * h));
  EXPECT_TRUE(softened_springs(*softened, sheet.cloth, sheet.particles.mass, 2 * h));
  EXPECT_EQ(softened->damping_time(), 0.02);
  ASSERT_EQ(softened->families().size(), sheet.springs.families().size());
  for (std::size_t i = 0; i < softened->families().size(); ++i) {
    const SpringFamily &is = softened->families()[i], &was = sheet.springs.families()[i];
    EXPECT_EQ(is.rest_length, was.rest_length);
    EXPECT_LE(is.stiffness, was.stiffness);
    const bool bending = std::abs(is.cols) == 2 || is.rows == 2;
    if (bending) {
      EXPECT_EQ(is.stiffness, was.stiffness);
    } else if (is.rows + is.cols == 1) {
      EXPECT_LT(is.stiffness, 0.5 * was.stiffness);
    }
  }
}

// The longer the step, the less of the stiffness is left: by the square.
TEST(SoftenedSprings, TwiceTheStepLeavesAQuarter) {
  const Stiff<float> sheet(1e11, 0, 0);
  const std::optional<Springs<float>> once = sheet.softened(1.0 / 60), twice = sheet.softened(1.0 / 30);
  ASSERT_TRUE(once && twice);
  EXPECT_NEAR(twice->families()[0].stiffness / once->families()[0].stiffness, 0.25, 1e-9);
}

// What is cut stays cut.
TEST(SoftenedSprings, TearsStay) {
  Stiff<float> sheet(1e11, 0, 0);
  const auto torn = std::make_shared<TornLinks>(sheet.particles.grid());
  torn->cut({3, 4, true});
  sheet.springs.tear(torn);
  const std::optional<Springs<float>> softened = sheet.softened(1.0 / 60);
  ASSERT_TRUE(softened);
  EXPECT_EQ(softened->torn(), torn);
}

}  // namespace
}  // namespace weft
