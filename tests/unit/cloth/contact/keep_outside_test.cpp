// What someone moves after a cloth's step does not end in a solid, nor beyond one (Cloth::keep_outside).
#include <gtest/gtest.h>

#include <algorithm>

#include "cloth/world/cloth.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::get;
using test::kFrame;
using test::set;

/// A sheet of 1 m in the x-y plane, z = 0, of 9 x 9 nodes, on which no force acts; it has made one step.
class KeepOutside : public ::testing::Test {
 protected:
  static Solid solid(const Shape& shape, const Vec3& centre) {
    Solid solid;
    solid.id = 7;
    solid.shape = shape;
    solid.position = solid.start = centre;
    return solid;
  }
  void step(const std::vector<Solid>& solids) {
    cloth_.advance(solids, Air({}, 1), 0, kFrame);
    before_ = positions();
  }
  const VectorField<double>& positions() const { return cloth_.particles().position; }
  std::vector<Touch> touches() const { return {cloth_.touches().begin(), cloth_.touches().end()}; }
  void move(int r, int c, const Vec3& to) { set(cloth_.particles().position, r, c, to); }
  std::vector<Touch> keep() { return cloth_.keep_outside(before_, kFrame); }
  Vec3 place(int r, int c) { return get(cloth_.particles().position, r, c); }
  std::size_t index(int r, int c) { return cloth_.particles().grid().index(r, c); }
  /// All but the node at this place are where the step left them.
  void expect_others_stayed(int row, int col) {
    test::each_node(cloth_.particles().grid(), [&](int r, int c) {
      if (r == row && c == col) return;
      EXPECT_EQ(place(r, c), get(before_, r, c)) << r << ", " << c;
    });
  }

  VectorField<double> before_;  ///< the places that moves lead from

 private:
  static ClothDescription sheet() {
    ClothDescription description;
    description.size = {1, 1};
    description.min_level = description.max_level = description.initial_level = 3;
    return description;
  }
  Cloth<double> cloth_{sheet(), {}, SymplecticEulerDescription{}, 1};
};

TEST_F(KeepOutside, NothingIsDoneWithoutSolids) {
  step({});
  move(4, 4, {0, 0, -0.3});
  EXPECT_TRUE(keep().empty());
  EXPECT_EQ(place(4, 4), Vec3(0, 0, -0.3));
}

TEST_F(KeepOutside, BringsANodeOutOfABall) {
  // Straight down over its middle, 50 mm deep: back up to its surface, 0.1 m under the sheet.
  step({solid(Sphere{0.2}, {0, 0, -0.3})});
  move(4, 4, {0, 0, -0.15});
  EXPECT_EQ(keep(), (std::vector<Touch>{{index(4, 4), 7}}));
  EXPECT_LT((place(4, 4) - Vec3(0, 0, -0.1)).norm(), 1e-9);
  expect_others_stayed(4, 4);
}

TEST_F(KeepOutside, BringsANodeBackThroughAPlate) {
  // 4 mm thick, moved 0.5 m beyond: the surface it came through, not the nearest.
  step({solid(Box{{1, 1, 0.002}}, {0, 0, -0.1})});
  move(2, 5, {0.125, 0.25, -0.6});
  EXPECT_EQ(keep().size(), 1U);
  EXPECT_NEAR(place(2, 5).z(), -0.098, 1e-9);
  expect_others_stayed(2, 5);
}

TEST_F(KeepOutside, ASolidsOwnWayIsOver) {
  // A ball that came past under the sheet in the step, where the node is moved to now.
  Solid ball = solid(Sphere{0.2}, {2, 0, -0.3});
  ball.start = {-2, 0, -0.3};
  step({ball});
  move(4, 4, {0, 0, -0.25});
  EXPECT_TRUE(keep().empty());
  EXPECT_EQ(place(4, 4), Vec3(0, 0, -0.25));
}

TEST_F(KeepOutside, WhatMetOneBeforeStaysAmongTheTouches) {
  step({solid(Sphere{0.2}, {0, 0, -0.3})});
  for (const int column : {4, 3}) {
    move(4, column, {(column - 4) / 8.0, 0, -0.2});
    EXPECT_EQ(keep(), (std::vector<Touch>{{index(4, column), 7}}));
    before_ = positions();
  }
  std::vector<Touch> touches = this->touches();
  std::sort(touches.begin(), touches.end());
  EXPECT_EQ(touches, (std::vector<Touch>{{index(4, 3), 7}, {index(4, 4), 7}}));
}

}  // namespace
}  // namespace weft
