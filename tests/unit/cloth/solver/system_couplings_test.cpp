// Springs between nodes of two cloths' systems.
#include "cloth/solver/system_couplings.h"

#include <gtest/gtest.h>

#include "cloth/kernels/node_vector.h"
#include "cloth/solver/node_arrays.h"

namespace weft {
namespace {

// A node of the second part over the middle of two of the first one: W x is what they come nearer, and the
// product is W^T K W x, worked out by hand.
TEST(SystemCouplings, PullAtTheNodesOfAllParts) {
  NodeArrays<double> first(Grid::with_nodes(2, 2), 6), second(Grid::with_nodes(3, 3), 6);
  const std::array<kernels::Components<double>, 2> x{first.vector(0), second.vector(0)},
      y{first.vector(3), second.vector(3)};
  SystemCouplings<double> couplings;
  EXPECT_TRUE(couplings.empty());
  const Eigen::Matrix3d stiffness = Eigen::Vector3d(0, 100, 7).asDiagonal();
  couplings.add({{{2, 0, 1, 0}, {1, -0.5, -0.5, 0}, stiffness}, {1, 0, 0, 0}});
  weft::set(x[1], 2, Vec3(1, 3, 0));
  weft::set(x[0], 0, Vec3(0, 1, 0));
  weft::set(x[0], 1, Vec3(0, 0, 2));
  // W x = (1, 3, 0) - (0, 1, 0) / 2 - (0, 0, 2) / 2 = (1, 2.5, -1); K W x = (0, 250, -7)
  EXPECT_NEAR(couplings.multiply(x, y), 2.5 * 250 + 7, 1e-12);
  const auto result = [&](std::size_t part, std::size_t node) {
    return weft::at(kernels::Components<const double>(y[part]), node);
  };
  EXPECT_EQ(result(1, 2), Vec3(0, 250, -7));
  EXPECT_EQ(result(0, 0), Vec3(0, -125, 3.5));
  EXPECT_EQ(result(0, 1), Vec3(0, -125, 3.5));
  EXPECT_EQ(result(1, 0), Vec3(0, 0, 0)) << "a node of no weight";
}

}  // namespace
}  // namespace weft
