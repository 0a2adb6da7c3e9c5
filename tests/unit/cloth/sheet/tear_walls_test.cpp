// Walls, what they cut at each level, and how nodes go on from level to level beside them.
#include <gtest/gtest.h>

#include "cloth/core/disjoint_sets.h"
#include "cloth/sheet/tear/mend.h"
#include "cloth/sheet/tear/pieces.h"
#include "cloth/sheet/tear/walls.h"
#include "fixtures.h"
#include "tears.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::set;
using test::some_links;

constexpr BaseCells kBase = test::kTornBase;

int count_cut(const TornLinks& links) {
  int count = 0;
  each_node(links.grid(), [&](int r, int c) {
    for (const bool along_u : {true, false}) count += links.torn(Link{r, c, along_u}) ? 1 : 0;
  });
  return count;
}

TEST(Walls, CutThatOneLinkOfTheirOwnLevel) {
  for (const int level : {3, 4, 5}) {
    for (const Link& link : some_links(level, 50, 1)) {
      Walls walls(kBase, 5);
      walls.add(level, link);
      const TornLinks at_level = walls.at(level);
      EXPECT_EQ(count_cut(at_level), 1) << level;
      EXPECT_TRUE(at_level.torn(link)) << level << ' ' << link.row << ' ' << link.col;
    }
  }
}

TEST(Walls, ALinkIsCutWhereEitherOfItsHalvesIs) {
  Walls walls(kBase, 6);
  for (const int level : {4, 5, 6}) {
    for (const Link& link : some_links(level, 20, static_cast<std::uint64_t>(level))) walls.add(level, link);
  }
  for (const int level : {3, 4, 5}) {
    const TornLinks coarse = walls.at(level), fine = walls.at(level + 1);
    each_node(coarse.grid(), [&](int r, int c) {
      const bool u = c + 1 < coarse.grid().cols &&
                     (fine.torn(Link{2 * r, 2 * c, true}) || fine.torn(Link{2 * r, 2 * c + 1, true}));
      const bool v = r + 1 < coarse.grid().rows &&
                     (fine.torn(Link{2 * r, 2 * c, false}) || fine.torn(Link{2 * r + 1, 2 * c, false}));
      EXPECT_EQ(coarse.torn(Link{r, c, true}), u) << level << ' ' << r << ' ' << c;
      EXPECT_EQ(coarse.torn(Link{r, c, false}), v) << level << ' ' << r << ' ' << c;
    });
  }
}

/// Whether the last row hangs together with the first one by structural links.
bool hangs_together(const TornLinks& links) {
  const Grid& grid = links.grid();
  std::vector<char> reached(static_cast<std::size_t>(grid.nodes()));
  std::vector<std::pair<int, int>> left;
  const auto reach = [&](int r, int c) {
    char& here = reached[static_cast<std::size_t>(r * grid.cols + c)];
    if (here == 0) left.emplace_back(r, c);
    here = 1;
  };
  for (int c = 0; c < grid.cols; ++c) reach(0, c);
  while (!left.empty()) {
    const auto [r, c] = left.back();
    left.pop_back();
    if (r + 1 == grid.rows) return true;
    if (c + 1 < grid.cols && !links.torn(Link{r, c, true})) reach(r, c + 1);
    if (c > 0 && !links.torn(Link{r, c - 1, true})) reach(r, c - 1);
    if (!links.torn(Link{r, c, false})) reach(r + 1, c);
    if (r > 0 && !links.torn(Link{r - 1, c, false})) reach(r - 1, c);
  }
  return false;
}

TEST(Walls, OfALineAcrossTheSheetPartItAtEveryLevel) {
  for (const int level : {3, 4, 6}) {
    Walls walls(kBase, 6);
    const Grid grid = kBase.at(level);
    // A step in the middle: the line turns along u-links' walls for two columns.
    for (int c = 0; c < grid.cols; ++c) walls.add(level, {c < grid.cols / 2 ? 4 : 6, c, false});
    for (const int r : {5, 6}) walls.add(level, {r, grid.cols / 2 - 1, true});
    for (int at = 3; at <= 6; ++at) EXPECT_FALSE(hangs_together(walls.at(at))) << level << " at " << at;
  }
}

TEST(TornLinks, FacesAndSlantingLinksFollowTheirEdges) {
  // One cell, all 16 ways to lose edges: falling joins (0, 0) and (1, 1), rising (0, 1) and (1, 0).
  for (int lost = 0; lost < 16; ++lost) {
    TornLinks links(Grid::with_nodes(2, 2));
    const bool top = (lost & 1) != 0, left = (lost & 2) != 0, right = (lost & 4) != 0,
               bottom = (lost & 8) != 0;
    if (top) links.cut({0, 0, true});
    if (left) links.cut({0, 0, false});
    if (right) links.cut({0, 1, false});
    if (bottom) links.cut({1, 0, true});
    EXPECT_EQ(links.torn(0, 0, 1, 1), (top || right) && (left || bottom)) << lost;
    EXPECT_EQ(links.torn(0, 1, 1, -1), (top || left) && (right || bottom)) << lost;
    EXPECT_EQ(links.face_torn(0, 0), top + left + right + bottom >= 2) << lost;
    EXPECT_EQ(links.torn_faces().size() + links.whole_faces().size(), 1U);
  }
}

TEST(TornLinks, WholeFacesAreAllThatAreNotTorn) {
  Walls walls(kBase, 4);
  for (const Link& link : some_links(4, 150, 7)) walls.add(4, link);
  const TornLinks links = walls.at(4);
  const int cols = links.grid().cols - 1;
  std::vector<int> seen(static_cast<std::size_t>(links.grid().cells()));
  for (const FaceRun& run : links.whole_faces()) {
    EXPECT_LT(run.begin, run.end);
    for (int c = run.begin; c < run.end; ++c) ++seen[static_cast<std::size_t>(run.row * cols + c)];
  }
  for (const std::uint32_t face : links.torn_faces()) ++seen[face];
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), links.grid().cells());
  EXPECT_GT(links.torn_faces().size(), 20U);
}

/// What hangs together.
DisjointSets pieces_of(const TornLinks& links) {
  const Grid& grid = links.grid();
  DisjointSets pieces(grid.size());
  each_node(grid, [&](int r, int c) {
    if (c + 1 < grid.cols && !links.torn(Link{r, c, true}))
      pieces.join(grid.index(r, c), grid.index(r, c + 1));
    if (r + 1 < grid.rows && !links.torn(Link{r, c, false}))
      pieces.join(grid.index(r, c), grid.index(r + 1, c));
  });
  return pieces;
}

/// Pairs of coarse nodes next to each other that hang together on one of the grids alone.
int differing_pairs(const TornLinks& coarse, const TornLinks& fine) {
  const Grid &few = coarse.grid(), &many = fine.grid();
  DisjointSets before = pieces_of(coarse), after = pieces_of(fine);
  int differing = 0;
  const auto compare = [&](int r, int c, int rows, int cols) {
    if (r + rows >= few.rows || c + cols >= few.cols) return;
    const bool together = before.of(few.index(r, c)) == before.of(few.index(r + rows, c + cols));
    const bool still =
        after.of(many.index(2 * r, 2 * c)) == after.of(many.index(2 * (r + rows), 2 * (c + cols)));
    differing += together != still ? 1 : 0;
  };
  each_node(few, [&](int r, int c) {
    compare(r, c, 0, 1);
    compare(r, c, 1, 0);
  });
  return differing;
}

// Of walls that levels 3 and 4 have made, some part what level 5 would join: pieces that had flown 100 m from
// each other were pulled at by springs between them, with 1.5e10 J (random scene 1276).
TEST(PartPieces, WhatHasComeApartStaysApart) {
  int joined = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Walls walls(kBase, 6);
    for (const int level : {3, 4}) {
      for (const Link& link : some_links(level, level == 3 ? 80 : 400, seed)) walls.add(level, link);
    }
    const TornLinks coarse = walls.at(4);
    joined += differing_pairs(coarse, walls.at(5));
    part_pieces(coarse, 5, walls);
    EXPECT_EQ(differing_pairs(coarse, walls.at(5)), 0) << "seed " << seed;
    EXPECT_EQ(count_cut(walls.at(4)), count_cut(coarse)) << "links of the coarse grid are left alone";
  }
  EXPECT_GT(joined, 0) << "nothing to part";
}

// Row 7 of 17 parted from row 8, and of the upper half the last of 9 columns from the rest: 8 x 8 nodes, 8 x
// 1 and the lower half, which is held.
TEST(PieceMasses, AreOfWhatHangsTogether) {
  const Grid grid = kBase.at(3);
  Walls walls(kBase, 5);
  for (int c = 0; c < grid.cols; ++c) walls.add(3, {7, c, false});
  for (int r = 0; r < 8; ++r) walls.add(3, {r, 7, true});
  Particles<float> particles(grid);
  particles.mass.fill(0.5F);
  particles.inverse_mass.fill(2);
  particles.inverse_mass.at(16, 3) = 0;
  const std::vector<double> masses = piece_masses(walls.at(3), particles);
  each_node(grid, [&](int r, int c) {
    const double lower = std::numeric_limits<double>::infinity();
    EXPECT_EQ(masses[grid.index(r, c)], r > 7 ? lower : c == 8 ? 4 : 32) << r << ' ' << c;
  });
}

TEST(MendSplit, PutsNewNodesWhereTheirOwnSideGoesOn) {
  // A flat sheet in two halves, the lower one 3 m further down and moving: on both sides of the tear the new
  // nodes must lie on their own half's lattice, bit for bit but for rounding, and move as it does.
  const Grid coarse_grid = kBase.at(3), fine_grid = kBase.at(4);
  Walls walls(kBase, 5);
  for (int c = 0; c < coarse_grid.cols; ++c) walls.add(3, {7, c, false});
  Particles<double> coarse(coarse_grid), fine(fine_grid);
  const Vec3 moving(1, -2, 3);
  each_node(coarse_grid, [&](int r, int c) {
    set(coarse.position, r, c, {c / 8.0, -r / 8.0 - (r > 7 ? 3 : 0), 0});
    set(coarse.velocity, r, c, r > 7 ? moving : Vec3(0, 0, 0));
  });
  split(coarse, fine);
  const TornLinks torn = walls.at(4);
  ASSERT_GT(std::abs(get(fine.position, 15, 3).y() + 15 / 16.0), 1.0);  // else there is nothing to mend
  mend_split(torn, {1 / 16.0, 1 / 16.0}, fine);
  const int last_above = torn.torn(Link{14, 0, false}) ? 14 : 15;
  each_node(fine_grid, [&](int r, int c) {
    const bool below = r > last_above;
    EXPECT_NEAR((get(fine.position, r, c) - Vec3(c / 16.0, -r / 16.0 - (below ? 3 : 0), 0)).norm(), 0, 1e-12)
        << r << ' ' << c;
    EXPECT_EQ(get(fine.velocity, r, c), below ? moving : Vec3(0, 0, 0)) << r << ' ' << c;
  });
}

// Pieces of a flat sheet that lie a kilometre from each other: no link leads from one to another, and none
// within one is longer than a few cells, as nodes next to each other may each hang, by a cell at most, on
// nodes some cells apart. Flakes of new nodes alone, each node where its own mean was taken across walls, had
// links of 12 km (random scene 1276).
TEST(MendSplit, KeepsPiecesAndFlakesTogether) {
  const Grid coarse_grid = kBase.at(4), fine_grid = kBase.at(5);
  constexpr double kCell = 1 / 32.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Walls walls(kBase, 5);
    for (const int level : {3, 4, 5}) {
      for (const Link& link : some_links(level, 100 << (2 * (level - 3)), seed)) walls.add(level, link);
    }
    const TornLinks torn = walls.at(4);
    DisjointSets pieces = pieces_of(torn);
    Particles<double> coarse(coarse_grid), fine(fine_grid);
    each_node(coarse_grid, [&](int r, int c) {
      const double piece = 1e3 * static_cast<double>(pieces.of(coarse_grid.index(r, c)));
      set(coarse.position, r, c, {2 * kCell * c + piece, -2 * kCell * r, 0});
    });
    split(coarse, fine);
    part_pieces(torn, 5, walls);
    const TornLinks cut = walls.at(5);
    mend_split(cut, {kCell, kCell}, fine);
    double longest = 0;
    each_node(fine_grid, [&](int r, int c) {
      const auto measure = [&](int rows, int cols) {
        if (r + rows >= fine_grid.rows || c + cols >= fine_grid.cols || cut.torn(Link{r, c, rows == 0}))
          return;
        longest =
            std::max(longest, (get(fine.position, r, c) - get(fine.position, r + rows, c + cols)).norm());
      };
      measure(0, 1);
      measure(1, 0);
    });
    EXPECT_LT(longest, 5 * kCell) << "seed " << seed;
  }
}

TEST(MergeTornMomentum, KeepsTheSidesApartAndIsTheOrdinaryOneOfAWholeSheet) {
  const Grid coarse_grid = kBase.at(3), fine_grid = kBase.at(4);
  Particles<double> fine(fine_grid), coarse(coarse_grid), whole(coarse_grid);
  mass_distribution(1.0, Discretization::continuum, fine.mass);
  test::randomise(fine.velocity, -1, 1, 2);
  merge_torn_momentum(fine, TornLinks(fine_grid), coarse);
  merge_momentum(fine, whole);
  EXPECT_LT(test::largest_difference(coarse.velocity, whole.velocity), 1e-14);

  Walls walls(kBase, 5);
  for (int c = 0; c < coarse_grid.cols; ++c) walls.add(3, {7, c, false});
  const TornLinks torn = walls.at(4);
  const int last_above = torn.torn(Link{14, 0, false}) ? 14 : 15;
  const Vec3 moving(1, -2, 3);
  each_node(fine_grid,
            [&](int r, int c) { set(fine.velocity, r, c, r > last_above ? moving : Vec3(0, 0, 0)); });
  merge_torn_momentum(fine, torn, coarse);
  each_node(coarse_grid, [&](int r, int c) {
    EXPECT_NEAR((get(coarse.velocity, r, c) - (r > 7 ? moving : Vec3(0, 0, 0))).norm(), 0, 1e-14)
        << r << ' ' << c;
  });
}

}  // namespace
}  // namespace weft
