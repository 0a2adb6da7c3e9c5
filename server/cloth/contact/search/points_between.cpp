#include "cloth/contact/search/points_between.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cloth/core/interrupt.h"
#include "cloth/kernels/contact_kernels.h"

namespace weft {
namespace {

/// Of the hole that lets a solid through: the widest that is left between points. A ball over the middle of
/// such a hole sinks in by 0.29 of its radius.
constexpr double kWidestHole = 0.7;
/// Of a solid's inner radius: from what is deeper the nearest way out may lead along the sheet.
constexpr double kDeep = 0.25;
/// Of a point and a solid that it may be in (WorkLimit).
constexpr double kWorkOfPoint = 1;

/// A cell, by the places of its nodes.
struct CellCorners {
  std::array<Vec3, 4> corner;
  Vec3 middle() const { return (corner[0] + corner[1] + corner[2] + corner[3]) / 4; }
  double radius() const {
    const Vec3 centre = middle();
    double square = 0;
    for (const Vec3& each : corner) square = std::max(square, (each - centre).squaredNorm());
    return std::sqrt(square);
  }
  /// Parts that a side has to be divided into, for no hole to be wider than that.
  int parts(double widest) const {
    const double hole =
        std::sqrt(std::max((corner[3] - corner[0]).squaredNorm(), (corner[2] - corner[1]).squaredNorm())) / 2;
    int parts = 1;
    while (parts < kCellParts && hole > parts * widest) parts *= 2;
    return parts;
  }
};

/// Of the cells that begin at a node: its row and column may be the last, where only an edge begins.
template <class Real>
CellCorners cell_at(const VectorField<Real>& position, int row, int col) {
  const Grid& grid = position.grid();
  const int below = std::min(row + 1, grid.rows - 1), right = std::min(col + 1, grid.cols - 1);
  const kernels::Components<const Real> places = kernels::components(position);
  return {{at(places, grid.index(row, col)), at(places, grid.index(row, right)),
           at(places, grid.index(below, col)), at(places, grid.index(below, right))}};
}

/// How far a solid comes, beyond where it is at the sweep's end, m.
double way_of(const Solid& solid, const Sweep& sweep) {
  const double swing =
      solid.turns() ? (sweep.to - sweep.from) * solid.turn.norm() * outer_radius(solid.shape) : 0;
  return (solid.at(sweep.to) - solid.at(sweep.from)).norm() + swing;
}

/// Which of the cells and links that begin at a node are whole.
struct Whole {
  bool inside, right, below;

  static Whole at(const Grid& grid, const TornLinks* torn, int row, int col) {
    const bool last_row = row + 1 == grid.rows, last_col = col + 1 == grid.cols;
    Whole whole{!last_row && !last_col, !last_col, !last_row};
    if (torn == nullptr) return whole;
    const auto cell = [&](int r, int c) {
      return r >= 0 && c >= 0 && r + 1 < grid.rows && c + 1 < grid.cols && !torn->face_torn(r, c);
    };
    whole.inside = cell(row, col);
    whole.right = whole.right && !torn->torn(Link{row, col, true}) && (cell(row, col) || cell(row - 1, col));
    whole.below = whole.below && !torn->torn(Link{row, col, false}) && (cell(row, col) || cell(row, col - 1));
    return whole;
  }
};

/// Calls visit(point) for every point of what is whole, with so many parts a side.
template <class Visit>
void for_each_point(std::size_t node, int parts, const Whole& whole, Visit visit) {
  const int step = kCellParts / parts;
  for (int i = 0; i < kCellParts; i += step) {
    for (int j = i == 0 ? step : 0; j < kCellParts; j += step) {
      const bool is_whole = i == 0 ? whole.right : j == 0 ? whole.below : whole.inside;
      if (is_whole) visit(PointId{node, static_cast<std::uint8_t>(i * kCellParts + j)});
    }
  }
}

/// Radius, m, of the widest hole between points that a solid does not come through. What stands or goes its
/// own way has to fit through a round hole. A body that cloth pushes turns as it is pushed: what is thin
/// comes edge-on, between two rows of points, what is sharp tip first.
double hole_for(const Solid& solid) { return solid.yields() ? inner_radius(solid.shape) : bore(solid.shape); }

}  // namespace

template <class Real>
std::vector<NearPoint> points_between(const Particles<Real>& particles, const VectorField<Real>& position,
                                      const std::vector<Tile>& tiles, const std::vector<TileSolidPair>& pairs,
                                      const std::vector<Solid>& solids, const Sweep& sweep,
                                      const TornLinks* torn, PointHold hold) {
  std::vector<NearPoint> found;
  const Grid& grid = position.grid();
  for (const TileSolidPair& pair : pairs) {
    const auto index = static_cast<std::size_t>(pair.solid);
    const Solid& solid = solids[index];
    const double widest = kWidestHole * hole_for(solid);
    if (!std::isfinite(widest)) continue;
    const PlacedShape shape = solid.placed(sweep.to);
    const double reach = way_of(solid, sweep) + sweep.reach;
    const Tile& tile = tiles[static_cast<std::size_t>(pair.tile)];
    const int row_end = tile.row_end == grid.rows ? tile.row_end : tile.row_end - 1;
    const int col_end = tile.col_end == grid.cols ? tile.col_end : tile.col_end - 1;
    const kernels::NodeBlock<Real> cells{
        kernels::components(position) + grid.index(tile.row_begin, tile.col_begin),
        tile.row_end - 1 - tile.row_begin, grid.stride, tile.col_end - 1 - tile.col_begin};
    const std::uint32_t wide = kernels::rows_wider(cells, 4 * widest * widest);
    for (int row = tile.row_begin; row < row_end; ++row) {
      // At the sheet's last row no cell begins: its edge is one of the row's above.
      if ((wide >> std::min(row - tile.row_begin, cells.rows - 1) & 1U) == 0) continue;
      for (int col = tile.col_begin; col < col_end; ++col) {
        const CellCorners cell = cell_at(position, row, col);
        const int parts = cell.parts(widest);
        if (parts == 1 || !shape.may_touch(cell.middle(), reach + cell.radius())) continue;
        for_each_point(grid.index(row, col), parts, Whole::at(grid, torn, row, col), [&](const PointId& id) {
          const bool free = ClothPoint<Real>(id, particles).free_part() >= 0.5;
          if (free == (hold == PointHold::free)) found.push_back({id, index});
        });
      }
    }
  }
  std::sort(found.begin(), found.end());
  check_interrupt(kWorkOfPoint * static_cast<double>(found.size()));
  return found;
}

/// Of the sheet at the point, unit; 0 where it has none.
template <class Real>
Vec3 normal_at(const PointId& point, const VectorField<Real>& position) {
  const Grid& grid = position.grid();
  const auto row = static_cast<int>(point.node / static_cast<std::size_t>(grid.stride));
  const auto col = static_cast<int>(point.node % static_cast<std::size_t>(grid.stride));
  const double u = point.u(), v = point.v();
  const kernels::Components<const Real> places = kernels::components(position);
  const auto place = [&](int r, int c) {
    return at(places, grid.index(std::clamp(r, 0, grid.rows - 1), std::clamp(c, 0, grid.cols - 1)));
  };
  // Where one cell ends and the next begins: across both.
  const int left = u > 0 ? col : col - 1, above = v > 0 ? row : row - 1;
  const auto along_u = [&](int r) { return Vec3(place(r, col + 1) - place(r, left)); };
  const auto along_v = [&](int c) { return Vec3(place(row + 1, c) - place(above, c)); };
  const Vec3 du = (1 - v) * along_u(row) + v * along_u(row + 1);
  const Vec3 dv = (1 - u) * along_v(col) + u * along_v(col + 1);
  return du.cross(dv).stableNormalized();
}

template <class Real>
Surface way_out_of(const PlacedShape& shape, const PointId& point, const Vec3& place,
                   const VectorField<Real>& position) {
  Surface nearest = shape.surface(place);
  if (!point.between_nodes() || !(-nearest.distance > kDeep * inner_radius(shape.shape))) return nearest;
  const Vec3 normal = normal_at(point, position);
  if (!(normal.squaredNorm() > 0.5)) return nearest;
  const double one = shape.way_out(place, normal), other = shape.way_out(place, -normal);
  const double least = std::min(one, other);
  if (!std::isfinite(least)) return nearest;
  return {-least, one <= other ? normal : Vec3(-normal)};
}

template Surface way_out_of(const PlacedShape&, const PointId&, const Vec3&, const VectorField<float>&);
template Surface way_out_of(const PlacedShape&, const PointId&, const Vec3&, const VectorField<double>&);
template std::vector<NearPoint> points_between(const Particles<float>&, const VectorField<float>&,
                                               const std::vector<Tile>&, const std::vector<TileSolidPair>&,
                                               const std::vector<Solid>&, const Sweep&, const TornLinks*,
                                               PointHold);
template std::vector<NearPoint> points_between(const Particles<double>&, const VectorField<double>&,
                                               const std::vector<Tile>&, const std::vector<TileSolidPair>&,
                                               const std::vector<Solid>&, const Sweep&, const TornLinks*,
                                               PointHold);

}  // namespace weft
