#pragma once
#include "cloth/contact/search/features.h"
#include "cloth/contact/search/patch_tree.h"
#include "cloth/sheet/tear/torn_links.h"

namespace weft {

/// A cell's triangles and edges by its nodes: 0 top left, 1 top right, 2 bottom left, 3 bottom right. Its
/// diagonal is the one from its top left to its bottom right node, as drawn.
inline constexpr std::array<std::array<std::size_t, 3>, 2> kCellTriangles{{{0, 2, 3}, {0, 3, 1}}};
inline constexpr std::array<std::array<std::size_t, 2>, 5> kCellEdges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

/// What a cell has of its own, as bits: four nodes, five edges, its triangles. Each node and edge belongs to
/// one cell: those of a cell's top left corner are its own, and at the border what is left over.
constexpr unsigned node_bit(std::size_t i) { return 1U << i; }
constexpr unsigned edge_bit(std::size_t i) { return 1U << (4 + i); }
inline constexpr unsigned kTriangleBit = 1U << 9;
/// Of a whole sheet's cell.
unsigned owned_features(const Grid& grid, Cell cell);
/// Of these, what belongs to a cell that is not torn.
unsigned features_left(const TornLinks& torn, Cell cell);

/// A cell with the boxes around its features' ways.
struct CellFeatures {
  std::array<std::uint32_t, 4> node{};  ///< indices into LayerNodes
  unsigned bits = 0;
  std::array<Bounds, 4> at{};  ///< of the nodes
  std::array<Bounds, 2> triangle{};
  std::array<Bounds, 5> edge{};

  bool owns_node(std::size_t i) const { return (bits & node_bit(i)) != 0; }
  bool owns_edge(std::size_t i) const { return (bits & edge_bit(i)) != 0; }
  bool has_triangles() const { return (bits & kTriangleBit) != 0; }
};

/// Of a cell of a sheet whose nodes begin at `first` and go from `start` to `end`; `bits` are its own
/// features.
CellFeatures cell_features(const Grid& grid, std::uint32_t first, Cell cell, unsigned bits,
                           const std::vector<Vec3>& start, const std::vector<Vec3>& end);

/// Calls visit(FeaturePair) for the nodes of `a` whose boxes come as near to triangles of `b` as `margin`,
/// and do not belong to them.
template <class Visit>
void node_triangle_pairs(const CellFeatures& a, const CellFeatures& b, double margin, Visit visit) {
  if (!b.has_triangles()) return;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!a.owns_node(i)) continue;
    for (std::size_t t = 0; t < 2; ++t) {
      if (!a.at[i].near(b.triangle[t], margin)) continue;
      const auto& corner = kCellTriangles[t];
      const std::uint32_t n = a.node[i], p = b.node[corner[0]], q = b.node[corner[1]], r = b.node[corner[2]];
      if (n != p && n != q && n != r) visit({FeaturePair::Kind::node_triangle, {n, p, q, r}});
    }
  }
}

/// The same of edges of `a` and of `b` that share no node.
template <class Visit>
void edge_pairs(const CellFeatures& a, const CellFeatures& b, double margin, Visit visit) {
  const bool same = a.node == b.node;
  for (std::size_t i = 0; i < 5; ++i) {
    if (!a.owns_edge(i)) continue;
    const std::uint32_t p = a.node[kCellEdges[i][0]], q = a.node[kCellEdges[i][1]];
    for (std::size_t j = same ? i + 1 : 0; j < 5; ++j) {
      if (!b.owns_edge(j) || !a.edge[i].near(b.edge[j], margin)) continue;
      const std::uint32_t r = b.node[kCellEdges[j][0]], s = b.node[kCellEdges[j][1]];
      if (p != r && p != s && q != r && q != s) visit({FeaturePair::Kind::edge_edge, {p, q, r, s}});
    }
  }
}

}  // namespace weft
