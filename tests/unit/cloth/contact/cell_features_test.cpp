#include "cloth/contact/search/cell_features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

namespace weft {
namespace {

const Grid kFeatureGrid = Grid::with_nodes(5, 6);

template <class Visit>
void each_feature_cell(Visit visit) {
  for (int r = 0; r + 1 < kFeatureGrid.rows; ++r) {
    for (int c = 0; c + 1 < kFeatureGrid.cols; ++c) visit(Cell{r, c});
  }
}

using Edge = std::array<std::uint32_t, 2>;

/// How many cells have each node and each edge of their own.
struct Owned {
  std::map<std::uint32_t, int> nodes;
  std::map<Edge, int> edges;
  int triangles = 0;

  template <class Bits>
  explicit Owned(Bits bits) {
    const std::vector<Vec3> places(kFeatureGrid.size(), Vec3(0, 0, 0));
    each_feature_cell([&](const Cell& cell) {
      const CellFeatures features = cell_features(kFeatureGrid, 0, cell, bits(cell), places, places);
      for (std::size_t i = 0; i < 4; ++i) nodes[features.node[i]] += features.owns_node(i) ? 1 : 0;
      for (std::size_t i = 0; i < 5; ++i) {
        const Edge edge{features.node[kCellEdges[i][0]], features.node[kCellEdges[i][1]]};
        edges[edge] += features.owns_edge(i) ? 1 : 0;
      }
      if (features.has_triangles()) ++triangles;
    });
  }
};

TEST(CellFeatures, EachNodeAndEdgeBelongsToOneCell) {
  const Owned owned([](const Cell& cell) { return owned_features(kFeatureGrid, cell); });
  EXPECT_EQ(owned.nodes.size(), 30U);
  EXPECT_EQ(owned.edges.size(), 5U * 5 + 4U * 6 + 4U * 5);  // along u, along v, diagonals
  for (const auto& [node, cells] : owned.nodes) EXPECT_EQ(cells, 1) << node;
  for (const auto& [edge, cells] : owned.edges) EXPECT_EQ(cells, 1) << edge[0] << " " << edge[1];
  EXPECT_EQ(owned.triangles, 20);
}

// What is left of a torn sheet is what its whole cells have: their nodes, edges and triangles.
TEST(CellFeatures, OfATornSheetWhatBelongsToWholeCellsIsLeft) {
  std::mt19937_64 random(2);
  TornLinks torn(kFeatureGrid);
  for (int cut = 0; cut < 20; ++cut) {
    torn.cut({static_cast<int>(random() % 5), static_cast<int>(random() % 6), random() % 2 == 0});
  }
  const Owned owned([&](const Cell& cell) { return features_left(torn, cell); });
  std::set<std::uint32_t> nodes;
  std::set<Edge> edges;
  int triangles = 0;
  each_feature_cell([&](const Cell& cell) {
    if (torn.face_torn(cell.row, cell.col)) return;
    ++triangles;
    const auto node = [&](std::size_t i) {
      return static_cast<std::uint32_t>(
          kFeatureGrid.index(cell.row + static_cast<int>(i / 2), cell.col + static_cast<int>(i % 2)));
    };
    for (std::size_t i = 0; i < 4; ++i) nodes.insert(node(i));
    for (const auto& edge : kCellEdges) edges.insert({node(edge[0]), node(edge[1])});
  });
  EXPECT_GT(triangles, 0);
  EXPECT_LT(triangles, 20);
  EXPECT_EQ(owned.triangles, triangles);
  for (const auto& [node, cells] : owned.nodes) EXPECT_EQ(cells, nodes.contains(node) ? 1 : 0) << node;
  for (const auto& [edge, cells] : owned.edges) {
    EXPECT_EQ(cells, edges.contains(edge) ? 1 : 0) << edge[0] << " " << edge[1];
  }
}

std::vector<Vec3> random_nodes(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Vec3> nodes;
  nodes.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    nodes.emplace_back(x, y, z);
  }
  return nodes;
}

TEST(CellFeatures, BoxesHoldTheFeaturesWholeWays) {
  const std::vector<Vec3> start = random_nodes(40 + kFeatureGrid.size(), 1),
                          end = random_nodes(40 + kFeatureGrid.size(), 2);
  const CellFeatures cell = cell_features(kFeatureGrid, 40, {1, 2}, 0, start, end);
  const auto first = static_cast<std::uint32_t>(40 + kFeatureGrid.index(1, 2));
  const auto stride = static_cast<std::uint32_t>(kFeatureGrid.stride);
  EXPECT_EQ(cell.node, (std::array{first, first + 1, first + stride, first + stride + 1}));
  const auto expect_around = [&](const Bounds& box, const std::vector<std::size_t>& corners) {
    Bounds expected;
    for (const std::size_t corner : corners) {
      expected.extend(start[cell.node[corner]]);
      expected.extend(end[cell.node[corner]]);
    }
    EXPECT_EQ(box.low, expected.low);
    EXPECT_EQ(box.high, expected.high);
  };
  for (std::size_t i = 0; i < 4; ++i) expect_around(cell.at[i], {i});
  for (std::size_t i = 0; i < 5; ++i) expect_around(cell.edge[i], {kCellEdges[i][0], kCellEdges[i][1]});
  for (std::size_t i = 0; i < 2; ++i) {
    expect_around(cell.triangle[i], {kCellTriangles[i][0], kCellTriangles[i][1], kCellTriangles[i][2]});
  }
}

/// All pairs between all cells of a sheet whose nodes lie at random.
struct RandomSheet {
  RandomSheet() {
    each_feature_cell([&](const Cell& cell) {
      cells.push_back(cell_features(kFeatureGrid, 0, cell, owned_features(kFeatureGrid, cell), nodes, nodes));
    });
  }
  std::vector<Vec3> nodes = random_nodes(kFeatureGrid.size(), 7);
  std::vector<CellFeatures> cells;
};

constexpr double kFeatureMargin = 0.1;

Bounds box_around(const std::vector<Vec3>& nodes, std::initializer_list<std::uint32_t> of) {
  Bounds box;
  for (const std::uint32_t n : of) box.extend(nodes[n]);
  return box;
}

TEST(CellFeatures, EachNodeMeetsEachTriangleNearItOnce) {
  const RandomSheet sheet;
  std::multiset<std::array<std::uint32_t, 4>> found, expected;
  for (const CellFeatures& a : sheet.cells) {
    for (const CellFeatures& b : sheet.cells) {
      node_triangle_pairs(a, b, kFeatureMargin, [&](const FeaturePair& pair) {
        EXPECT_EQ(pair.kind, FeaturePair::Kind::node_triangle);
        found.insert(pair.node);
      });
    }
  }
  for (int i = 0; i < kFeatureGrid.nodes(); ++i) {
    const auto n =
        static_cast<std::uint32_t>(kFeatureGrid.index(i / kFeatureGrid.cols, i % kFeatureGrid.cols));
    for (const CellFeatures& cell : sheet.cells) {
      for (const auto& corner : kCellTriangles) {
        const std::uint32_t p = cell.node[corner[0]], q = cell.node[corner[1]], r = cell.node[corner[2]];
        if (n == p || n == q || n == r) continue;
        const Bounds triangle = box_around(sheet.nodes, {p, q, r});
        if (box_around(sheet.nodes, {n}).near(triangle, kFeatureMargin)) expected.insert({n, p, q, r});
      }
    }
  }
  EXPECT_GT(expected.size(), 50U);
  EXPECT_EQ(found, expected);
}

TEST(CellFeatures, EachEdgeMeetsEachOtherNearItOnce) {
  const RandomSheet sheet;
  const auto unordered = [](const Edge& a, const Edge& b) { return std::minmax(a, b); };
  std::multiset<std::pair<Edge, Edge>> found, expected;
  for (std::size_t i = 0; i < sheet.cells.size(); ++i) {
    for (std::size_t j = i; j < sheet.cells.size(); ++j) {
      edge_pairs(sheet.cells[i], sheet.cells[j], kFeatureMargin, [&](const FeaturePair& pair) {
        EXPECT_EQ(pair.kind, FeaturePair::Kind::edge_edge);
        const Edge a{pair.node[0], pair.node[1]}, b{pair.node[2], pair.node[3]};
        found.insert(unordered(a, b));
      });
    }
  }
  std::set<Edge> edges;
  for (const CellFeatures& cell : sheet.cells) {
    for (const auto& edge : kCellEdges) edges.insert({cell.node[edge[0]], cell.node[edge[1]]});
  }
  for (const Edge& a : edges) {
    for (const Edge& b : edges) {
      if (!(a < b) || a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) continue;
      const Bounds box = box_around(sheet.nodes, {a[0], a[1]});
      if (box.near(box_around(sheet.nodes, {b[0], b[1]}), kFeatureMargin)) expected.insert({a, b});
    }
  }
  EXPECT_GT(expected.size(), 50U);
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace weft
