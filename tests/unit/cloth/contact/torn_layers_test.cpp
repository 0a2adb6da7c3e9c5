// Torn cloth that meets itself: a tear is a border, and its two sides may touch.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "cloth/contact/search/feature_search.h"
#include "folding_scenes.h"
#include "intersections.h"

namespace weft::test {
namespace {

using Kind = FeaturePair::Kind;
using Features = std::set<std::array<std::uint32_t, 4>>;

/// Two layers: a sheet of 8 x 8 cells of 1/8 m of which the right half, from its fifth column of nodes on, is
/// laid 4 mm over the left one and a third of a cell aside, as it only can once the cells between are torn.
LayerNodes laid_over(const Grid& grid) {
  LayerNodes nodes;
  nodes.first = {0, static_cast<std::uint32_t>(grid.size())};
  nodes.start.assign(grid.size(), Vec3(0, 0, 0));
  nodes.inverse_mass.assign(grid.size(), 0.0);
  nodes.tangled.assign(grid.size(), 0);
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      const bool right = c >= 5;
      nodes.start[grid.index(r, c)] = {(right ? c - 4.7 : c) / 8, right ? 0.004 : 0,
                                       (right ? r + 0.4 : r) / 8.0};
      nodes.inverse_mass[grid.index(r, c)] = 1;
    }
  }
  nodes.end = nodes.velocity = nodes.acceleration = nodes.start;
  return nodes;
}

/// Every pair of features of the drawn triangles that share no node and are as near as `margin`, by trying
/// all.
Features near_pairs(Kind kind, const Grid& grid, const TornLinks& torn, const LayerNodes& nodes,
                    double margin) {
  std::set<std::array<std::uint32_t, 3>> triangles;
  std::set<std::array<std::uint32_t, 2>> edges;
  std::set<std::uint32_t> corners;
  for (int r = 0; r + 1 < grid.rows; ++r) {
    for (int c = 0; c + 1 < grid.cols; ++c) {
      if (torn.face_torn(r, c)) continue;
      const auto top = static_cast<std::uint32_t>(grid.index(r, c));
      const auto bottom = static_cast<std::uint32_t>(grid.index(r + 1, c));
      for (const auto& t : {std::array{top, bottom, bottom + 1}, std::array{top, bottom + 1, top + 1}}) {
        triangles.insert(t);
        corners.insert(t.begin(), t.end());
        for (const auto& [i, j] : {std::pair{0U, 1U}, {1U, 2U}, {0U, 2U}}) {
          edges.insert({std::min(t[i], t[j]), std::max(t[i], t[j])});
        }
      }
    }
  }
  Features pairs;
  const auto try_pair = [&](const std::array<std::uint32_t, 4>& node) {
    if (std::set<std::uint32_t>(node.begin(), node.end()).size() < 4) return;
    const FeaturePair pair{kind, node};
    if (nearness(kind, points_of(pair, nodes.start)).apart.norm() <= margin) pairs.insert(node);
  };
  if (kind == Kind::node_triangle) {
    for (const std::uint32_t n : corners) {
      for (const auto& t : triangles) try_pair({n, t[0], t[1], t[2]});
    }
  } else {
    for (const auto& e : edges) {
      for (const auto& f : edges) {
        if (e < f) try_pair({e[0], e[1], f[0], f[1]});
      }
    }
  }
  return pairs;
}

/// What was found and is as near; of two edges the one of the lower nodes first.
Features found_pairs(Kind kind, const std::vector<FeaturePair>& found, double margin) {
  Features pairs;
  for (const FeaturePair& pair : found) {
    if (pair.kind != kind || pair.distance > margin) continue;
    std::array<std::uint32_t, 4> node = pair.node;
    if (kind == Kind::edge_edge) {
      if (node[0] > node[1]) std::swap(node[0], node[1]);
      if (node[2] > node[3]) std::swap(node[2], node[3]);
      if (std::array{node[2], node[3]} < std::array{node[0], node[1]})
        node = {node[2], node[3], node[0], node[1]};
    }
    EXPECT_TRUE(pairs.insert(node).second);  // once
  }
  return pairs;
}

/// All triangles of a cloth that are drawn.
TriangleSoup drawn(const Cloth<float>& cloth) {
  TriangleSoup soup;
  soup.add(cloth.particles());
  if (cloth.walls() == nullptr) return soup;
  const TornLinks torn = cloth.walls()->at(cloth.level());
  std::vector<Triangle> kept;
  for (std::size_t face = 0; face < soup.triangles.size() / 2; ++face) {
    const int cols = torn.grid().cols - 1;
    if (torn.face_torn(static_cast<int>(face) / cols, static_cast<int>(face) % cols)) continue;
    kept.push_back(soup.triangles[2 * face]);
    kept.push_back(soup.triangles[2 * face + 1]);
  }
  soup.triangles = kept;
  return soup;
}

struct Outcome {
  std::size_t torn_faces = 0;
  int intersections = 0;  ///< of all fifth steps
};
Outcome outcome_of(const SimulationDescription& scene, double seconds) {
  Simulation<float> simulation(scene);
  Outcome outcome;
  for (int step = 1; step <= seconds * 60; ++step) {
    simulation.step();
    if (step % 5 == 0) outcome.intersections += count_intersections(drawn(simulation.cloths()[0]));
  }
  const Cloth<float>& cloth = simulation.cloths()[0];
  if (cloth.walls()) outcome.torn_faces = cloth.walls()->at(cloth.level()).torn_faces().size();
  return outcome;
}

/// A sheet held by two halves of its upper edge, which are drawn apart until it is torn in two from top to
/// bottom, and then past each other, one half before the other: what hangs from them is rubbed along each
/// other.
SimulationDescription torn_and_drawn_together(int level, const IntegratorDescription& stepping) {
  SimulationDescription scene = cloth_scene({1, 0.6}, level, stepping);
  scene.effects.push_back(TearingEffect{60, 60});
  PinRegion left{0, 0.45, 0, 0}, right{0.55, 1, 0, 0};
  left.path = {{0, {0, 0, 0}}, {1, {-0.3, 0, 0}}, {1.5, {-0.3, 0, 0.01}}, {3, {0.25, 0, 0.01}}};
  right.path = {{0, {0, 0, 0}}, {1, {0.3, 0, 0}}, {1.5, {0.3, 0, -0.01}}, {3, {-0.25, 0, -0.01}}};
  scene.cloths[0].pins = {left, right};
  return scene;
}

/// The same sheet, torn in two, whose halves are brought together and laid down on the floor, in a heap.
SimulationDescription torn_and_laid_down(int level, const IntegratorDescription& stepping) {
  SimulationDescription scene = torn_and_drawn_together(level, stepping);
  scene.cloths[0].perturbation = 0.002;
  std::vector<PinRegion>& pins = scene.cloths[0].pins;
  pins[0].path = {{0, {0, 0, 0}}, {1, {-0.3, 0, 0}}, {2, {0.2, -0.58, 0.005}}};
  pins[1].path = {{0, {0, 0, 0}}, {1, {0.3, 0, 0}}, {2, {-0.2, -0.55, -0.005}}};
  scene.obstacles = {floor_at(-0.32)};
  return scene;
}

/// What would happen if nothing kept its layers apart.
SimulationDescription without_contact(SimulationDescription scene) {
  std::erase_if(scene.effects,
                [](const EffectDescription& e) { return std::holds_alternative<ClothContactEffect>(e); });
  return scene;
}

}  // namespace

TEST(TornLayers, FeaturesAreThoseOfWhatIsDrawn) {
  const Grid grid = Grid::with_nodes(9, 9);
  TornLinks torn(grid);
  for (int r = 0; r < grid.rows; ++r) torn.cut({r, 4, true});  // the fifth column of cells, top to bottom
  torn.cut({3, 1, true});  // and a cell in the left half that has lost two edges
  torn.cut({4, 1, true});
  ASSERT_EQ(torn.torn_faces().size(), 9u);
  const LayerNodes nodes = laid_over(grid);
  FeatureSearch search;
  search.set_grids({grid});
  search.set_torn(0, torn);
  constexpr double kMargin = 0.01;  // far below a cell: of one layer nothing is so near
  const std::vector<FeaturePair> found = search.find(nodes, kMargin);
  for (const Kind kind : {Kind::node_triangle, Kind::edge_edge}) {
    const Features expected = near_pairs(kind, grid, torn, nodes, kMargin);
    EXPECT_GT(expected.size(), 30u);
    EXPECT_EQ(found_pairs(kind, found, kMargin), expected);
  }
  EXPECT_TRUE(search.find_crossings(nodes).empty());
}

// A node of the upper half put under the lower one, and another one through the cell that is torn in it.
TEST(TornLayers, CrossingsAreThoseOfWhatIsDrawn) {
  const Grid grid = Grid::with_nodes(9, 9);
  TornLinks torn(grid);
  for (int r = 0; r < grid.rows; ++r) torn.cut({r, 4, true});
  LayerNodes nodes = laid_over(grid);
  nodes.start[grid.index(2, 6)].y() = -0.004;  // lies over the cell of row 2, column 1
  FeatureSearch search;
  search.set_grids({grid});
  search.set_torn(0, torn);
  const auto through = search.find_crossings(nodes);
  EXPECT_FALSE(through.empty());
  for (const Crossing& crossing : through) {
    for (const std::uint32_t n : crossing.across) {  // of a triangle that is drawn: of the edge's own half
      EXPECT_EQ(n % static_cast<std::uint32_t>(grid.stride) >= 5,
                crossing.edge[0] % static_cast<std::uint32_t>(grid.stride) >= 5);
    }
  }
  // With all cells torn that the node's edges pass through they pass through nothing.
  for (int r = 1; r <= 4; ++r) {
    for (int c = 0; c < 3; ++c) torn.cut({r, c, true});
  }
  search.set_torn(0, torn);
  EXPECT_TRUE(search.find_crossings(nodes).empty());
}

// Torn through, at least a cell a row, but most of it is whole.
bool torn_in_two(const Outcome& outcome, std::size_t rows) {
  return outcome.torn_faces >= rows && outcome.torn_faces < rows * rows / 2;
}

TEST(TornLayersSlow, HalvesOfATornSheetDoNotPassThroughEachOther) {
  for (const IntegratorDescription& stepping :
       {IntegratorDescription{Bdf2Description{}}, IntegratorDescription{XpbdDescription{}}}) {
    const Outcome outcome = outcome_of(torn_and_drawn_together(4, stepping), 3);
    EXPECT_TRUE(torn_in_two(outcome, 16)) << outcome.torn_faces;
    EXPECT_EQ(outcome.intersections, 0);
  }
  EXPECT_GT(outcome_of(without_contact(torn_and_drawn_together(4, Bdf2Description{})), 3).intersections, 0);
}

TEST(TornLayersSlow, ATornSheetFallsUponItself) {
  for (const int level : {4, 5}) {
    const Outcome outcome = outcome_of(torn_and_laid_down(level, Bdf2Description{}), 3);
    EXPECT_TRUE(torn_in_two(outcome, std::size_t{1} << level)) << outcome.torn_faces;
    EXPECT_EQ(outcome.intersections, 0);
  }
  EXPECT_GT(outcome_of(without_contact(torn_and_laid_down(4, Bdf2Description{})), 3).intersections, 0);
}

}  // namespace weft::test
