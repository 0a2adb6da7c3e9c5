#include "cloth/kernels/xpbd_kernels.h"

#include <gtest/gtest.h>

#include <vector>

namespace weft::kernels {
namespace {

const Grid kXpbdGrid = Grid::with_nodes(3, 6);
constexpr double kSubstep = 0.1;
using XpbdArray = std::vector<double, AlignedAllocator<double>>;

/// 3 x 6 nodes of 1 kg, 1.2 m apart along the rows, springs of 1 m between columns 0 and 1.
class XpbdKernels : public testing::Test {
 protected:
  void SetUp() override {
    for (int r = 0; r < kXpbdGrid.rows; ++r) {
      for (int c = 0; c < kXpbdGrid.cols; ++c) {
        position_.x.at(r, c) = 1.2 * c;
        inverse_mass_.at(r, c) = 1;
      }
    }
  }
  XpbdNodes<double> nodes() {
    return {components(force_), inverse_mass_.row(0), components(velocity_), components(position_),
            components(rounded_off_)};
  }
  /// One substep without impulses; the springs' k h^2, kg.
  void substep(double stiffness, double damping = 0) {
    set_inverse_masses(layout_, kXpbdGrid, inverse_mass_.row(0), sheet_.data());
    predict(layout_, kXpbdGrid, nodes(), impulse_time_, kSubstep, sheet_.data(), row_.data());
    XpbdArray lanes(layout_.stride), multiplier(layout_.stride * static_cast<std::size_t>(kXpbdGrid.rows));
    lanes[static_cast<std::size_t>(layout_.lane(0))] = stiffness;
    XpbdSprings<double> springs;
    springs.cols = 1;
    springs.rest_length = 1;
    springs.border_row_share = 1;
    springs.stiffness = lanes.data();
    springs.damping = damping;
    if (damping > 0) springs.multiplier = multiplier.data();
    project(layout_, springs, sheet_.data());
    take_over(layout_, kXpbdGrid, sheet_.data(), kSubstep, nodes(), row_.data());
  }

  const QuarterRows layout_{kXpbdGrid};
  VectorField<double> force_{kXpbdGrid}, velocity_{kXpbdGrid}, position_{kXpbdGrid}, rounded_off_{kXpbdGrid};
  Field<double> inverse_mass_{kXpbdGrid};
  XpbdArray sheet_ = XpbdArray(layout_.size(), 0.0),
            row_ = XpbdArray(static_cast<std::size_t>(kXpbdGrid.stride), 0.0);
  double impulse_time_ = 0;
};

// Macklin et al. 2016, Eq. 18: each end moves w (l - l0) / (2 w + 1 / (k h^2)) = 0.2 / (2 + 2) = 0.05 m.
TEST_F(XpbdKernels, ASpringIsProjectedByItsCompliance) {
  substep(0.5);
  for (int r = 0; r < kXpbdGrid.rows; ++r) {
    EXPECT_NEAR(position_.x.at(r, 0), 0.05, 1e-14);
    EXPECT_NEAR(position_.x.at(r, 1), 1.15, 1e-14);
    EXPECT_NEAR(position_.x.at(r, 2), 2.4, 1e-14);
    EXPECT_NEAR(velocity_.x.at(r, 0), 0.05 / kSubstep, 1e-12);
    EXPECT_NEAR(velocity_.x.at(r, 1), -0.05 / kSubstep, 1e-12);
  }
}

// Without an inverse mass an end stays: the other moves 0.2 / (1 + 2).
TEST_F(XpbdKernels, AFixedEndLeavesAllToTheOther) {
  inverse_mass_.at(1, 0) = 0;
  substep(0.5);
  EXPECT_EQ(position_.x.at(1, 0), 0);
  EXPECT_NEAR(position_.x.at(1, 1), 1.2 - 0.2 / 3, 1e-14);
}

// 0.3 m/s apart make the spring 0.03 m longer than 1.2 m: with gamma = 2 each end moves
// (0.23 + 2 * 0.03) / (3 * 2 + 2).
TEST_F(XpbdKernels, DampingResistsTheGrowthOfTheSubstep) {
  velocity_.x.at(1, 1) = 0.3;
  substep(0.5, 2);
  EXPECT_NEAR(position_.x.at(1, 1), 1.23 - 0.29 / 8, 1e-14);
  EXPECT_NEAR(position_.x.at(1, 0), 0.29 / 8, 1e-14);
}

// v += t F / m, then r += h v; a fixed node's velocity is 0.
TEST_F(XpbdKernels, PredictionIsABallisticStep) {
  force_.y.at(2, 4) = 3;
  inverse_mass_.at(2, 4) = 0.5;
  velocity_.y.at(2, 5) = 8;
  inverse_mass_.at(2, 5) = 0;
  impulse_time_ = 0.2;
  substep(0);
  EXPECT_NEAR(velocity_.y.at(2, 4), 0.3, 1e-14);
  EXPECT_NEAR(position_.y.at(2, 4), 0.03, 1e-14);
  EXPECT_EQ(velocity_.y.at(2, 5), 0);
  EXPECT_EQ(position_.y.at(2, 5), 0);
}

}  // namespace
}  // namespace weft::kernels
