// One node's vector in a field of three arrays.
#include "cloth/kernels/node_vector.h"

#include <gtest/gtest.h>

#include "cloth/core/grid.h"

namespace weft::test {
namespace {

TEST(NodeVector, IsReadSetAndAddedTo) {
  VectorField<float> field(Grid::with_nodes(2, 3));
  const auto all = kernels::components(field);
  const std::size_t node = field.grid().index(1, 2);
  set(all, node, Vec3(1, 2, 3));
  add(all, node, Vec3(0.5, 0, -1));
  const kernels::Components<const float> read = all;
  EXPECT_EQ(at(read, node), Vec3(1.5, 2, 2));
  EXPECT_EQ(field.y.at(1, 2), 2.0F);
  EXPECT_EQ(at(read, field.grid().index(1, 1)), Vec3(0, 0, 0));
}

TEST(NodeVector, SoManyNodesAreCopiedAndCleared) {
  const Grid grid = Grid::with_nodes(2, 3);
  VectorField<double> from(grid), to(grid);
  for (std::size_t i = 0; i < grid.size(); ++i) set(kernels::components(from), i, Vec3(1, 2, 3));
  copy<double>(kernels::components(from), kernels::components(to), 2);
  const kernels::Components<const double> copied = kernels::components(to);
  EXPECT_EQ(at(copied, 1), Vec3(1, 2, 3));
  EXPECT_EQ(at(copied, 2), Vec3(0, 0, 0));
  clear(kernels::components(to), 1);
  EXPECT_EQ(at(copied, 0), Vec3(0, 0, 0));
  EXPECT_EQ(at(copied, 1), Vec3(1, 2, 3));
}

}  // namespace
}  // namespace weft::test
