// The reference stands still, and integrators approach it at their order.
#include "study/reference.h"

#include "fixtures.h"

namespace weft::study::test {
namespace {

const Allowance kPlenty{[] { return 0.0; }, 1e9};
const auto kGoOn = [](int) { return true; };

/// The error of a double-precision run of a third of a second, its systems solved nearly exactly.
template <class Description>
double error_of(int substeps, const Reference& reference) {
  Description implicit;
  implicit.substeps = substeps;
  implicit.tolerance = 1e-6;
  implicit.newton_iterations = 4;
  implicit.linear_iterations = 500;
  implicit.liveliness = 0;
  SimulationDescription description = swing();
  description.integrator = implicit;
  return errors_of(simulate<double>(description, {4, 20}, kGoOn), reference.answer).rms_position;
}

TEST(Reference, IntegratorsApproachItAtTheirOrderSlow) {
  const Reference reference = find_reference(swing(), 4, 20, 3e-6, kPlenty, kNothing);
  ASSERT_TRUE(reference.usable());
  EXPECT_LT(reference.change().rms_position, 3e-6);
  EXPECT_NEAR(reference.reduction(), 4, 0.8);  // second order: each halving of the step divides by 2^2
  EXPECT_FALSE(reference.chaotic);
  const double bdf2 = error_of<Bdf2Description>(8, reference) / error_of<Bdf2Description>(16, reference);
  EXPECT_NEAR(bdf2, 4, 0.8);
  const double backward_euler =
      error_of<BackwardEulerDescription>(8, reference) / error_of<BackwardEulerDescription>(16, reference);
  EXPECT_NEAR(backward_euler, 2, 0.2);
}

TEST(Reference, AnotherMethodAgreesSlow) {
  const Reference reference = find_reference(swing(), 4, 20, 3e-6, kPlenty, kNothing);
  SimulationDescription description = swing();
  description.integrator = SymplecticEulerDescription{800, 0.9};
  const Errors errors = errors_of(simulate<double>(description, {4, 20}, kGoOn), reference.answer);
  // First order: half a substep of 21 us at less than 1 m/s is 1e-5 m, of 0.6 m.
  EXPECT_LT(errors.rms_position, 2e-5);
}

TEST(Reference, StopsWhenTheNextDoublingWouldNotFit) {
  double seconds = 0;
  const auto tick = [&seconds] { seconds += 1; };  // every frame takes a second, whatever its substeps
  const Allowance allowance{[&seconds] { return seconds; }, 60};
  const Reference reference = find_reference(swing(), 3, 10, 0, allowance, tick);
  // 10 s for 2 substeps, 10 for 4 and 10 for its disturbed start; 8, 16 and 32 take 10 each.
  ASSERT_EQ(reference.rungs.size(), 5u);
  EXPECT_EQ(reference.rungs.back().substeps, 32);
  EXPECT_EQ(seconds, 60);
}

TEST(Reference, RunsTwoStepSizesWhateverTheAllowance) {
  const Allowance nothing{[] { return 1.0; }, 0};
  EXPECT_EQ(find_reference(swing(), 3, 2, 0, nothing, kNothing).rungs.size(), 2u);
}

// Hung by two corners from lying nearly flat, a limp sheet folds: what rounding does grows by orders.
TEST(Reference, ASceneThatFoldsIsChaoticSlow) {
  SimulationDescription description;
  ClothDescription& cloth = description.cloths.emplace_back();
  cloth.orientation = Quaternion(Eigen::AngleAxisd(1.4, Vec3::UnitX()));
  cloth.size = {2, 2};
  cloth.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}};
  cloth.perturbation = 0.001;
  cloth.material.bending = 0;
  description.effects = {GravityEffect{}};
  const Allowance nothing{[] { return 1.0; }, 0};
  const Reference reference = find_reference(description, 4, 180, 0, nothing, kNothing);
  EXPECT_TRUE(reference.chaotic) << reference.rounding.rms_position;
}

}  // namespace
}  // namespace weft::study::test
