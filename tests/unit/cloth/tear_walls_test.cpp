// Walls, what they cut at each level, and how nodes go on from level to level beside them.
#include <gtest/gtest.h>

#include "cloth/tear/mend.h"
#include "cloth/tear/walls.h"
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
