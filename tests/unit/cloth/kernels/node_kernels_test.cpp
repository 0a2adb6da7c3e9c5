#include "cloth/kernels/node_kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace weft::kernels {
namespace {

/// Longer than a vector register and no multiple of one.
constexpr std::size_t kNodes = 21;

struct Vectors {
  std::array<std::vector<double>, 3> values;
  explicit Vectors(double x = 0, double y = 0, double z = 0)
      : values{std::vector<double>(kNodes, x), std::vector<double>(kNodes, y),
               std::vector<double>(kNodes, z)} {}
  Components<double> view() { return {values[0].data(), values[1].data(), values[2].data()}; }
};

// Symplectic Euler under a constant force: v_n = n a h, r_n = a h^2 n (n + 1) / 2.
TEST(NodeKernels, EulerUnderAConstantForceFollowsTheSumOfItsSteps) {
  Vectors force(3, -6, 12), acceleration, velocity, position;
  const std::vector<double> inverse_mass(kNodes, 0.5);
  constexpr double kStep = 0.25;
  for (int step = 0; step < 4; ++step) {
    euler_update({force.view(), inverse_mass.data(), acceleration.view(), velocity.view(), position.view()},
                 kStep, kNodes);
  }
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_DOUBLE_EQ(acceleration.values[0][i], 1.5);
    EXPECT_DOUBLE_EQ(velocity.values[1][i], -3.0 * 4 * kStep);
    EXPECT_DOUBLE_EQ(position.values[2][i], 6.0 * kStep * kStep * 4 * 5 / 2);
  }
}

TEST(NodeKernels, EulerHoldsWhatHasNoInverseMass) {
  Vectors force(3, 3, 3), acceleration(1, 1, 1), velocity(2, 2, 2), position(7, 8, 9);
  const std::vector<double> inverse_mass(kNodes, 0);
  euler_update({force.view(), inverse_mass.data(), acceleration.view(), velocity.view(), position.view()},
               0.1, kNodes);
  for (std::size_t i = 0; i < kNodes; ++i) {
    EXPECT_EQ(acceleration.values[0][i], 0);
    EXPECT_EQ(velocity.values[1][i], 0);
    EXPECT_EQ(position.values[2][i], 9);
  }
}

TEST(NodeKernels, SumsAreWeightedNodeByNode) {
  Vectors force(1, 2, 3), field(10, 20, 30);
  std::vector<double> weight(kNodes);
  for (std::size_t i = 0; i < kNodes; ++i) weight[i] = static_cast<double>(i);
  add_weighted_constant(force.view(), weight.data(), 0, -9.81, 0, kNodes);
  add_scaled(force.view(), field.view(), 0.5, kNodes);
  add_weighted(force.view(), field.view(), weight.data(), -0.1, kNodes);
  for (std::size_t i = 0; i < kNodes; ++i) {
    const auto w = static_cast<double>(i);
    EXPECT_NEAR(force.values[0][i], 1 + 5 - w, 1e-12);
    EXPECT_NEAR(force.values[1][i], 2 - 9.81 * w + 10 - 2 * w, 1e-12);
    EXPECT_NEAR(force.values[2][i], 3 + 15 - 3 * w, 1e-12);
  }
}

TEST(NodeKernels, TellTheOneNodeThatIsFartherOff) {
  for (std::size_t odd = 0; odd < kNodes; ++odd) {
    Vectors a(1, 1, 1), b(1.5, 0.5, 1);
    EXPECT_TRUE(all_within(a.view(), b.view(), 0.5, kNodes));
    b.values[odd % 3][odd] = a.values[odd % 3][odd] - 0.5001;
    EXPECT_FALSE(all_within(a.view(), b.view(), 0.5, kNodes)) << odd;
    b.values[odd % 3][odd] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(all_within(a.view(), b.view(), 0.5, kNodes)) << odd;
  }
}

TEST(NodeKernels, TellTheOneValueThatIsNotFinite) {
  std::vector<double> values(kNodes, std::numeric_limits<double>::max());
  EXPECT_TRUE(all_finite(values.data(), kNodes));
  for (std::size_t odd = 0; odd < kNodes; ++odd) {
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
      std::vector<double> spoilt = values;
      spoilt[odd] = bad;
      EXPECT_FALSE(all_finite(spoilt.data(), kNodes)) << odd;
    }
  }
}

}  // namespace
}  // namespace weft::kernels
