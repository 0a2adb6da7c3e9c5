#include "cloth/kernels/spring_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cloth/kernels/limited_kernels.h"
#include "cloth/kernels/spring_energy_kernels.h"
#include "cloth/kernels/strain_damping_kernels.h"
#include "cloth/kernels/torn_kernels.h"
#include "cloth/solver/node_arrays.h"

namespace weft::kernels {
namespace {

const Grid kSpringGrid = Grid::with_nodes(3, 3);
constexpr double kStiffness = 40, kRest = 1;

/// 3 x 3 nodes, of which springs along the rows join the first two columns, structural and 1 m long at rest;
/// those of the first and the last row have half the stiffness. The second column's nodes stand at (1.2, 0.9)
/// from the first's: 1.5 m.
class SpringKernels : public testing::Test {
 protected:
  void SetUp() override {
    std::fill(stiffness_.begin(), stiffness_.end(), 0.0);
    for (int r = 0; r < kSpringGrid.rows; ++r) {
      stiffness_[kSpringGrid.index(r, 0)] = kStiffness;
      position_.x[kSpringGrid.index(r, 1)] = 1.2;
      for (const int c : {0, 1, 2}) position_.y[kSpringGrid.index(r, c)] = -r + (c == 1 ? 0.9 : 0);
      position_.x[kSpringGrid.index(r, 2)] = 4;
    }
    const double* none = none_[0];
    for (SpringColumns<double>* family :
         {&springs_.along_v, &springs_.falling, &springs_.rising, &springs_.bending_u, &springs_.bending_v})
      *family = {none, 1, 1};
    springs_.along_u = {stiffness_.data(), kRest, 1.3};
    springs_.border_row_share = 0.5;
  }
  static double share(int r) { return r == 1 ? 1 : 0.5; }

  using Array = std::vector<double, AlignedAllocator<double>>;
  Array stiffness_ = Array(kSpringGrid.size() + 2 * kRowAlign);
  NodeArrays<double> none_{kSpringGrid, 1}, vectors_{kSpringGrid, 9};
  Components<double> position_ = vectors_.vector(0), force_ = vectors_.vector(3),
                     change_ = vectors_.vector(6);
  Array work_ = Array(std::max(spring_work_size(kSpringGrid), strain_damping_work_size(kSpringGrid)), 0.0);
  SpringLattice<double> springs_;
};

// Eq. 1: k (l - l0) towards the other end, along (0.8, 0.6).
TEST_F(SpringKernels, AStretchedSpringPullsItsEndsTogether) {
  add_spring_forces<double>(springs_, kSpringGrid, position_, force_, work_.data());
  for (int r = 0; r < kSpringGrid.rows; ++r) {
    const double pull = share(r) * kStiffness * 0.5;
    EXPECT_NEAR(force_.x[kSpringGrid.index(r, 0)], 0.8 * pull, 1e-12);
    EXPECT_NEAR(force_.y[kSpringGrid.index(r, 0)], 0.6 * pull, 1e-12);
    EXPECT_NEAR(force_.x[kSpringGrid.index(r, 1)], -0.8 * pull, 1e-12);
    EXPECT_NEAR(force_.y[kSpringGrid.index(r, 1)], -0.6 * pull, 1e-12);
    EXPECT_EQ(force_.x[kSpringGrid.index(r, 2)], 0);
  }
}

// 1/2 k (l - l0)^2 of springs of 1, 1/2 and 1/2 times k.
TEST_F(SpringKernels, EnergyIsTheSumOfTheSprings) {
  EXPECT_NEAR(spring_energy<double>(springs_, kSpringGrid, position_), 2 * kStiffness * 0.25 / 2, 1e-12);
}

// Turned by a right angle about its first end without a stretch, from 1.5 m: the linearisation of the upper
// node sees d = (-2.1, 0.3), along n -1.5 and across it 1.5 m, so with the axial stiffness k and across it k
// (1 - l0/l): E = 1/2 k 0.5^2 + k 0.5 (-1.5) + 1/2 k 1.5^2 + 1/2 k/3 1.5^2; the energy has not changed.
TEST_F(SpringKernels, ATurnIsWhatTheModelMisses) {
  for (int r = 0; r < kSpringGrid.rows; ++r) {
    change_.x[kSpringGrid.index(r, 1)] = -0.9 - 1.2;
    change_.y[kSpringGrid.index(r, 1)] = 1.2 - 0.9;
  }
  const SpringModelError error = spring_model_error<double>(springs_, kSpringGrid, position_, change_);
  const double promised = 0.5 * -1.5 + 1.5 * 1.5 / 2 + 1.5 * 1.5 / 6;  // less 1/2 k 0.5^2, over k
  EXPECT_NEAR(error.sum, -2 * kStiffness * promised, 1e-10);
  EXPECT_NEAR(error.magnitude, 2 * kStiffness * promised, 1e-10);
  EXPECT_NEAR(error.largest, kStiffness * promised, 1e-10);
  EXPECT_EQ(error.struck, 0);
}

// Beyond 1.3 m three times as stiff again: k 0.5 + 3 k 0.2.
TEST_F(SpringKernels, BeyondItsLimitASpringIsStiffer) {
  springs_.excess = 3;
  add_limited_spring_forces<double>(springs_, kSpringGrid, position_, force_, work_.data());
  EXPECT_NEAR(force_.x[kSpringGrid.index(1, 0)], 0.8 * kStiffness * (0.5 + 3 * 0.2), 1e-12);
  EXPECT_NEAR(spring_energy<double>(springs_, kSpringGrid, position_),
              2 * kStiffness / 2 * (0.5 * 0.5 + 3 * 0.2 * 0.2), 1e-12);
}

// -factor k n (n . (change_i - change_j)): of 0.5 m/s away from each other along x, n . d = 0.4.
TEST_F(SpringKernels, StrainDampingResistsTheRateOfLength) {
  for (int r = 0; r < kSpringGrid.rows; ++r) {
    change_.x[kSpringGrid.index(r, 1)] = 0.5;
    change_.z[kSpringGrid.index(r, 1)] = 7;  // across
  }
  add_strain_damping<double>(springs_, kSpringGrid, position_, change_, 0.1, force_, work_.data());
  const double pull = 0.1 * kStiffness * 0.4;
  EXPECT_NEAR(force_.x[kSpringGrid.index(1, 0)], 0.8 * pull, 1e-12);
  EXPECT_NEAR(force_.y[kSpringGrid.index(1, 1)], -0.6 * pull, 1e-12);
  EXPECT_NEAR(force_.x[kSpringGrid.index(0, 0)], 0.4 * pull, 1e-12);
  EXPECT_EQ(force_.z[kSpringGrid.index(1, 1)], 0);
}

// However far it turned, what counts is the length: a turn of a right angle has none.
TEST_F(SpringKernels, GrowthDampingDoesNotSeeTurns) {
  for (int r = 0; r < kSpringGrid.rows; ++r) {  // from (0.9, -1.2)
    change_.x[kSpringGrid.index(r, 1)] = 1.2 - 0.9;
    change_.y[kSpringGrid.index(r, 1)] = 0.9 + 1.2;
  }
  add_growth_damping<double>(springs_, kSpringGrid, position_, change_, 0.1, force_, work_.data());
  for (int r = 0; r < kSpringGrid.rows; ++r) EXPECT_NEAR(force_.x[kSpringGrid.index(r, 0)], 0, 1e-12);
}

// Each row has its own stiffnesses: a spring that is cut gives nothing.
TEST_F(SpringKernels, ACutSpringGivesNoForce) {
  springs_.row_step = kSpringGrid.stride;
  stiffness_[kSpringGrid.index(1, 0)] = 0;
  // Of the others all rows are alike, none.
  NodeArrays<double> none(kSpringGrid, 1);
  for (SpringColumns<double>* family :
       {&springs_.along_v, &springs_.falling, &springs_.rising, &springs_.bending_u, &springs_.bending_v})
    family->stiffness = none[0];
  add_torn_spring_forces<double>(springs_, kSpringGrid, position_, force_, work_.data());
  EXPECT_EQ(force_.x[kSpringGrid.index(1, 0)], 0);
  EXPECT_NEAR(force_.x[kSpringGrid.index(0, 0)], 0.8 * 0.5 * kStiffness * 0.5, 1e-12);
}

}  // namespace
}  // namespace weft::kernels
