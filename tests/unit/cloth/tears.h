#pragma once
// A sheet that tears at random places, for the tests of what is cut.
#include <cstdint>
#include <random>
#include <vector>

#include "cloth/sheet/tear/torn_links.h"

namespace weft::test {

constexpr BaseCells kTornBase{1, 2};  // so that rows and columns differ

/// Random links of `level`, by seed.
inline std::vector<Link> some_links(int level, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Grid grid = kTornBase.at(level);
  std::vector<Link> links;
  while (static_cast<int>(links.size()) < count) {
    const bool along_u = random() % 2 == 0;
    const int r =
        static_cast<int>(random() % static_cast<std::uint64_t>(along_u ? grid.rows : grid.rows - 1));
    const int c =
        static_cast<int>(random() % static_cast<std::uint64_t>(along_u ? grid.cols - 1 : grid.cols));
    links.push_back({r, c, along_u});
  }
  return links;
}

}  // namespace weft::test
