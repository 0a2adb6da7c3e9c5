// A constraint's forces by hand: two nodes over the middle of two others, which are fixed.
#include "cloth/contact/constraints/layer_constraint.h"

#include <gtest/gtest.h>

#include "cloth/solver/node_arrays.h"

namespace weft::test {
namespace {

class Constrained : public ::testing::Test {
 protected:
  Constrained() {
    constraint.coupling.node = {0, 1, 2, 3};
    constraint.coupling.weight = {0.25, 0.75, 0, 0};  // of the free ones alone
    constraint.normal = {0, 1, 0};
    constraint.slid = {0.01, 0, 0};
    constraint.spare = 0.002;
    constraint.stiffness = 1000;
    constraint.friction = 100;
    constraint.pressed = 5;
    constraint.grip = {0.5, 0, 0};
    weft::set(moves.vector(), 0, Vec3(0.04, -0.02, 0));
    weft::set(moves.vector(), 1, Vec3(0, -0.004, 0.04));
    weft::set(moves.vector(), 2, Vec3(9, 9, 9));
  }
  std::array<kernels::Components<const double>, 1> moved() { return {moves.vector()}; }
  NodeArrays<double> moves{Grid::with_nodes(2, 2), 3};
  LayerConstraint<double> constraint;
};

TEST_F(Constrained, RoomIsWhatIsSpareAndWhatTheNodesMoveApart) {
  // 0.002 - 0.25 0.02 - 0.75 0.004
  EXPECT_NEAR(constraint.room(moved()), -0.006, 1e-15);
}

TEST_F(Constrained, PushesByItsSpringAndWhatIsCarriedOn) {
  EXPECT_NEAR(constraint.push(moved()), 5 + 1000 * 0.006, 1e-12);
}

TEST_F(Constrained, RubsAcrossTheNormalAlone) {
  // The others slid 0.01, the nodes 0.25 0.04 along x and 0.75 0.04 along z.
  EXPECT_NEAR((constraint.slip(moved()) - Vec3(0.02, 0, 0.03)).norm(), 0, 1e-15);
  EXPECT_NEAR((constraint.rub(moved()) - Vec3(0.5 - 2, 0, -3)).norm(), 0, 1e-12);
}

TEST_F(Constrained, IsBetweenClothsIfOthersNodesCanMove) {
  constraint.inertia = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(constraint.between_cloths());
  constraint.inertia = 1e6;
  EXPECT_TRUE(constraint.between_cloths());
}

TEST_F(Constrained, HasAPartOfItsOwnUnlessItsFreeNodesAreOfSeveral) {
  EXPECT_EQ(constraint.only_part(), 0U);
  constraint.coupling.part = {1, 1, 0, 0};  // those of part 0 are fixed
  EXPECT_EQ(constraint.only_part(), 1U);
  constraint.coupling.part = {1, 0, 0, 0};
  EXPECT_FALSE(constraint.only_part());
}

}  // namespace
}  // namespace weft::test
