// W^T K W of a spring between four nodes, as a matrix written out.
#include "cloth/solver/node_couplings.h"

#include <gtest/gtest.h>

#include "cloth/kernels/node_vector.h"
#include "cloth/solver/node_arrays.h"

namespace weft::test {
namespace {

TEST(NodeCouplings, AddTheirMatrixAndTellTheQuadraticForm) {
  const Grid grid = Grid::with_nodes(2, 3);
  NodeArrays<double> vectors(grid, 6);
  const auto x = vectors.vector(0), y = vectors.vector(3);
  const std::array<std::size_t, 4> nodes{grid.index(0, 0), grid.index(0, 2), grid.index(1, 1), 0};
  NodeCouplings<double>::Coupling coupling;
  coupling.node = nodes;
  coupling.weight = {1, -0.25, -0.75, 0};
  const Vec3 along(1, 2, 3);
  coupling.stiffness = along * along.transpose() + Eigen::Matrix3d::Identity();
  NodeCouplings<double> couplings;
  EXPECT_TRUE(couplings.empty());
  couplings.add(coupling);
  const std::array<Vec3, 3> values{Vec3(1, 0, 2), Vec3(0, 4, 0), Vec3(-1, 0, 0)};
  for (std::size_t i = 0; i < 3; ++i) weft::set(x, nodes[i], values[i]);
  weft::set(y, nodes[1], Vec3(10, 0, 0));

  const double form = couplings.multiply(x, y);

  const Vec3 difference = values[0] - 0.25 * values[1] - 0.75 * values[2];
  const Vec3 force = coupling.stiffness * difference;
  EXPECT_NEAR(form, difference.dot(force), 1e-12);
  const kernels::Components<const double> sum = y;
  EXPECT_NEAR((at(sum, nodes[0]) - force).norm(), 0, 1e-12);
  EXPECT_NEAR((at(sum, nodes[1]) - (Vec3(10, 0, 0) - 0.25 * force)).norm(), 0, 1e-12)
      << "on top of what was there";
  EXPECT_NEAR((at(sum, nodes[2]) + 0.75 * force).norm(), 0, 1e-12);
  EXPECT_EQ(at(sum, grid.index(1, 0)), Vec3(0, 0, 0));
  couplings.clear();
  EXPECT_EQ(couplings.multiply(x, y), 0);
}

}  // namespace
}  // namespace weft::test
