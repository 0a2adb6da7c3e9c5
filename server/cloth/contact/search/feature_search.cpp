#include "cloth/contact/search/feature_search.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace weft {
namespace {

/// Of the nodes that have strayed, a larger part is not worth looking at by itself.
constexpr double kMostStrayed = 0.25;
/// Starts that differ by less are the same, m: pins' are computed anew.
constexpr double kSameStart = 1e-9;

std::size_t cell_index(const Grid& grid, Cell cell) {
  return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(grid.cols - 1) +
         static_cast<std::size_t>(cell.col);
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

/// Of the nodes that are free.
Vec3 common_motion(const std::vector<Vec3>& start, const std::vector<Vec3>& end,
                   const std::vector<double>& inverse_mass) {
  Vec3 common(0, 0, 0);
  double count = 0;
  for (std::size_t i = 0; i < start.size(); ++i) {
    if (inverse_mass[i] == 0) continue;
    common += end[i] - start[i];
    ++count;
  }
  return count > 0 ? Vec3(common / count) : common;
}

Vec3 common_motion(const LayerNodes& nodes) {
  return common_motion(nodes.start, nodes.end, nodes.inverse_mass);
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
  for (std::size_t i = 0; i < kCellEdges.size(); ++i) {
    if (!a.owns_edge(i)) continue;
    const std::uint32_t p = a.node[kCellEdges[i][0]], q = a.node[kCellEdges[i][1]];
    for (std::size_t j = 0; j < kCellTriangles.size(); ++j) {
      if (!a.edge[i].near(b.triangle[j], 0)) continue;
      const auto& triangle = kCellTriangles[j];
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
      cut.left.push_back(static_cast<std::uint16_t>(features_left(torn, {r, c})));
    }
  }
  cut.tree.set_torn(std::move(faces));
  forget();  // nothing was found of this sheet
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

template <class Visit>
void FeatureSearch::for_each_node(Visit visit) const {
  for (const Sheet& sheet : sheets_) {
    const Grid& grid = sheet.tree.grid();
    for (int r = 0; r < grid.rows; ++r) {
      const std::size_t row = sheet.first + grid.index(r, 0);
      for (std::size_t i = row; i < row + static_cast<std::size_t>(grid.cols); ++i) visit(i);
    }
  }
}

bool FeatureSearch::has_strayed(const FeaturePair& pair) const {
  return std::any_of(pair.node.begin(), pair.node.end(), [&](std::uint32_t n) { return strayed_[n] != 0; });
}

const std::vector<FeaturePair>& FeatureSearch::found(const LayerNodes& nodes, double margin, double again) {
  // Each of two features may have come nearer by half of the room.
  const double room = (margin_ - margin) / 2;
  if (room <= 0) return find(nodes, again);
  const Vec3 common = common_motion(nodes);
  strayed_.assign(end_.size(), 0);
  std::size_t strayed = 0, count = 0;
  for_each_node([&](std::size_t i) {
    ++count;
    const Vec3 end = nodes.end[i] - common;
    if ((end - end_[i]).squaredNorm() <= room * room) return;
    end_[i] = end;
    strayed_[i] = 1;
    ++strayed;
  });
  if (strayed == 0) return pairs_;
  if (static_cast<double>(strayed) > kMostStrayed * static_cast<double>(count)) return find(nodes, again);
  std::erase_if(pairs_, [&](const FeaturePair& pair) { return has_strayed(pair); });
  search(nodes, true);
  return pairs_;
}

const std::vector<FeaturePair>& FeatureSearch::find(const LayerNodes& nodes, double margin) {
  margin_ = margin;
  const Vec3 common = common_motion(nodes);
  end_.resize(nodes.end.size());
  std::transform(nodes.end.begin(), nodes.end.end(), end_.begin(), [&](const Vec3& x) { return x - common; });
  pairs_.clear();
  for (Sheet& sheet : sheets_) sheet.crowded = false;
  search(nodes, false);
  return pairs_;
}

void FeatureSearch::take_over(const FeatureSearch& other, const std::vector<std::uint32_t>& first,
                              const LayerNodes& nodes) {
  margin_ = other.margin_;
  end_.clear();
  for (std::size_t k = 0; k < sheets_.size(); ++k) {
    const std::size_t count = sheets_[k].tree.grid().size();
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3& start = nodes.start[sheets_[k].first + i];
      if ((start - other.start_[first[k] + i]).squaredNorm() > kSameStart * kSameStart) return forget();
    }
    const auto from = other.end_.begin() + first[k];
    end_.insert(end_.end(), from, from + static_cast<std::ptrdiff_t>(count));
  }
  const Vec3 common = common_motion(nodes.start, end_, nodes.inverse_mass);
  for (Vec3& x : end_) x -= common;
  pairs_.clear();
  const auto here = [&](std::uint32_t n) -> std::optional<std::uint32_t> {
    for (std::size_t k = 0; k < sheets_.size(); ++k) {
      if (n >= first[k] && n < first[k] + sheets_[k].tree.grid().size())
        return n - first[k] + sheets_[k].first;
    }
    return std::nullopt;
  };
  for (FeaturePair pair : other.pairs_) {
    if (!here(pair.node[0]) || !here(pair.node[2])) continue;
    for (std::uint32_t& n : pair.node) n = *here(n);
    pairs_.push_back(pair);
  }
}

void FeatureSearch::fit(Sheet& sheet, const LayerNodes& nodes) {
  sheet.tree.refit(nodes.start.data() + sheet.first, end_.data() + sheet.first);
  sheet.features.resize(sheet.tree.cells());
  sheet.seen.resize(sheet.tree.cells(), 0);
}

const CellFeatures& FeatureSearch::features(Sheet& sheet, Cell cell, const LayerNodes& nodes) {
  const Grid& grid = sheet.tree.grid();
  const std::size_t i = cell_index(grid, cell);
  if (sheet.seen[i] != searches_) {
    sheet.seen[i] = searches_;
    const unsigned bits = sheet.left.empty() ? owned_features(grid, cell) : sheet.left[i];
    sheet.features[i] = cell_features(grid, sheet.first, cell, bits, nodes.start, end_);
  }
  return sheet.features[i];
}

void FeatureSearch::search(const LayerNodes& nodes, bool of_strayed) {
  ++searches_;
  start_ = nodes.start;
  for (Sheet& sheet : sheets_) {
    fit(sheet, nodes);
    if (of_strayed) sheet.tree.mark(strayed_.data() + sheet.first);
    sheet.found.assign(sheet.tree.cells(), 0);
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
    if (of_strayed && !has_strayed(pair)) return;
    const FourPoints start = points_of(pair, nodes.start);
    FourPoints move = points_of(pair, end_);
    for (std::size_t i = 0; i < 4; ++i) move[i] -= start[i];
    pair.distance = nearness(pair.kind, start).apart.norm();
    if (pair.distance > margin_ + reach(pair.kind, move)) return;
    pairs_.push_back(pair);
    ++*of_cell;
  };
  for_each_sheets(margin_, [&](Sheet& one, Sheet& other) {
    crowded = &one.crowded;
    if (cells_.size() >= PatchTree::kMostPairs) *crowded = true;
    for (const auto& [first, second] : cells_) {
      of_cell = &one.found[cell_index(one.tree.grid(), first)];
      const CellFeatures &a = features(one, first, nodes), &b = features(other, second, nodes);
      node_triangle_pairs(a, b, margin_, add);
      if (a.node != b.node) node_triangle_pairs(b, a, margin_, add);
      edge_pairs(a, b, margin_, add);
    }
  });
}

bool FeatureSearch::has_triangles(const Sheet& sheet, int row, int col) {
  if (row < 0 || col < 0) return false;
  return sheet.left.empty() || (sheet.left[cell_index(sheet.tree.grid(), {row, col})] & kTriangleBit) != 0;
}

std::vector<Crossing> FeatureSearch::find_crossings(const LayerNodes& nodes) {
  ++searches_;
  end_ = nodes.start;
  forget();
  for (Sheet& sheet : sheets_) fit(sheet, nodes);
  std::vector<Crossing> crossings;
  const auto find = [&](const Sheet& sheet, Cell cell, const CellFeatures& a, const CellFeatures& b) {
    pierced(a, b, nodes.start, [&](std::size_t edge, const std::array<std::uint32_t, 3>& triangle) {
      crossings.push_back({{a.node[kCellEdges[edge][0]], a.node[kCellEdges[edge][1]]},
                           beside(sheet.tree.grid(), a, edge, has_triangles(sheet, cell.row - 1, cell.col),
                                  has_triangles(sheet, cell.row, cell.col - 1)),
                           triangle});
    });
  };
  for_each_sheets(0, [&](Sheet& one, Sheet& other) {
    for (const auto& [first, second] : cells_) {
      const CellFeatures &a = features(one, first, nodes), &b = features(other, second, nodes);
      find(one, first, a, b);
      find(other, second, b, a);
    }
  });
  return crossings;
}

}  // namespace weft
