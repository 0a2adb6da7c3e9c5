#include "cloth/layers/feature_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace weft {
namespace {

/// A cell's nodes: top left, top right, bottom left, bottom right. A cell owns some of its nodes and edges,
/// so that each belongs to one cell: those of its top left corner, and at the border what is left over.
constexpr std::array<std::array<std::size_t, 3>, 2> kTriangles{{{0, 2, 3}, {0, 3, 1}}};
constexpr std::array<std::array<std::size_t, 2>, 5> kEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

std::size_t cell_index(const Grid& grid, Cell cell) {
  return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(grid.cols - 1) +
         static_cast<std::size_t>(cell.col);
}

/// Bits of what a cell has of its own: four nodes, five edges, its triangles.
constexpr unsigned node_bit(std::size_t i) { return 1U << i; }
constexpr unsigned edge_bit(std::size_t i) { return 1U << (4 + i); }
constexpr unsigned kTriangleBit = 1U << 9;

/// What a cell of a whole sheet has.
unsigned owned(const Grid& grid, Cell cell) {
  const bool last_row = cell.row == grid.rows - 2, last_col = cell.col == grid.cols - 2;
  unsigned bits = node_bit(0) | edge_bit(0) | edge_bit(1) | edge_bit(2) | kTriangleBit;
  if (last_col) bits |= node_bit(1) | edge_bit(3);
  if (last_row) bits |= node_bit(2) | edge_bit(4);
  if (last_row && last_col) bits |= node_bit(3);
  return bits;
}

/// There is such a cell, and it is not torn.
bool whole(const TornLinks& torn, int row, int col) {
  const Grid& grid = torn.grid();
  return row >= 0 && col >= 0 && row < grid.rows - 1 && col < grid.cols - 1 && !torn.face_torn(row, col);
}

/// Of these, what belongs to a whole cell.
unsigned left_of(const TornLinks& torn, Cell cell) {
  const auto is_whole = [&](int down, int right) { return whole(torn, cell.row + down, cell.col + right); };
  const bool here = is_whole(0, 0), above = is_whole(-1, 0), before = is_whole(0, -1);
  unsigned bits = here ? edge_bit(2) | edge_bit(3) | edge_bit(4) | node_bit(3) | kTriangleBit : 0;
  if (here || above) bits |= edge_bit(0) | node_bit(1);
  if (here || before) bits |= edge_bit(1) | node_bit(2);
  if (here || above || before || is_whole(-1, -1)) bits |= node_bit(0);
  return bits & owned(torn.grid(), cell);
}

/// A cell with its features' boxes.
struct CellFeatures {
  std::array<std::uint32_t, 4> node{};
  unsigned bits = 0;
  std::array<Bounds, 4> at{};  ///< of the nodes' ways
  std::array<Bounds, 2> triangle{};
  std::array<Bounds, 5> edge{};

  bool owns_node(std::size_t i) const { return (bits & node_bit(i)) != 0; }
  bool owns_edge(std::size_t i) const { return (bits & edge_bit(i)) != 0; }
  bool has_triangles() const { return (bits & kTriangleBit) != 0; }
};

/// `left` is of all cells, or empty where the sheet is whole.
CellFeatures features_of(const Grid& grid, std::uint32_t first, const std::vector<std::uint16_t>& left,
                         Cell cell, const std::vector<Vec3>& start, const std::vector<Vec3>& end) {
  CellFeatures features;
  const auto top = first + static_cast<std::uint32_t>(grid.index(cell.row, cell.col));
  const auto bottom = top + static_cast<std::uint32_t>(grid.stride);
  features.node = {top, top + 1, bottom, bottom + 1};
  features.bits = left.empty() ? owned(grid, cell) : left[cell_index(grid, cell)];
  for (std::size_t i = 0; i < 4; ++i) {
    features.at[i].extend(start[features.node[i]]);
    features.at[i].extend(end[features.node[i]]);
  }
  for (std::size_t i = 0; i < 5; ++i) {
    features.edge[i] = features.at[kEdges[i][0]];
    features.edge[i].extend(features.at[kEdges[i][1]]);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    features.triangle[i] = features.edge[2];
    features.triangle[i].extend(features.at[kTriangles[i][i == 0 ? 1 : 2]]);
  }
  return features;
}

template <class Visit>
void node_triangle_pairs(const CellFeatures& a, const CellFeatures& b, double margin, Visit visit) {
  if (!b.has_triangles()) return;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!a.owns_node(i)) continue;
    for (std::size_t t = 0; t < 2; ++t) {
      if (!a.at[i].near(b.triangle[t], margin)) continue;
      const std::uint32_t n = a.node[i], p = b.node[kTriangles[t][0]], q = b.node[kTriangles[t][1]],
                          r = b.node[kTriangles[t][2]];
      if (n != p && n != q && n != r) visit({FeaturePair::Kind::node_triangle, {n, p, q, r}});
    }
  }
}

template <class Visit>
void edge_pairs(const CellFeatures& a, const CellFeatures& b, double margin, Visit visit) {
  const bool same = a.node == b.node;
  for (std::size_t i = 0; i < 5; ++i) {
    if (!a.owns_edge(i)) continue;
    const std::uint32_t p = a.node[kEdges[i][0]], q = a.node[kEdges[i][1]];
    for (std::size_t j = same ? i + 1 : 0; j < 5; ++j) {
      if (!b.owns_edge(j) || !a.edge[i].near(b.edge[j], margin)) continue;
      const std::uint32_t r = b.node[kEdges[j][0]], s = b.node[kEdges[j][1]];
      if (p != r && p != s && q != r && q != s) visit({FeaturePair::Kind::edge_edge, {p, q, r, s}});
    }
  }
}

/// Six times the volume of the tetrahedron.
double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (b - a).cross(c - a).dot(d - a);
}

/// The edge from p to q passes through the triangle.
bool pierces(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  if ((volume(a, b, c, p) > 0) == (volume(a, b, c, q) > 0)) return false;
  const bool ab = volume(p, q, a, b) > 0, bc = volume(p, q, b, c) > 0, ca = volume(p, q, c, a) > 0;
  return ab == bc && bc == ca;
}

/// The third nodes of the triangles beside a cell's edge; at a rim twice the same. `above` and `before` are
/// true where there is a whole cell.
std::array<std::uint32_t, 2> beside(const Grid& grid, const CellFeatures& cell, std::size_t edge, bool above,
                                    bool before) {
  const auto stride = static_cast<std::uint32_t>(grid.stride);
  const auto& node = cell.node;
  const auto sides = [&](std::uint32_t mine, std::uint32_t other, bool is_there) {
    const std::uint32_t here = cell.has_triangles() ? mine : other;
    return std::array{here, is_there ? other : here};
  };
  switch (edge) {
    case 0:
      return sides(node[3], node[0] - stride, above);
    case 1:
      return sides(node[3], node[0] - 1, before);
    case 2:
      return {node[1], node[2]};
    default:  // of the last column or row
      return {node[0], node[0]};
  }
}

template <class Visit>
void pierced(const CellFeatures& a, const CellFeatures& b, const std::vector<Vec3>& x, Visit visit) {
  if (!b.has_triangles()) return;
  for (std::size_t i = 0; i < kEdges.size(); ++i) {
    if (!a.owns_edge(i)) continue;
    const std::uint32_t p = a.node[kEdges[i][0]], q = a.node[kEdges[i][1]];
    for (std::size_t j = 0; j < kTriangles.size(); ++j) {
      if (!a.edge[i].near(b.triangle[j], 0)) continue;
      const auto& triangle = kTriangles[j];
      const std::array<std::uint32_t, 3> t{b.node[triangle[0]], b.node[triangle[1]], b.node[triangle[2]]};
      const auto shared = [&](std::uint32_t n) { return n == p || n == q; };
      if (std::any_of(t.begin(), t.end(), shared)) continue;
      if (pierces(x[p], x[q], x[t[0]], x[t[1]], x[t[2]])) visit(i, t);
    }
  }
}

}  // namespace

void FeatureSearch::set_grids(const std::vector<Grid>& grids) {
  sheets_.clear();
  std::uint32_t first = 0;
  for (const Grid& grid : grids) {
    sheets_.emplace_back(grid, first);
    first += static_cast<std::uint32_t>(grid.size());
  }
}

void FeatureSearch::set_torn(std::size_t sheet, const TornLinks& torn) {
  Sheet& cut = sheets_[sheet];
  const Grid& grid = cut.tree.grid();
  std::vector<std::uint32_t> faces;
  cut.left.clear();
  for (int r = 0; r + 1 < grid.rows; ++r) {
    for (int c = 0; c + 1 < grid.cols; ++c) {
      if (torn.face_torn(r, c)) faces.push_back(static_cast<std::uint32_t>(cell_index(grid, {r, c})));
      cut.left.push_back(static_cast<std::uint16_t>(left_of(torn, {r, c})));
    }
  }
  cut.tree.set_torn(std::move(faces));
  margin_ = 0;  // nothing was found of this sheet
}

template <class Visit>
void FeatureSearch::for_each_sheets(double margin, Visit visit) {
  cell_pairs_ = 0;
  for (std::size_t i = 0; i < sheets_.size(); ++i) {
    for (std::size_t j = i; j < sheets_.size(); ++j) {
      cells_.clear();
      if (i == j) {
        sheets_[i].tree.find_own_pairs(margin, cells_);
      } else {
        sheets_[i].tree.find_pairs(sheets_[j].tree, margin, cells_);
      }
      cell_pairs_ += cells_.size();
      visit(sheets_[i], sheets_[j]);
    }
  }
}

Vec3 FeatureSearch::common_motion(const LayerNodes& nodes) {
  Vec3 common(0, 0, 0);
  double count = 0;
  for (std::size_t i = 0; i < nodes.start.size(); ++i) {
    if (nodes.inverse_mass[i] == 0) continue;
    common += nodes.end[i] - nodes.start[i];
    ++count;
  }
  return count > 0 ? Vec3(common / count) : common;
}

const std::vector<FeaturePair>& FeatureSearch::found(const LayerNodes& nodes, double margin, double again) {
  // Each of two features may have come nearer by half of the room.
  const double room = (margin_ - margin) / 2;
  const Vec3 common = common_motion(nodes);
  bool covered = room > 0;
  for (std::size_t i = 0; covered && i < end_.size(); ++i) {
    covered = (nodes.end[i] - common - end_[i]).squaredNorm() <= room * room;
  }
  return covered ? pairs_ : find(nodes, again);
}

const std::vector<FeaturePair>& FeatureSearch::find(const LayerNodes& nodes, double margin) {
  ++searches_;
  margin_ = margin;
  const Vec3 common = common_motion(nodes);
  end_.resize(nodes.end.size());
  std::transform(nodes.end.begin(), nodes.end.end(), end_.begin(), [&](const Vec3& x) { return x - common; });
  for (Sheet& sheet : sheets_) sheet.tree.refit(nodes.start.data() + sheet.first, end_.data() + sheet.first);

  pairs_.clear();
  for (Sheet& sheet : sheets_) {
    sheet.found.assign(sheet.tree.cells(), 0);
    sheet.crowded = false;
  }
  std::uint16_t* of_cell = nullptr;
  bool* crowded = nullptr;
  const auto add = [&](FeaturePair pair) {
    if (*of_cell == kMostOfCell || pairs_.size() == kMost) {
      *crowded = true;
      return;
    }
    const auto tangled = [&](std::uint32_t n) { return nodes.tangled[n] != 0; };
    if (std::any_of(pair.node.begin(), pair.node.end(), tangled)) return;
    const FourPoints start = points_of(pair, nodes.start);
    FourPoints move = points_of(pair, end_);
    for (std::size_t i = 0; i < 4; ++i) move[i] -= start[i];
    pair.distance = nearness(pair.kind, start).apart.norm();
    if (pair.distance > margin + reach(pair.kind, move)) return;
    pairs_.push_back(pair);
    ++*of_cell;
  };
  for_each_sheets(margin, [&](Sheet& one, const Sheet& other) {
    crowded = &one.crowded;
    if (cells_.size() >= PatchTree::kMostPairs) *crowded = true;
    Cell last{-1, -1};
    CellFeatures a;
    for (const auto& [first, second] : cells_) {
      if (first.row != last.row || first.col != last.col) {
        a = features_of(one.tree.grid(), one.first, one.left, first, nodes.start, end_);
        last = first;
        of_cell = &one.found[cell_index(one.tree.grid(), first)];
      }
      const CellFeatures b =
          features_of(other.tree.grid(), other.first, other.left, second, nodes.start, end_);
      node_triangle_pairs(a, b, margin, add);
      if (a.node != b.node) node_triangle_pairs(b, a, margin, add);
      edge_pairs(a, b, margin, add);
    }
  });
  return pairs_;
}

bool FeatureSearch::has_triangles(const Sheet& sheet, int row, int col) {
  if (row < 0 || col < 0) return false;
  return sheet.left.empty() || (sheet.left[cell_index(sheet.tree.grid(), {row, col})] & kTriangleBit) != 0;
}

std::vector<Crossing> FeatureSearch::find_crossings(const LayerNodes& nodes) {
  for (Sheet& sheet : sheets_) {
    sheet.tree.refit(nodes.start.data() + sheet.first, nodes.start.data() + sheet.first);
  }
  std::vector<Crossing> crossings;
  const auto find = [&](const Sheet& sheet, Cell cell, const CellFeatures& a, const CellFeatures& b) {
    pierced(a, b, nodes.start, [&](std::size_t edge, const std::array<std::uint32_t, 3>& triangle) {
      crossings.push_back({{a.node[kEdges[edge][0]], a.node[kEdges[edge][1]]},
                           beside(sheet.tree.grid(), a, edge, has_triangles(sheet, cell.row - 1, cell.col),
                                  has_triangles(sheet, cell.row, cell.col - 1)),
                           triangle});
    });
  };
  for_each_sheets(0, [&](const Sheet& one, const Sheet& other) {
    for (const auto& [first, second] : cells_) {
      const CellFeatures a =
          features_of(one.tree.grid(), one.first, one.left, first, nodes.start, nodes.start);
      const CellFeatures b =
          features_of(other.tree.grid(), other.first, other.left, second, nodes.start, nodes.start);
      find(one, first, a, b);
      find(other, second, b, a);
    }
  });
  return crossings;
}

}  // namespace weft
