#include "cloth/contact/contact.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cloth/contact/node_contact.h"
#include "cloth/kernels/contact_kernels.h"
#include "cloth/kernels/node_kernels.h"

namespace weft {
namespace {

/// A node and a solid that approach by less than this part of the solid's inner radius in a substep cannot
/// miss each other by more than a graze: a chord of R/2 lies at most R/32 deep in a ball.
constexpr double kSlowMove = 0.5;

/// Where the nodes were at the substep's start: own * position + other * other's values.
template <class Real>
struct Way {
  kernels::Components<const Real> other;
  Real own, factor;

  static Way of(const Particles<Real>& particles, const VectorField<Real>* start, double seconds) {
    if (start != nullptr) return {kernels::components(*start), Real(0), Real(1)};
    return {kernels::components(particles.velocity), Real(1), static_cast<Real>(-seconds)};
  }
  /// The longest move of any node, m.
  double longest(const Particles<Real>& particles) const {
    return std::sqrt(kernels::largest_square(kernels::components(particles.position), other, Real(1) - own,
                                             -factor, particles.grid().size()));
  }
  /// The node's move.
  Vec3 move(const Vec3& position, std::size_t i) const {
    const Vec3 values(double(other.x[i]), double(other.y[i]), double(other.z[i]));
    return (1 - double(own)) * position - double(factor) * values;
  }
};

kernels::Sphere sphere_of(const PlacedShape& placed, double radius) {
  return {placed.centre.x(), placed.centre.y(), placed.centre.z(), radius * radius};
}

/// Which of a block's rows have a node in the shape.
template <class Real>
std::uint32_t rows_inside(const kernels::NodeBlock<Real>& block, const PlacedShape& placed) {
  if (const auto* sphere = std::get_if<Sphere>(&placed.shape)) {
    return kernels::rows_inside(block, sphere_of(placed, sphere->radius));
  }
  const Eigen::Matrix3d& axes = placed.rotation;
  if (std::holds_alternative<HalfSpace>(placed.shape)) {
    const Vec3 normal = axes.col(1);
    return kernels::rows_inside(
        block, kernels::Below{normal.x(), normal.y(), normal.z(), normal.dot(placed.centre)});
  }
  const Vec3 half = std::get<Box>(placed.shape).half;
  kernels::OrientedBox box{};
  for (int axis = 0; axis < 3; ++axis) {
    box.axis[axis] = {axes(0, axis), axes(1, axis), axes(2, axis), axes.col(axis).dot(placed.centre)};
    box.half[axis] = half[axis];
  }
  return kernels::rows_inside(block, box);
}

/// Which of a block's rows have a node in the solid, or, if it is fast, perhaps on a way through.
template <class Real>
std::uint32_t rows_struck(const kernels::NodeBlock<Real>& block, const MovingSolid& moving,
                          const Way<Real>& way, std::size_t first) {
  const PlacedShape& placed = moving.shape;
  if (!moving.fast || std::holds_alternative<HalfSpace>(placed.shape)) return rows_inside(block, placed);
  const auto* sphere = std::get_if<Sphere>(&placed.shape);
  if (sphere == nullptr) return ~std::uint32_t{0};
  return kernels::rows_swept(block, {way.other + first, way.own, way.factor},
                             {moving.move.x(), moving.move.y(), moving.move.z()},
                             sphere_of(placed, sphere->radius));
}

/// The nodes that a tile answers for. A border node that two tiles share is looked at in the one below or to
/// the right, whose box holds it as well.
struct OwnNodes {
  int rows, cols;

  OwnNodes(const Tile& tile, const Grid& grid)
      : rows((tile.row_end == grid.rows ? tile.row_end : tile.row_end - 1) - tile.row_begin),
        cols((tile.col_end == grid.cols ? tile.col_end : tile.col_end - 1) - tile.col_begin) {}
};

}  // namespace

template <class Real>
const std::vector<Touch>& Contact<Real>::expect(const Particles<Real>& particles,
                                                const std::vector<Solid>& solids, const Substep& substep) {
  const Grid& grid = particles.grid();
  const double h = substep.seconds;
  ahead_ = particles.position;
  kernels::add_scaled(kernels::components(ahead_), kernels::components(particles.velocity),
                      static_cast<Real>(h), grid.size());
  kernels::add_scaled(kernels::components(ahead_), kernels::components(particles.acceleration),
                      static_cast<Real>(h * h), grid.size());
  const kernels::Components<const Real> ahead = kernels::components(std::as_const(ahead_));
  for (const TileSolidPair& pair : broad_phase_.find_pairs(ahead_, solids, {substep.to, substep.to, 0})) {
    const Tile& tile = broad_phase_.tiles()[static_cast<std::size_t>(pair.tile)];
    const auto [rows, cols] = OwnNodes(tile, grid);
    const Solid& solid = solids[static_cast<std::size_t>(pair.solid)];
    const PlacedShape placed = solid.placed(substep.to);
    const std::size_t first = grid.index(tile.row_begin, tile.col_begin);
    const std::uint32_t struck = rows_inside<Real>({ahead + first, rows, grid.stride, cols}, placed);
    for (int r = 0; r < rows; ++r) {
      if ((struck >> r & 1U) == 0) continue;
      for (int c = 0; c < cols; ++c) {
        const int row = tile.row_begin + r, col = tile.col_begin + c;
        if (particles.inverse_mass.at(row, col) == Real(0)) continue;
        const std::size_t node = grid.index(row, col);
        const Vec3 point(double(ahead.x[node]), double(ahead.y[node]), double(ahead.z[node]));
        if (placed.contains(point)) touches_.push_back({node, solid.id});
      }
    }
  }
  std::sort(touches_.begin(), touches_.end());
  touches_.erase(std::unique(touches_.begin(), touches_.end()), touches_.end());
  return touches_;
}

template <class Real>
int Contact<Real>::resolve(Particles<Real>& particles, const std::vector<Solid>& solids,
                           const Substep& substep, const VectorField<Real>* start,
                           VectorField<Real>* rounded_off) {
  touches_.clear();
  const auto way = Way<Real>::of(particles, start, substep.seconds);
  const double longest = way.longest(particles);
  std::vector<MovingSolid> moving;
  moving.reserve(solids.size());
  double reach = 0;  // of the nodes, beyond their last places, m
  for (const Solid& solid : solids) {
    const Vec3 move = solid.at(substep.to) - solid.at(substep.from);
    const bool fast = longest + move.norm() > kSlowMove * inner_radius(solid.shape);
    if (fast) reach = longest;
    moving.push_back({&solid, solid.placed(substep.to), move, fast, substep});
  }
  const std::vector<TileSolidPair>& pairs =
      broad_phase_.find_pairs(particles.position, solids, {substep.from, substep.to, reach});

  const Grid& grid = particles.grid();
  const kernels::Components<const Real> position = kernels::components(particles.position);
  int in_contact = 0;
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    while (end < pairs.size() && pairs[end].tile == pairs[begin].tile) ++end;
    const Tile& tile = broad_phase_.tiles()[static_cast<std::size_t>(pairs[begin].tile)];
    ++counters_.tiles_examined;
    const auto [rows, cols] = OwnNodes(tile, grid);
    const std::size_t first = grid.index(tile.row_begin, tile.col_begin);
    const kernels::NodeBlock<Real> block{position + first, rows, grid.stride, cols};
    std::uint32_t struck = 0;
    for (std::size_t i = begin; i < end; ++i) {
      struck |= rows_struck(block, moving[static_cast<std::size_t>(pairs[i].solid)], way, first);
    }
    counters_.nodes_tested += static_cast<std::uint64_t>(rows * cols);
    for (int r = 0; r < rows; ++r) {
      if ((struck >> r & 1U) == 0) continue;
      for (int c = 0; c < cols; ++c) {
        const int row = tile.row_begin + r, col = tile.col_begin + c;
        if (particles.inverse_mass.at(row, col) == Real(0)) continue;
        const Vec3 move = way.move(particles.position_at(row, col), grid.index(row, col));
        NodeContact<Real> node({particles, rounded_off}, row, col, move, substep.seconds);
        if (node.resolve(moving, impulses_, touches_)) ++in_contact;
      }
    }
  }
  counters_.nodes_in_contact += static_cast<std::uint64_t>(in_contact);
  return in_contact;
}

template class Contact<float>;
template class Contact<double>;

}  // namespace weft
