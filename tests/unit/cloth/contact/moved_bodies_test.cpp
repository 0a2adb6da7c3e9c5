// What lies on a body that another body has moved since is held by the face it lay on.
#include <gtest/gtest.h>

#include <numbers>

#include "cloth/contact/constraints/contact_constraints.h"
#include "cloth/solver/node_arrays.h"
#include "fixtures.h"

namespace weft::test {
namespace {

constexpr double kMovedStep = 0.01;

/// A cube of 0.2 m and 1 kg that yields, at rest.
Solid cube_at(const Vec3& place) {
  Solid cube;
  cube.id = kFirstObstacle;
  cube.shape = Box{{0.1, 0.1, 0.1}};
  cube.start = cube.position = place;
  cube.inverse_mass = 1;
  cube.inverse_inertia = Eigen::Matrix3d::Identity() * (6 / 0.04);  // m s^2 / 6
  return cube;
}

/// The middle node's block of the system: along the normal alone, as nothing rubs.
Eigen::Matrix3d held(ContactConstraints<double>& contacts, AttachedBodies<double>& bodies,
                     const Particles<double>& sheet, std::vector<Solid> solids) {
  const Grid& grid = sheet.grid();
  const std::size_t i = grid.index(1, 1);
  contacts.begin({Touch{i, kFirstObstacle}}, {}, sheet, solids, Substep{0, 1, kMovedStep}, false, bodies);
  NodeArrays<double> blocks(grid, 6), vectors(grid, 6), numbers(grid, 1);
  const kernels::Blocks<double> block = blocks.blocks();
  std::fill_n(numbers[0], grid.size(), 1 / (kMovedStep * kMovedStep));
  NodeCouplings<double> couplings;
  contacts.add_to(block, couplings, vectors.vector(0), bodies, numbers[0], 1e4, {}, vectors.vector(3));
  contacts.finish(vectors.vector(3), bodies, solids);
  return Eigen::Matrix3d{{block.xx[i], block.xy[i], block.xz[i]},
                         {block.xy[i], block.yy[i], block.yz[i]},
                         {block.xz[i], block.yz[i], block.zz[i]}};
}

void expect_along(const Vec3& normal, const Eigen::Matrix3d& block) {
  EXPECT_GT(block.trace(), 0);
  EXPECT_LT((block - block.trace() * normal * normal.transpose()).norm(), 1e-12 * block.trace());
}

}  // namespace

// 15 mm from the cube's side: 30 mm inside it is next to that, but it lay on the top. Anew it is led out of
// the side.
TEST(MovedBodies, HoldANodeByTheFaceItLayOn) {
  const Particles<double> sheet = flat_sheet<double>(3, 3, {1, 1});
  ContactConstraints<double> contacts, anew;
  AttachedBodies<double> bodies;
  expect_along({0, 0, 1}, held(contacts, bodies, sheet, {cube_at({0.085, 0, -0.1})}));
  expect_along({0, 0, 1}, held(contacts, bodies, sheet, {cube_at({0.085, 0, -0.07})}));
  expect_along({1, 0, 0}, held(anew, bodies, sheet, {cube_at({0.085, 0, -0.07})}));
}

}  // namespace weft::test
