#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "cloth/contact/search/feature_search.h"

namespace weft::test {
namespace {

using Kind = FeaturePair::Kind;

FourPoints random_points(std::mt19937_64& random) {
  std::uniform_real_distribution<double> value(-1, 1);
  FourPoints points;
  for (Vec3& p : points) p = {value(random), value(random), value(random)};
  return points;
}

/// By looking at many points of both features.
double sampled_distance(Kind kind, const FourPoints& p) {
  constexpr int kParts = 60;
  double least = 1e9;
  for (int i = 0; i <= kParts; ++i) {
    for (int j = 0; j <= kParts; ++j) {
      const double s = double(i) / kParts, t = double(j) / kParts;
      if (kind == Kind::edge_edge) {
        least = std::min(least, (p[0] + s * (p[1] - p[0]) - p[2] - t * (p[3] - p[2])).norm());
      } else if (s + t <= 1) {
        least = std::min(least, (p[0] - p[1] - s * (p[2] - p[1]) - t * (p[3] - p[1])).norm());
      }
    }
  }
  return least;
}

/// A folded strip as the nodes of a scene: two layers 4 mm apart, joined by a half circle.
LayerNodes folded(const Grid& grid) {
  LayerNodes nodes;
  nodes.first = {0, static_cast<std::uint32_t>(grid.size())};
  nodes.start.assign(grid.size(), Vec3(0, 0, 0));
  nodes.inverse_mass.assign(grid.size(), 0.0);
  nodes.tangled.assign(grid.size(), 0);
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      const double s = double(c) / (grid.cols - 1) - 0.5, z = double(r) / (grid.rows - 1);
      nodes.start[grid.index(r, c)] = {std::abs(s), s > 0 ? 0.004 : 0, z};
      nodes.inverse_mass[grid.index(r, c)] = 1;
    }
  }
  nodes.end = nodes.velocity = nodes.acceleration = nodes.start;
  return nodes;
}

/// Every `each`th node ends up to 50 mm off its start.
void stray(LayerNodes& nodes, const Grid& grid, int each) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> value(-0.05, 0.05);
  for (int i = 0; i < grid.nodes(); i += each) {
    const std::size_t node = grid.index(i / grid.cols, i % grid.cols);
    nodes.end[node] = nodes.start[node] + Vec3(value(random), value(random), value(random));
  }
}

/// Those of `expected` that are not among `found`.
std::size_t missing(const std::vector<FeaturePair>& expected, const std::vector<FeaturePair>& found) {
  const auto key = [](const FeaturePair& pair) { return std::pair(pair.kind, pair.node); };
  std::set<std::pair<Kind, std::array<std::uint32_t, 4>>> known;
  for (const FeaturePair& pair : found) known.insert(key(pair));
  EXPECT_EQ(known.size(), found.size()) << "a pair is there twice";
  return static_cast<std::size_t>(std::count_if(
      expected.begin(), expected.end(), [&](const auto& pair) { return !known.contains(key(pair)); }));
}

}  // namespace

TEST(Nearness, IsNoFartherThanAnyPointsSampled) {
  std::mt19937_64 random(1);
  for (const Kind kind : {Kind::node_triangle, Kind::edge_edge}) {
    for (int i = 0; i < 300; ++i) {
      const FourPoints points = random_points(random);
      const double distance = nearness(kind, points).apart.norm(), sampled = sampled_distance(kind, points);
      EXPECT_LE(distance, sampled + 1e-12);
      EXPECT_NEAR(distance, sampled, 0.08);  // samples lie at most 2 sqrt(3) sqrt(2) / 60 apart
    }
  }
}

TEST(FirstContact, MissesNoneAndComesNoNearerThanTheGap) {
  std::mt19937_64 random(2);
  int met = 0;
  for (const Kind kind : {Kind::node_triangle, Kind::edge_edge}) {
    for (int i = 0; i < 300; ++i) {
      const FourPoints start = random_points(random), move = random_points(random);
      const double distance = nearness(kind, start).apart.norm(), gap = 0.02;
      const auto time = first_contact(kind, distance, start, move, gap);
      met += time ? 1 : 0;
      const double least = std::min(gap, 0.9 * distance);
      for (int k = 0; k <= 400; ++k) {
        const double t = time.value_or(1) * k / 400;
        FourPoints points = start;
        for (std::size_t n = 0; n < 4; ++n) points[n] += t * move[n];
        ASSERT_GE(nearness(kind, points).apart.norm(), least * (1 - 1e-9));
      }
    }
  }
  EXPECT_GT(met, 50);
}

// A node over a large triangle and an edge over another, 0.05 m apart all the way, and then coming down from
// there to 0.01 m, so that they are 1.5 to 1 gaps apart from 50 to 75 % of the way on.
TEST(FirstContact, TellsWhatSlidesPastFromWhatComesNearer) {
  const FourPoints over_triangle{Vec3(1, 0.05, 1), Vec3(0, 0, 0), Vec3(40, 0, 0), Vec3(0, 0, 40)};
  const FourPoints crossing{Vec3(1, 0.05, -1), Vec3(1, 0.05, 1), Vec3(0, 0, 0), Vec3(40, 0, 0)};
  for (const auto& [kind, start] :
       {std::pair{Kind::node_triangle, over_triangle}, {Kind::edge_edge, crossing}}) {
    const std::size_t movers = kind == Kind::node_triangle ? 1 : 2;
    FourPoints along{Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)}, down = along;
    for (std::size_t i = 0; i < movers; ++i) {
      along[i] = {20, 0, 0};
      down[i] = {20, -0.04, 0};
    }
    EXPECT_EQ(first_contact(kind, 0.05, start, along, 0.02), std::nullopt);
    const auto time = first_contact(kind, 0.05, start, down, 0.02);
    ASSERT_TRUE(time);
    EXPECT_GE(*time, 0.5);
    EXPECT_LE(*time, 0.75);
  }
}

TEST(FeatureSearch, FindsAllThatIsNearInAFoldAndNothingInAFlatSheet) {
  const Grid grid = Grid::with_nodes(17, 33);
  LayerNodes nodes = folded(grid);
  FeatureSearch search;
  search.set_grids({grid});
  const double margin = 0.01;
  const auto& found = search.find(nodes, margin);
  // Every node that lies over a triangle of the other layer within the margin, by looking at all of them.
  std::size_t expected = 0;
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      const auto node = static_cast<std::uint32_t>(grid.index(r, c));
      for (int tr = 0; tr + 1 < grid.rows; ++tr) {
        for (int tc = 0; tc + 1 < grid.cols; ++tc) {
          if ((c < 14 && tc < 18) || (c > 18 && tc > 13) || (c >= 14 && c <= 18))
            continue;  // not at the fold
          const auto top = static_cast<std::uint32_t>(grid.index(tr, tc));
          const auto bottom = static_cast<std::uint32_t>(grid.index(tr + 1, tc));
          for (const std::array<std::uint32_t, 3>& t :
               {std::array{top, bottom, bottom + 1}, std::array{top, bottom + 1, top + 1}}) {
            const FeaturePair pair{Kind::node_triangle, {node, t[0], t[1], t[2]}};
            if (nearness(pair.kind, points_of(pair, nodes.start)).apart.norm() > margin) continue;
            ++expected;
            EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](const FeaturePair& f) {
              return f.kind == pair.kind && f.node == pair.node;
            }));
          }
        }
      }
    }
  }
  EXPECT_GT(expected, 300u);
  // Unfolded, and whichever way it moves as a whole.
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      Vec3& x = nodes.start[grid.index(r, c)];
      x = {double(c) / (grid.cols - 1), 0, x.z()};
      nodes.end[grid.index(r, c)] = x + Vec3(0.1, 3, 0);
    }
  }
  EXPECT_TRUE(search.find(nodes, margin).empty());
  EXPECT_EQ(search.cell_pairs(), 0u);
}

// Against a search of all: what the few that strayed come near is found, in less than a fifth of the pairs of
// cells.
TEST(FeatureSearchSlow, LooksAgainAtWhatHasStrayed) {
  const Grid grid = Grid::with_nodes(65, 65);
  LayerNodes nodes = folded(grid);
  FeatureSearch search, anew;
  for (FeatureSearch* each : {&search, &anew}) each->set_grids({grid});
  search.find(nodes, 0.005);
  const std::size_t of_all = search.cell_pairs(), before = search.searches();
  for (Vec3& x : nodes.end) x += Vec3(1, 2, 3);  // all the same way: nothing comes nearer
  search.found(nodes, 0.001, 0.005);
  EXPECT_EQ(search.searches(), before);
  nodes.end = nodes.start;
  stray(nodes, grid, 397);
  const std::vector<FeaturePair> expected = anew.find(nodes, 0.001);
  EXPECT_GT(missing(expected, search.pairs()), 20u);
  EXPECT_EQ(missing(expected, search.found(nodes, 0.001, 0.005)), 0u);
  EXPECT_EQ(search.searches(), before + 1);
  EXPECT_LT(search.cell_pairs(), of_all / 5);
  EXPECT_EQ(search.margin(), 0.005);
  stray(nodes, grid, 2);  // many: all are looked at
  EXPECT_EQ(missing(anew.find(nodes, 0.001), search.found(nodes, 0.001, 0.002)), 0u);
  EXPECT_EQ(search.margin(), 0.002);
}

// The second of two folded sheets 1 m apart: what the scene's search has found of it, with its nodes'
// numbers.
TEST(FeatureSearch, GoesOnFromTheScenesSearch) {
  const Grid grid = Grid::with_nodes(17, 33);
  const auto size = static_cast<std::uint32_t>(grid.size());
  LayerNodes own = folded(grid), all = own;
  stray(own, grid, 50);
  for (auto member : {&LayerNodes::start, &LayerNodes::end}) {
    for (const Vec3& x : own.*member) (all.*member).push_back(x + Vec3(0, 1, 0));
    for (Vec3& x : own.*member) x += Vec3(0, 1, 0);
  }
  all.first = {0, size, 2 * size};
  all.inverse_mass.insert(all.inverse_mass.end(), own.inverse_mass.begin(), own.inverse_mass.end());
  all.tangled.assign(2 * grid.size(), 0);
  FeatureSearch scene, search, anew;
  scene.set_grids({grid, grid});
  for (FeatureSearch* each : {&search, &anew}) each->set_grids({grid});
  scene.find(all, 0.008);
  search.take_over(scene, {size}, own);
  EXPECT_EQ(missing(anew.find(own, 0.004), search.found(own, 0.004, 0.008)), 0u);
  EXPECT_EQ(search.searches(), 0u);
  for (Vec3& x : own.start) x.x() += 1e-6;  // it begins elsewhere: all is found anew
  search.take_over(scene, {size}, own);
  EXPECT_EQ(missing(anew.find(own, 0.004), search.found(own, 0.004, 0.008)), 0u);
  EXPECT_EQ(search.searches(), 1u);
}

// Where all is near all, 4,096 cells are 8.4 million pairs of cells with 13 pairs of features
// each: a node of either with two triangles of the other, and three edges with three. In a fold of two layers
// cells find 23 each (measured), far below their bound.
TEST(FeatureSearchSlow, FindsNoMoreThanItsBounds) {
  const Grid grid = Grid::with_nodes(65, 65);
  LayerNodes heap = folded(grid);
  FeatureSearch search;
  search.set_grids({grid});
  const std::size_t ordinary = search.find(heap, 0.005).size();
  EXPECT_LT(ordinary, FeatureSearch::kMostOfCell / 10 * 64 * 64);
  EXPECT_FALSE(search.crowded(0));
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> value(-1e-3, 1e-3);
  for (Vec3& x : heap.start) x = {value(random), value(random), value(random)};
  heap.end = heap.start;
  const auto& pairs = search.find(heap, 0.005);
  EXPECT_EQ(search.cell_pairs(), PatchTree::kMostPairs);
  EXPECT_GT(pairs.size(), ordinary);
  EXPECT_TRUE(search.crowded(0));
  EXPECT_LE(pairs.size(), std::min(FeatureSearch::kMost, FeatureSearch::kMostOfCell * 64 * 64));
  EXPECT_EQ(search.find(folded(grid), 0.005).size(), ordinary);  // it goes on as before
  EXPECT_FALSE(search.crowded(0));
}

}  // namespace weft::test
