#include "cloth/sheet/start.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;

/// 3 m wide and 1 m high, 32 x 16 cells at level 4, face along +x: turned about y by a right angle.
ClothDescription turned_cloth() {
  ClothDescription cloth;
  cloth.size = {3, 1};
  cloth.base_cells = {2, 1};
  cloth.position = {10, 20, -30};
  cloth.orientation = Quaternion(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3(0, 1, 0)));
  cloth.velocity = {1, 2, 3};
  return cloth;
}

// u goes along what was +x and is -z, v down.
TEST(Start, AClothLiesFlatAboutItsPosition) {
  const Particles<double> particles = start<double>(turned_cloth(), 4);
  const Grid& grid = particles.grid();
  EXPECT_EQ(grid.rows, 17);
  EXPECT_EQ(grid.cols, 33);
  each_node(grid, [&](int r, int c) {
    const Vec3 expected(10, 20.5 - r / 16.0, -30 + 1.5 - 3 * c / 32.0);
    EXPECT_LT((particles.position_at(r, c) - expected).norm(), 1e-12);
    EXPECT_EQ(particles.velocity_at(r, c), Vec3(1, 2, 3));
  });
}

// In single precision, too, wherever in the world: positions are from a place near it.
TEST(Start, FarAwayAClothHasTheSameDigits) {
  ClothDescription cloth = turned_cloth();
  cloth.position = {1e6, -2e6, 3e6};
  const Particles<float> particles = start<float>(cloth, 4);
  EXPECT_LT((particles.place - cloth.position).norm(), 2);
  const Vec3 width = particles.position_at(0, 32) - particles.position_at(0, 0);
  EXPECT_LT((width - Vec3(0, 0, -3)).norm(), 1e-6);
}

// Nodes in the world, row by row, whatever position and size say.
TEST(Start, AClothStartsAtItsNodes) {
  ClothDescription cloth = turned_cloth();
  each_node(Grid::with_nodes(17, 33), [&](int r, int c) { cloth.nodes.emplace_back(r, 0.5 * c, 7); });
  const Particles<double> particles = start<double>(cloth, 4);
  each_node(particles.grid(), [&](int r, int c) {
    EXPECT_LT((particles.position_at(r, c) - Vec3(r, 0.5 * c, 7)).norm(), 1e-12);
  });
  EXPECT_THROW(start<double>(cloth, 5), std::invalid_argument);
  cloth.nodes.pop_back();
  EXPECT_THROW(start<double>(cloth, 4), std::invalid_argument);
}

// Folded over along u = 1/2: columns as far from both borders lie on each other, opened by 1 % at most; its
// springs are hardly stretched.
TEST(Start, ABagLiesFoldedOverAndHardlyOpen) {
  ClothDescription cloth = turned_cloth();
  cloth.sewn = true;
  cloth.orientation = Quaternion::Identity();
  cloth.position = {0, 0, 0};
  const Particles<double> particles = start<double>(cloth, 4);
  double opening = 0;
  each_node(particles.grid(), [&](int r, int c) {
    const Vec3 front = particles.position_at(r, c), back = particles.position_at(r, 32 - c);
    EXPECT_NEAR(front.x(), back.x(), 1e-12);
    EXPECT_NEAR(front.y(), back.y(), 1e-12);
    EXPECT_NEAR(front.z(), -back.z(), 1e-12);
    opening = std::max(opening, std::abs(front.z() - back.z()));
    const bool rim = c == 0 || c == 32 || r == 0 || r == 16, fold = c == 16;
    EXPECT_TRUE(!(rim || fold) || std::abs(front.z()) < 1e-12);
    if (c < 32) {
      const double length = (particles.position_at(r, c + 1) - front).norm();
      EXPECT_NEAR(length, 3.0 / 32, 5e-4 * 3 / 32);
    }
  });
  EXPECT_NEAR(opening, 0.01, 1e-12);  // of the shorter edge, 1 m
}

// Along the normal, here +x, by no more than that; not at all without one, nor where nodes are pinned.
TEST(Start, APerturbationMovesFreeNodesAlongTheNormal) {
  ClothDescription cloth = turned_cloth();
  cloth.perturbation = 0.02;
  Particles<double> particles = start<double>(cloth, 4);
  particles.inverse_mass.fill(1);
  particles.inverse_mass.at(3, 5) = 0;
  Particles<double> all_free = particles;
  all_free.inverse_mass.fill(1);
  const Particles<double> before = particles;
  perturb(cloth, 7, particles);
  perturb(cloth, 7, all_free);
  double most = 0, sum = 0;
  each_node(particles.grid(), [&](int r, int c) {
    const Vec3 moved = particles.position_at(r, c) - before.position_at(r, c);
    EXPECT_LT(Vec3(0, moved.y(), moved.z()).norm(), 1e-14);
    EXPECT_LE(std::abs(moved.x()), 0.02);
    most = std::max(most, std::abs(moved.x()));
    sum += moved.x();
    // Pins do not change what the others get.
    if (r == 3 && c == 5) {
      EXPECT_TRUE(moved.isZero(0));
    } else {
      EXPECT_EQ(particles.position_at(r, c), all_free.position_at(r, c));
    }
  });
  EXPECT_GT(most, 0.019);
  EXPECT_LT(std::abs(sum / particles.grid().nodes()), 0.002);  // uniform: 0.02 / sqrt(3 * 561) = 0.0005
  cloth.perturbation = 0;
  Particles<double> still = before;
  perturb(cloth, 7, still);
  EXPECT_TRUE(test::same_state(still, before));
}

}  // namespace
}  // namespace weft
