// Bridson, Fedkiw, Anderson 2002, 7.2 to 7.5: what would meet in a step does not, whoever has to give way.
#include <gtest/gtest.h>

#include <array>

#include "cloth/contact/recovery/collision_net.h"

namespace weft::test {
namespace {

constexpr double kGap = 1e-4;  // m

/// Sheets of one cell: two triangles, 1 m wide, the second one `height` m over the first, at rest; 1 kg a
/// node.
struct TwoCells {
  explicit TwoCells(double height) {
    const auto size = static_cast<std::uint32_t>(grid.size());
    nodes.first = {0, size, 2 * size};
    nodes.start.assign(2 * grid.size(), Vec3(0, 0, 0));
    nodes.inverse_mass.assign(2 * grid.size(), 0.0);
    nodes.lies.assign(2 * grid.size(), 0);
    nodes.tangled.assign(2 * grid.size(), 0);
    for (int sheet = 0; sheet < 2; ++sheet) {
      for (int corner = 0; corner < 4; ++corner) {
        nodes.start[index(sheet, corner)] = Vec3(corner % 2, sheet * height, corner / 2);
        nodes.inverse_mass[index(sheet, corner)] = 1;
      }
    }
    nodes.end = nodes.start;
    nodes.velocity = nodes.acceleration = nodes.support = std::vector<Vec3>(2 * grid.size(), Vec3(0, 0, 0));
    search.set_grids({grid, grid});
  }

  std::size_t index(int sheet, int corner) const {
    return nodes.first[std::size_t(sheet)] + grid.index(corner / 2, corner % 2);
  }
  /// Moves a sheet, as it is placed and as it goes on.
  void place(int sheet, const Vec3& by, const Vec3& way) {
    for (int corner = 0; corner < 4; ++corner) {
      nodes.start[index(sheet, corner)] += by;
      nodes.end[index(sheet, corner)] = nodes.start[index(sheet, corner)] + way;
    }
  }
  bool apply() {
    search.find(nodes, 8 * kGap);
    return net.apply(search, nodes);
  }
  /// Sums over all nodes of mass times way, kg m; and of mass times its square, kg m2.
  Vec3 momentum() const {
    Vec3 sum(0, 0, 0);
    each([&](std::size_t n) { sum += (nodes.end[n] - nodes.start[n]) / nodes.inverse_mass[n]; });
    return sum;
  }
  double energy() const {
    double sum = 0;
    each(
        [&](std::size_t n) { sum += (nodes.end[n] - nodes.start[n]).squaredNorm() / nodes.inverse_mass[n]; });
    return sum;
  }
  /// Where the step ends.
  std::size_t crossings() {
    LayerNodes ended = nodes;
    ended.start = nodes.end;
    return search.find_crossings(ended).size();
  }
  /// Of a corner over the plane of the other sheet's corner 0 and those two, counterclockwise from above, m.
  double height(int sheet, int corner, int other, const std::array<int, 2>& corners) const {
    const Vec3& origin = nodes.end[index(other, 0)];
    const Vec3 first = nodes.end[index(other, corners[0])] - origin,
               second = nodes.end[index(other, corners[1])] - origin;
    return first.cross(second).normalized().dot(nodes.end[index(sheet, corner)] - origin);
  }
  template <class Visit>
  void each(Visit visit) const {
    for (int sheet = 0; sheet < 2; ++sheet) {
      for (int corner = 0; corner < 4; ++corner) visit(index(sheet, corner));
    }
  }

  const Grid grid = Grid::with_nodes(2, 2);
  LayerNodes nodes;
  FeatureSearch search;
  CollisionNet net{kGap};
};

}  // namespace

TEST(CollisionNet, LeavesAloneWhatDoesNotMeet) {
  TwoCells cells(0.1);
  cells.place(1, {0.3, 0, 0.2}, {0, -0.09, 0});
  const std::vector<Vec3> ends = cells.nodes.end;
  EXPECT_FALSE(cells.apply());
  EXPECT_EQ(cells.nodes.end, ends);
}

TEST(CollisionNet, KeepsApartWithTheMomentumAndNoMoreEnergy) {
  // A corner of the one passes through the middle of the other and beyond, turned so that edges meet too.
  TwoCells cells(0.1);
  cells.place(1, {0.3, 0, 0.2}, {0.05, -0.5, 0.02});
  const Vec3 momentum = cells.momentum();
  const double energy = cells.energy();
  EXPECT_TRUE(cells.apply());
  EXPECT_EQ(cells.crossings(), 0U);
  EXPECT_GT(cells.height(1, 0, 0, {3, 1}), 0) << "its corner, over the first sheet's triangle 0, 3, 1";
  EXPECT_LT(cells.height(0, 3, 1, {2, 3}), 0) << "the other's, under the second sheet's triangle 0, 2, 3";
  EXPECT_LT((cells.momentum() - momentum).norm(), 1e-9);
  EXPECT_LT(cells.energy(), energy);
}

// Of a sheet whose other corners are pinned the free one, at (1, 1), is to give way to a pinned node that
// comes down near its far corner. To hold that up by itself it would go the way that is lacking, 40 mm, over
// its share in where they meet: 40 m, and 0.33 m.
TEST(CollisionNet, ThrowsNoNodeOfASmallShareBesidePinnedOnes) {
  for (const double share : {1e-3, 0.12}) {
    TwoCells cells(0.1);
    cells.place(1, {share, 0, share}, {0, -0.14, 0});
    cells.each([&](std::size_t n) { cells.nodes.inverse_mass[n] = 0; });
    cells.nodes.inverse_mass[cells.index(0, 3)] = 1;
    EXPECT_TRUE(cells.apply());
    EXPECT_EQ(cells.crossings(), 0U);
    cells.each([&](std::size_t n) {
      EXPECT_LT((cells.nodes.end[n] - cells.nodes.start[n]).norm(), 0.15) << share;  // the way to be gone
    });
  }
}

}  // namespace weft::test
