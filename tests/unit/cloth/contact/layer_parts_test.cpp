// How nodes of cloths that are stepped together are numbered.
#include "cloth/contact/constraints/layer_parts.h"

#include <gtest/gtest.h>

namespace weft {
namespace {

// The second and the fourth of four cloths of different grids.
TEST(LayerParts, NumberTheirNodesOneAfterTheOther) {
  const Grid small = Grid::with_nodes(2, 3), large = Grid::with_nodes(5, 9);
  const auto size = static_cast<std::uint32_t>(small.size());
  const LayerParts parts({{small, 100, 0.004}, {large, 1000, 0.003}});
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts.nodes(), small.size() + large.size());
  EXPECT_EQ(parts[0].offset, 0U);
  EXPECT_EQ(parts[1].offset, size);
  EXPECT_EQ(parts[0].end(), 100 + size);
  EXPECT_EQ(parts.part_of(99), std::nullopt);
  EXPECT_EQ(parts.part_of(100), 0U);
  EXPECT_EQ(parts.part_of(100 + size), std::nullopt);
  EXPECT_EQ(parts.part_of(1000), 1U);
  EXPECT_EQ(parts.part_of_joined(size - 1), 0U);
  EXPECT_EQ(parts.part_of_joined(size), 1U);
  EXPECT_EQ(parts.gap(0, 1), 0.003);
}

}  // namespace
}  // namespace weft
