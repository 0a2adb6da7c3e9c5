#include "cloth/contact/search/patch_tree.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace weft {
namespace {

/// 16 x 24 cells, so that the tree has levels of 8 x 12, 4 x 6 and 2 x 3 patches above them.
const Grid kPatchGrid = Grid::with_nodes(17, 25);
constexpr double kPatchCell = 0.1;  // m

using CellPairs = std::vector<std::array<Cell, 2>>;
using CellKey = std::array<int, 4>;

CellKey key_of(const Cell& a, const Cell& b) { return {a.row, a.col, b.row, b.col}; }

/// Either cell first; each pair once.
std::set<CellKey> unordered(const CellPairs& pairs) {
  std::set<CellKey> keys;
  for (const auto& [a, b] : pairs) {
    const bool new_one = keys.insert(std::min(key_of(a, b), key_of(b, a))).second;
    EXPECT_TRUE(new_one) << "a pair is there twice";
  }
  return keys;
}

/// Node (r, c) at place(r, c).
template <class Place>
std::vector<Vec3> placed(const Grid& grid, Place place) {
  std::vector<Vec3> nodes(grid.size(), Vec3(0, 0, 0));
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) nodes[grid.index(r, c)] = place(r, c);
  }
  return nodes;
}

/// Around a cell's way.
Bounds box_of(const Grid& grid, const Cell& cell, const std::vector<Vec3>& start,
              const std::vector<Vec3>& end) {
  Bounds box;
  for (const int r : {cell.row, cell.row + 1}) {
    for (const int c : {cell.col, cell.col + 1}) {
      box.extend(start[grid.index(r, c)]);
      box.extend(end[grid.index(r, c)]);
    }
  }
  return box;
}

template <class Visit>
void each_cell(const Grid& grid, Visit visit) {
  for (int r = 0; r + 1 < grid.rows; ++r) {
    for (int c = 0; c + 1 < grid.cols; ++c) visit(Cell{r, c});
  }
}

std::vector<Vec3> scattered(const Grid& grid, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return placed(grid, [&](int r, int c) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return Vec3(kPatchCell * c + 0.15 * x, 0.3 * y, kPatchCell * r + 0.15 * z);
  });
}

std::vector<Vec3> flat_patch(const Grid& grid, double height) {
  return placed(grid, [&](int r, int c) { return Vec3(kPatchCell * c, height, kPatchCell * r); });
}

TEST(PatchBounds, AreNearWithinAMarginAlongEveryAxis) {
  Bounds a, b;
  a.extend(Vec3(0, 0, 0));
  a.extend(Vec3(1, 1, 1));
  b.extend(Vec3(1.25, -3, 0.5));
  EXPECT_FALSE(a.near(b, 1));
  b.extend(Vec3(1.5, 4, 0.5));
  EXPECT_TRUE(a.near(b, 0.25));
  EXPECT_TRUE(b.near(a, 0.25));
  EXPECT_FALSE(a.near(b, 0.24));
  EXPECT_FALSE(b.near(a, 0.24));
}

// Of two sheets of different depth all pairs of cells whose boxes come near, and no others.
TEST(PatchTree, PairsOfTwoSheetsAreThoseWhoseBoxesComeNear) {
  const Grid small = Grid::with_nodes(8, 10);
  const std::vector<Vec3> a_start = scattered(kPatchGrid, 1), a_end = scattered(kPatchGrid, 2),
                          b_start = scattered(small, 3), b_end = scattered(small, 4);
  PatchTree a(kPatchGrid), b(small);
  a.refit(a_start.data(), a_end.data());
  b.refit(b_start.data(), b_end.data());
  std::set<CellKey> expected, found;
  each_cell(kPatchGrid, [&](const Cell& mine) {
    const Bounds box = box_of(kPatchGrid, mine, a_start, a_end);
    each_cell(small, [&](const Cell& other) {
      if (box.near(box_of(small, other, b_start, b_end), 0.02)) expected.insert(key_of(mine, other));
    });
  });
  CellPairs pairs;
  a.find_pairs(b, 0.02, pairs);
  for (const auto& [mine, other] : pairs) found.insert(key_of(mine, other));
  EXPECT_EQ(found.size(), pairs.size());
  EXPECT_GT(found.size(), 100U);
  EXPECT_LT(found.size(), static_cast<std::size_t>(a.cells() * b.cells()) / 2);
  EXPECT_EQ(found, expected);
}

TEST(PatchTree, BoundsAreTheWholeWays) {
  PatchTree tree(kPatchGrid);
  const std::vector<Vec3> start = scattered(kPatchGrid, 1), end = scattered(kPatchGrid, 2);
  tree.refit(start.data(), end.data());
  Bounds expected;
  each_cell(kPatchGrid, [&](const Cell& cell) { expected.extend(box_of(kPatchGrid, cell, start, end)); });
  EXPECT_EQ(tree.bounds().low, expected.low);
  EXPECT_EQ(tree.bounds().high, expected.high);
}

TEST(PatchTree, AFlatSheetMeetsItselfNowhere) {
  PatchTree tree(kPatchGrid);
  const std::vector<Vec3> start = flat_patch(kPatchGrid, 0), end = flat_patch(kPatchGrid, 1);
  tree.refit(start.data(), end.data());
  CellPairs pairs;
  tree.find_own_pairs(kPatchCell / 2, pairs);
  EXPECT_TRUE(pairs.empty());
}

/// Folded over at the middle column, half a cell apart.
std::vector<Vec3> folded_patch() {
  return placed(kPatchGrid, [](int r, int c) {
    return Vec3(kPatchCell * std::abs(c - 12), c > 12 ? 0.05 : 0, kPatchCell * r);
  });
}

// Between two layers edges along u turn round: no patch with both is one-to-one.
TEST(PatchTree, LayersOfAFoldAreFound) {
  PatchTree tree(kPatchGrid);
  const std::vector<Vec3> nodes = folded_patch();
  tree.refit(nodes.data(), nodes.data());
  CellPairs pairs;
  tree.find_own_pairs(0.06, pairs);
  const std::set<CellKey> found = unordered(pairs);
  int across = 0;
  each_cell(kPatchGrid, [&](const Cell& a) {
    each_cell(kPatchGrid, [&](const Cell& b) {
      if (a.col >= 12 || b.col < 12) return;
      const Bounds box = box_of(kPatchGrid, a, nodes, nodes);
      const bool near = box.near(box_of(kPatchGrid, b, nodes, nodes), 0.06);
      EXPECT_EQ(found.contains(std::min(key_of(a, b), key_of(b, a))), near);
      across += near ? 1 : 0;
    });
  });
  EXPECT_GT(across, 16 * 12);
  // Within a layer none.
  for (const CellKey& pair : found) EXPECT_NE(pair[1] < 12, pair[3] < 12);
}

// What is left out is one-to-one: its points more than a cell from each other are half a cell apart at least.
TEST(PatchTree, NodesThatComeTogetherAreFoundInCrumpledSheets) {
  PatchTree tree(kPatchGrid);
  int together = 0;
  for (const int width : {3, 4, 7}) {
    // A zigzag of so many columns a layer, the layers a tenth of a cell apart, its nodes off by as much.
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> off(-0.01, 0.01);
    const std::vector<Vec3> nodes = placed(kPatchGrid, [&](int r, int c) {
      const int layer = c / width, along = layer % 2 == 0 ? c % width : width - c % width;
      const double x = off(random), y = off(random), z = off(random);
      return Vec3(kPatchCell * along + x, 0.01 * layer + y, kPatchCell * r + z);
    });
    tree.refit(nodes.data(), nodes.data());
    CellPairs pairs;
    tree.find_own_pairs(kPatchCell, pairs);
    const std::set<CellKey> found = unordered(pairs);
    double shortest = 1e9;
    const auto node = [&](int r, int c) { return nodes[kPatchGrid.index(r, c)]; };
    for (int r = 0; r + 1 < kPatchGrid.rows; ++r) {
      for (int c = 0; c + 1 < kPatchGrid.cols; ++c) {
        shortest =
            std::min({shortest, (node(r, c) - node(r + 1, c)).norm(), (node(r, c) - node(r, c + 1)).norm()});
      }
    }
    each_cell(kPatchGrid, [&](const Cell& a) {
      each_cell(kPatchGrid, [&](const Cell& b) {
        if (std::abs(a.row - b.row) < 2 && std::abs(a.col - b.col) < 2) return;
        if ((node(a.row, a.col) - node(b.row, b.col)).norm() >= shortest / 2) return;
        ++together;
        EXPECT_TRUE(found.contains(std::min(key_of(a, b), key_of(b, a))));
      });
    });
  }
  EXPECT_GT(together, 1000);
}

// A torn cell may meet itself and its neighbours, be it flat.
TEST(PatchTree, ATornCellIsOneToOneWithNothing) {
  PatchTree tree(kPatchGrid);
  tree.set_torn({5 * 24 + 7});
  const std::vector<Vec3> nodes = flat_patch(kPatchGrid, 0);
  tree.refit(nodes.data(), nodes.data());
  CellPairs pairs;
  tree.find_own_pairs(0.01, pairs);
  const std::set<CellKey> found = unordered(pairs);
  for (int r = 4; r <= 6; ++r) {
    for (int c = 6; c <= 8; ++c) {
      const Cell torn{5, 7}, other{r, c};
      EXPECT_TRUE(found.contains(std::min(key_of(torn, other), key_of(other, torn)))) << r << ", " << c;
    }
  }
}

TEST(PatchTree, MarkedNodesLimitThePairsUntilTheNextRefit) {
  PatchTree tree(kPatchGrid);
  const std::vector<Vec3> nodes = folded_patch();
  tree.refit(nodes.data(), nodes.data());
  CellPairs all, marked, again;
  tree.find_own_pairs(0.06, all);
  std::vector<char> marks(kPatchGrid.size(), 0);
  marks[kPatchGrid.index(3, 4)] = 1;
  tree.mark(marks.data());
  tree.find_own_pairs(0.06, marked);
  const auto has_mark = [](const Cell& cell) {
    return (cell.row == 2 || cell.row == 3) && (cell.col == 3 || cell.col == 4);
  };
  CellPairs expected;
  for (const auto& pair : all) {
    if (has_mark(pair[0]) || has_mark(pair[1])) expected.push_back(pair);
  }
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(unordered(marked), unordered(expected));
  tree.refit(nodes.data(), nodes.data());
  tree.find_own_pairs(0.06, again);
  EXPECT_EQ(unordered(again), unordered(all));
}

}  // namespace
}  // namespace weft
