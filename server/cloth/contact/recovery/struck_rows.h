#pragma once
#include <cmath>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "cloth/contact/recovery/contact.h"
#include "cloth/contact/recovery/node_contact.h"
#include "cloth/kernels/contact_kernels.h"

namespace weft {

/// A node and a solid that approach by less than this part of the solid's inner radius in a substep cannot
/// miss each other by more than a graze: a chord of R/2 lies at most R/32 deep in a ball.
inline constexpr double kSlowMove = 0.5;
/// Of a node and a solid that it may be in (WorkLimit).
inline constexpr double kWorkOfContact = 4;

/// The farthest that any point of it moves in the substep, m.
inline double sweep_of(const Solid& solid, const Substep& substep) {
  const double swing =
      solid.turns() ? (substep.to - substep.from) * solid.turn.norm() * outer_radius(solid.shape) : 0;
  return (solid.at(substep.to) - solid.at(substep.from)).norm() + swing;
}

/// Where a way of the nodes that are at `position` has its other end: own * position + factor * other's
/// values.
template <class Real>
struct Way {
  kernels::Components<const Real> other;
  Real own, factor;

  /// To where the nodes were, or will be.
  static Way to(const VectorField<Real>& places) { return {kernels::components(places), Real(0), Real(1)}; }
  /// To where these velocities take them in so many seconds, be they negative.
  static Way by(const VectorField<Real>& velocity, double seconds) {
    return {kernels::components(velocity), Real(1), static_cast<Real>(seconds)};
  }
  /// The longest of any node's, m.
  double longest(const VectorField<Real>& position) const {
    return std::sqrt(kernels::largest_square(kernels::components(position), other, Real(1) - own, -factor,
                                             position.grid().size()));
  }
  /// From its other end to the node's position, m.
  Vec3 move(const Vec3& position, std::size_t i) const {
    const Vec3 values(double(other.x[i]), double(other.y[i]), double(other.z[i]));
    return (1 - double(own)) * position - double(factor) * values;
  }
};

inline kernels::Sphere sphere_of(const PlacedShape& placed, const Sphere& sphere) {
  return {placed.centre.x(), placed.centre.y(), placed.centre.z(), sphere.radius * sphere.radius};
}

/// The capsule, and what is within `reach`, m, of it.
inline kernels::Stretch stretch_of(const PlacedShape& placed, const Capsule& capsule, double reach = 0) {
  const Vec3 axis = placed.rotation.col(1), start = placed.centre - capsule.half * axis;
  const double radius = capsule.radius + reach;
  return {
      {start.x(), start.y(), start.z()}, {axis.x(), axis.y(), axis.z()}, 2 * capsule.half, radius * radius};
}

/// The box, longer by `reach`, m, to all sides.
inline kernels::OrientedBox oriented_box_of(const PlacedShape& placed, const Box& cuboid, double reach = 0) {
  const Eigen::Matrix3d& axes = placed.rotation;
  kernels::OrientedBox box{};
  for (int axis = 0; axis < 3; ++axis) {
    box.axis[axis] = {axes(0, axis), axes(1, axis), axes(2, axis), axes.col(axis).dot(placed.centre)};
    box.half[axis] = cuboid.half[axis] + reach;
  }
  return box;
}

/// Which of a block's rows have a node that perhaps touches the mesh: reach(index from the block's first) is
/// how far it may have come, m.
template <class Real, class Reach>
std::uint32_t rows_near(const kernels::NodeBlock<Real>& block, const PlacedShape& mesh, Reach reach) {
  std::uint32_t rows = 0;
  for (int r = 0; r < block.rows; ++r) {
    const std::size_t first = static_cast<std::size_t>(r) * static_cast<std::size_t>(block.stride);
    for (std::size_t i = first; i < first + static_cast<std::size_t>(block.cols); ++i) {
      const Vec3 place(double(block.position.x[i]), double(block.position.y[i]), double(block.position.z[i]));
      if (!mesh.may_touch(place, reach(place, i))) continue;
      rows |= std::uint32_t{1} << r;
      break;
    }
  }
  return rows;
}

/// Which of a block's rows have a node in the shape; perhaps, if that is one without a kernel of its own.
template <class Real>
std::uint32_t rows_inside(const kernels::NodeBlock<Real>& block, const PlacedShape& placed) {
  if (const auto* sphere = std::get_if<Sphere>(&placed.shape)) {
    return kernels::rows_inside(block, sphere_of(placed, *sphere));
  }
  if (std::holds_alternative<HalfSpace>(placed.shape)) {
    const Vec3 normal = placed.rotation.col(1);
    return kernels::rows_inside(
        block, kernels::Below{normal.x(), normal.y(), normal.z(), normal.dot(placed.centre)});
  }
  if (const auto* capsule = std::get_if<Capsule>(&placed.shape)) {
    return kernels::rows_inside(block, stretch_of(placed, *capsule));
  }
  const auto* cuboid = std::get_if<Box>(&placed.shape);
  if (cuboid == nullptr) return rows_near(block, placed, [](const Vec3&, std::size_t) { return 0.0; });
  return kernels::rows_inside(block, oriented_box_of(placed, *cuboid));
}

/// Which of a block's rows have a node within `reach`, m, of the shape, and perhaps others.
template <class Real>
std::uint32_t rows_within(const kernels::NodeBlock<Real>& block, const PlacedShape& placed, double reach) {
  if (const auto* capsule = std::get_if<Capsule>(&placed.shape))
    return kernels::rows_inside(block, stretch_of(placed, *capsule, reach));
  if (const auto* cuboid = std::get_if<Box>(&placed.shape))
    return kernels::rows_inside(block, oriented_box_of(placed, *cuboid, reach));
  return kernels::rows_inside(block, sphere_of(placed, Sphere{outer_radius(placed.shape) + reach}));
}

/// Which of a block's rows have a node in the solid, or, if it is fast, perhaps on a way through.
template <class Real>
std::uint32_t rows_struck(const kernels::NodeBlock<Real>& block, const MovingSolid& moving,
                          const Way<Real>& way, std::size_t first) {
  const PlacedShape& placed = moving.shape;
  if (!moving.fast || std::holds_alternative<HalfSpace>(placed.shape)) return rows_inside(block, placed);
  if (std::holds_alternative<Mesh>(placed.shape)) {
    return rows_near(block, placed, [&](const Vec3& place, std::size_t i) {
      return way.move(place, first + i).norm() + moving.sweep;
    });
  }
  const auto* sphere = std::get_if<Sphere>(&placed.shape);
  if (sphere == nullptr) return rows_within(block, placed, moving.reach);
  return kernels::rows_swept(block, {way.other + first, way.own, way.factor},
                             {moving.move.x(), moving.move.y(), moving.move.z()}, sphere_of(placed, *sphere));
}

/// Which of a block's rows have a node that perhaps meets the solid, no ball, in the substep, at whose end it
/// is `placed`: the nodes go `reach`, m, at most.
template <class Real>
std::uint32_t rows_near_way(const kernels::NodeBlock<Real>& block, const Solid& solid,
                            const PlacedShape& placed, const Substep& substep, double reach) {
  constexpr double kSmallTurn = 0.5;  // rad
  const double way = (placed.centre - solid.at(substep.from)).norm() + reach;
  const double outer = outer_radius(solid.shape), turn = (substep.to - substep.from) * solid.turn.norm();
  if (turn > kSmallTurn) return kernels::rows_inside(block, sphere_of(placed, Sphere{outer + way}));
  // As seen from the solid a node at r from its centre goes that way and r times the turn. One that meets it
  // has r <= outer + way + r turn.
  return rows_within(block, placed, way + turn * (outer + way) / (1 - kSmallTurn));
}

/// Calls visit(row, col, met) for every node in those rows of the pairs' tiles that struck(pair, block, first
/// node) finds for the solids `met`, ascending, at least one: bit r for row r.
template <class Real, class Struck, class Visit>
void for_each_struck(const VectorField<Real>& position, const std::vector<Tile>& tiles,
                     const std::vector<TileSolidPair>& pairs, ContactCounters& counters, Struck struck,
                     Visit visit) {
  const Grid& grid = position.grid();
  const kernels::Components<const Real> nodes = kernels::components(position);
  std::vector<std::uint32_t> rows_found;
  std::vector<std::size_t> met;
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    while (end < pairs.size() && pairs[end].tile == pairs[begin].tile) ++end;
    const Tile& tile = tiles[static_cast<std::size_t>(pairs[begin].tile)];
    ++counters.tiles_examined;
    // A border node that two tiles share is looked at in the one below or to the right, whose box holds it as
    // well.
    const int rows = (tile.row_end == grid.rows ? tile.row_end : tile.row_end - 1) - tile.row_begin;
    const int cols = (tile.col_end == grid.cols ? tile.col_end : tile.col_end - 1) - tile.col_begin;
    const std::size_t first = grid.index(tile.row_begin, tile.col_begin);
    const kernels::NodeBlock<Real> block{nodes + first, rows, grid.stride, cols};
    rows_found.clear();
    for (std::size_t i = begin; i < end; ++i) rows_found.push_back(struck(pairs[i], block, first));
    counters.nodes_tested += static_cast<std::uint64_t>(rows * cols);
    for (int r = 0; r < rows; ++r) {
      met.clear();
      for (std::size_t i = begin; i < end; ++i) {
        if ((rows_found[i - begin] >> r & 1U) != 0) met.push_back(static_cast<std::size_t>(pairs[i].solid));
      }
      if (met.empty()) continue;
      for (int c = 0; c < cols; ++c)
        visit(tile.row_begin + r, tile.col_begin + c, std::span<const std::size_t>(met));
    }
  }
}

}  // namespace weft
