#include "cloth/kernels/bands.h"

#include <gtest/gtest.h>

#include <mutex>
#include <vector>

namespace weft {
namespace {

TEST(Bands, EveryRowIsInOneBand) {
  for (const int side : {3, 65, 128, 129, 130, 257, 513}) {
    const Grid grid = Grid::with_nodes(side, side);
    const Bands bands(grid);
    std::vector<int> seen(static_cast<std::size_t>(side));
    std::mutex mutex;
    bands.for_each([&](kernels::RowRange rows, int) {
      const std::lock_guard lock(mutex);
      for (int r = rows.begin; r < rows.end; ++r) ++seen[static_cast<std::size_t>(r)];
    });
    EXPECT_EQ(seen, std::vector<int>(static_cast<std::size_t>(side), 1)) << side;
  }
}

// As the header says: one band below 129 x 129 nodes, else one for each 32 rows.
TEST(Bands, SmallGridsAreOne) {
  EXPECT_EQ(Bands(Grid::with_nodes(128, 129)).count(), 1);
  EXPECT_EQ(Bands(Grid::with_nodes(129, 129)).count(), 4);
  EXPECT_EQ(Bands(Grid::with_nodes(257, 257)).count(), 8);
}

// 0 + 1 + ... + 256, and the scalars of all stretches are the grid's.
TEST(Bands, SumsAndStretchesAreWhole) {
  const Grid grid = Grid::with_nodes(257, 257);
  const Bands bands(grid);
  EXPECT_EQ(bands.sum([](kernels::RowRange rows, int) {
    double sum = 0;
    for (int r = rows.begin; r < rows.end; ++r) sum += r;
    return sum;
  }),
            256 * 257 / 2);
  std::vector<char> touched(grid.size());
  bands.for_each_stretch([&](std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) touched[i] = 1;
  });
  EXPECT_EQ(touched, std::vector<char>(grid.size(), 1));
}

}  // namespace
}  // namespace weft
