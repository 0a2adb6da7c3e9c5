#include "cloth/contact/recovery/contact.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "cloth/contact/recovery/node_contact.h"
#include "cloth/core/interrupt.h"
#include "cloth/kernels/contact_kernels.h"
#include "cloth/kernels/node_kernels.h"

namespace weft {
namespace {

/// A node and a solid that approach by less than this part of the solid's inner radius in a substep cannot
/// miss each other by more than a graze: a chord of R/2 lies at most R/32 deep in a ball.
constexpr double kSlowMove = 0.5;
/// Of a node and a solid that it may be in (WorkLimit).
constexpr double kWorkOfContact = 4;

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

kernels::Sphere sphere_of(const PlacedShape& placed, const Sphere& sphere) {
  return {placed.centre.x(), placed.centre.y(), placed.centre.z(), sphere.radius * sphere.radius};
}

kernels::Stretch stretch_of(const PlacedShape& placed, const Capsule& capsule) {
  const Vec3 axis = placed.rotation.col(1), start = placed.centre - capsule.half * axis;
  return {{start.x(), start.y(), start.z()},
          {axis.x(), axis.y(), axis.z()},
          2 * capsule.half,
          capsule.radius * capsule.radius};
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
  const Eigen::Matrix3d& axes = placed.rotation;
  if (std::holds_alternative<HalfSpace>(placed.shape)) {
    const Vec3 normal = axes.col(1);
    return kernels::rows_inside(
        block, kernels::Below{normal.x(), normal.y(), normal.z(), normal.dot(placed.centre)});
  }
  if (const auto* capsule = std::get_if<Capsule>(&placed.shape)) {
    return kernels::rows_inside(block, stretch_of(placed, *capsule));
  }
  const auto* cuboid = std::get_if<Box>(&placed.shape);
  if (cuboid == nullptr) return rows_near(block, placed, [](const Vec3&, std::size_t) { return 0.0; });
  kernels::OrientedBox box{};
  for (int axis = 0; axis < 3; ++axis) {
    box.axis[axis] = {axes(0, axis), axes(1, axis), axes(2, axis), axes.col(axis).dot(placed.centre)};
    box.half[axis] = cuboid->half[axis];
  }
  return kernels::rows_inside(block, box);
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
  if (sphere == nullptr) return ~std::uint32_t{0};
  return kernels::rows_swept(block, {way.other + first, way.own, way.factor},
                             {moving.move.x(), moving.move.y(), moving.move.z()}, sphere_of(placed, *sphere));
}

/// Which of a block's rows have a node that perhaps meets the solid, no ball, in the substep: the nodes go
/// `reach`, m, at most. Beyond the ball around it where it ends up and what both move none does.
template <class Real>
std::uint32_t rows_near_way(const kernels::NodeBlock<Real>& block, const Solid& solid, const Substep& substep,
                            double reach) {
  const Vec3 place = solid.at(substep.to);
  const double around = outer_radius(solid.shape) + (place - solid.at(substep.from)).norm() + reach;
  return kernels::rows_inside(block, kernels::Sphere{place.x(), place.y(), place.z(), around * around});
}

bool stands_firm(const Solid& solid) { return !solid.yields(); }

bool stands_firm_or_turns(const Solid& solid) { return !solid.yields() || solid.yields_turning(); }

}  // namespace

template <class Real>
int Contact<Real>::resolve(Particles<Real>& particles, std::vector<Solid>& solids, const Substep& substep,
                           const VectorField<Real>* start, VectorField<Real>* rounded_off) {
  touches_.clear();
  auto way = Way<Real>::of(particles, start, substep.seconds);
  const double longest = way.longest(particles);
  std::vector<MovingSolid> moving;
  moving.reserve(solids.size());
  double reach = 0;  // of the nodes, beyond their last places, m
  for (const Solid& solid : solids) {
    const Vec3 move = solid.at(substep.to) - solid.at(substep.from);
    const double swing =
        solid.turns() ? (substep.to - substep.from) * solid.turn.norm() * outer_radius(solid.shape) : 0;
    const double sweep = move.norm() + swing;
    const bool fast = longest + sweep > kSlowMove * inner_radius(solid.shape);
    if (fast) reach = longest;
    const double grazing = solid.yields_turning() ? kSlowMove * inner_radius(solid.shape) : 0;
    moving.push_back(
        {&solid, solid.placed(substep.to), move, sweep, fast, grazing, solid.velocity, solid.spin, substep});
  }
  const Sweep sweep{substep.from, substep.to, reach};
  std::vector<TileSolidPair> pairs = broad_phase_.find_pairs(particles.position, solids, sweep);
  std::vector<std::size_t> may_meet;
  const typename NodeContact<Real>::State state{particles, rounded_off, start != nullptr, not_held_,
                                                kept_aside_};

  int in_contact = 0;
  // Nodes come last: none is left inside. What moves points moves them: their ways begin where they did.
  const std::vector<NearPoint> between = points_near(particles, particles.position, pairs, solids, sweep);
  // A node that its cell's points take along goes farther than its motion says.
  for (const NearPoint& near : between) moving[near.solid].fast = true;
  if (!between.empty() && start == nullptr) {
    began_ = particles.position;
    kernels::add_scaled(kernels::components(began_), kernels::components(std::as_const(particles.velocity)),
                        static_cast<Real>(-substep.seconds), particles.grid().size());
    way = Way<Real>::of(particles, &began_, substep.seconds);
  }
  for (auto begin = between.begin(); begin != between.end();) {
    const PointId id = begin->point;
    for (may_meet.clear(); begin != between.end() && begin->point == id; ++begin)
      may_meet.push_back(begin->solid);
    Vec3 move(0, 0, 0);
    ClothPoint<Real>(id, particles).for_each_node([&](std::size_t i, double weight) {
      move += weight * way.move(at(kernels::components(std::as_const(particles.position)), i), i);
    });
    if (NodeContact<Real>(state, id, may_meet, move).resolve(moving, touches_)) ++in_contact;
  }
  if (!between.empty()) pairs = broad_phase_.find_pairs(particles.position, solids, sweep);
  may_meet.resize(solids.size());
  std::iota(may_meet.begin(), may_meet.end(), 0);
  for_each_struck(
      particles.position, pairs,
      [&](const TileSolidPair& pair, const kernels::NodeBlock<Real>& block, std::size_t first) {
        return rows_struck(block, moving[static_cast<std::size_t>(pair.solid)], way, first);
      },
      [&](int row, int col) {
        if (particles.inverse_mass.at(row, col) == Real(0)) return;
        const std::size_t i = particles.grid().index(row, col);
        const Vec3 move = way.move(particles.local_position_at(row, col), i);
        if (NodeContact<Real>(state, {i}, may_meet, move).resolve(moving, touches_)) ++in_contact;
      });
  for (std::size_t i = 0; i < solids.size(); ++i) {
    if (moving[i].velocity == solids[i].velocity && moving[i].spin == solids[i].spin) continue;
    solids[i].go_on(moving[i].velocity, moving[i].spin, substep.to, substep.step_seconds());
  }
  not_held_.clear();
  kept_aside_.clear();
  counters_.nodes_in_contact += static_cast<std::uint64_t>(in_contact);
  check_interrupt(kWorkOfContact * static_cast<double>(in_contact) * static_cast<double>(solids.size()));
  return in_contact;
}

template <class Real>
const std::vector<Touch>& Contact<Real>::expect(const Particles<Real>& particles,
                                                const std::vector<Solid>& solids, const Substep& substep) {
  if (std::none_of(solids.begin(), solids.end(), stands_firm)) return touches_;
  const std::size_t count = particles.grid().size();
  const double h = substep.seconds;
  ahead_ = particles.position;
  kernels::add_scaled(kernels::components(ahead_), kernels::components(particles.velocity),
                      static_cast<Real>(h), count);
  kernels::add_scaled(kernels::components(ahead_), kernels::components(particles.acceleration),
                      static_cast<Real>(h * h), count);
  find_inside(particles, ahead_, solids, substep, stands_firm, touches_);
  std::sort(touches_.begin(), touches_.end());
  touches_.erase(std::unique(touches_.begin(), touches_.end()), touches_.end());
  return touches_;
}

template <class Real>
const std::vector<Touch>& Contact<Real>::inside(const Particles<Real>& particles,
                                                const std::vector<Solid>& solids, const Substep& substep) {
  inside_.clear();
  if (std::any_of(solids.begin(), solids.end(), stands_firm_or_turns)) {
    find_inside(particles, particles.position, solids, substep, stands_firm_or_turns, inside_);
  }
  return inside_;
}

template <class Real>
void Contact<Real>::find_inside(const Particles<Real>& particles, const VectorField<Real>& position,
                                const std::vector<Solid>& solids, const Substep& substep,
                                bool (*sought)(const Solid&), std::vector<Touch>& found) {
  const Sweep sweep{substep.to, substep.to, 0};
  const std::vector<TileSolidPair>& pairs = broad_phase_.find_pairs(position, solids, sweep);
  for_each_struck(
      position, pairs,
      [&](const TileSolidPair& pair, const kernels::NodeBlock<Real>& block, std::size_t) {
        const Solid& solid = solids[static_cast<std::size_t>(pair.solid)];
        return sought(solid) ? rows_inside(block, solid.placed(substep.to)) : std::uint32_t{0};
      },
      [&](int row, int col) {
        if (particles.inverse_mass.at(row, col) == Real(0)) return;
        const Vec3 place(double(position.x.at(row, col)), double(position.y.at(row, col)),
                         double(position.z.at(row, col)));
        for (const Solid& solid : solids) {
          if (!sought(solid) || !solid.placed(substep.to).contains(place)) continue;
          found.push_back({particles.grid().index(row, col), solid.id});
        }
      });
  for (const NearPoint& near : points_near(particles, position, pairs, solids, sweep)) {
    const Solid& solid = solids[near.solid];
    const Vec3 place = ClothPoint<Real>(near.point, particles).of(kernels::components(position));
    if (!sought(solid) || !solid.placed(substep.to).contains(place)) continue;
    found.push_back({near.point.node, solid.id, near.point.within});
  }
  check_interrupt(kWorkOfContact * static_cast<double>(found.size()));
}

template <class Real>
const std::vector<Arrival>& Contact<Real>::foresee(const Particles<Real>& particles,
                                                   const std::vector<Solid>& solids, const Substep& substep,
                                                   bool (*sought)(const Solid&)) {
  arrivals_.clear();
  if (std::none_of(solids.begin(), solids.end(), sought)) return arrivals_;
  const double h = substep.seconds;
  const kernels::Components<const Real> velocity = kernels::components(particles.velocity);
  const double reach =
      h * std::sqrt(kernels::largest_square(velocity, velocity, Real(1), Real(0), particles.grid().size()));
  const Sweep sweep{substep.from, substep.to, reach};
  const std::vector<TileSolidPair>& pairs = broad_phase_.find_pairs(particles.position, solids, sweep);
  const auto look = [&](const PointId& id, const Vec3& place, const Vec3& way, std::size_t i) {
    const Solid& solid = solids[i];
    // As seen from the solid where it will be.
    Vec3 begin = place + solid.at(substep.to) - solid.at(substep.from);
    if (solid.turns()) begin = place + solid.move_of(place, substep.from, substep.to);
    const Vec3 end = place + way;
    const PlacedShape shape = solid.placed(substep.to);
    const std::optional<Hit> hit = shape.contains(begin) ? std::nullopt : shape.first_hit(begin, end);
    if (!hit) return;
    const double inward = (end - begin).dot(hit->normal);
    arrivals_.push_back(
        {{id.node, solid.id, id.within}, i, {(1 - hit->fraction) * inward, hit->normal}, -inward / h});
  };
  for_each_struck(
      particles.position, pairs,
      [&](const TileSolidPair& pair, const kernels::NodeBlock<Real>& block, std::size_t first) {
        const Solid& solid = solids[static_cast<std::size_t>(pair.solid)];
        if (!sought(solid)) return std::uint32_t{0};
        const auto* sphere = std::get_if<Sphere>(&solid.shape);
        if (sphere == nullptr) return rows_near_way(block, solid, substep, reach);
        // The kernel looks at the way back: from where node and ball will be to where they are.
        const Vec3 place = solid.at(substep.from), back = place - solid.at(substep.to);
        return kernels::rows_swept(block, {velocity + first, Real(1), static_cast<Real>(h)},
                                   {back.x(), back.y(), back.z()},
                                   {place.x(), place.y(), place.z(), sphere->radius * sphere->radius});
      },
      [&](int row, int col) {
        if (particles.inverse_mass.at(row, col) == Real(0)) return;
        const Vec3 place = particles.local_position_at(row, col), way = h * particles.velocity_at(row, col);
        for (std::size_t i = 0; i < solids.size(); ++i) {
          if (sought(solids[i])) look({particles.grid().index(row, col)}, place, way, i);
        }
      });
  for (const NearPoint& near : points_near(particles, particles.position, pairs, solids, sweep)) {
    if (!sought(solids[near.solid])) continue;
    const ClothPoint<Real> point(near.point, particles);
    look(near.point, point.of(kernels::components(particles.position)), h * point.of(velocity), near.solid);
  }
  return arrivals_;
}

template <class Real>
std::vector<NearPoint> Contact<Real>::pinned_near(const Particles<Real>& particles,
                                                  const std::vector<Solid>& solids, double longest) {
  std::vector<NearPoint> found;
  // What comes nearer than half a body's width may be hit when something bends its way.
  double reach = 0;
  for (const Solid& solid : solids) {
    if (solid.yields()) reach = std::max(reach, longest + inner_radius(solid.shape));
  }
  if (reach == 0) return found;
  const Substep step;
  const Sweep sweep{step.from, step.to, reach};
  const std::vector<TileSolidPair>& pairs = broad_phase_.find_pairs(particles.position, solids, sweep);
  for_each_struck(
      particles.position, pairs,
      [&](const TileSolidPair& pair, const kernels::NodeBlock<Real>& block, std::size_t) {
        const Solid& solid = solids[static_cast<std::size_t>(pair.solid)];
        return solid.yields() ? rows_near_way(block, solid, step, reach) : std::uint32_t{0};
      },
      [&](int row, int col) {
        if (particles.inverse_mass.at(row, col) != Real(0)) return;
        const Vec3 place = particles.local_position_at(row, col);
        for (std::size_t i = 0; i < solids.size(); ++i) {
          if (!solids[i].yields()) continue;
          const double way = (solids[i].at(step.to) - solids[i].at(step.from)).norm();
          if ((place - solids[i].at(step.to)).norm() > outer_radius(solids[i].shape) + way + reach) continue;
          found.push_back({{particles.grid().index(row, col)}, i});
        }
      });
  for (const NearPoint& near :
       points_near(particles, particles.position, pairs, solids, sweep, PointHold::pinned)) {
    if (solids[near.solid].yields()) found.push_back(near);
  }
  return found;
}

template <class Real>
int Contact<Real>::keep(const std::vector<Touch>& pressed) {
  if (pressed.empty()) return 0;
  std::vector<Touch> found = touches_;
  std::sort(found.begin(), found.end());
  std::set_difference(pressed.begin(), pressed.end(), found.begin(), found.end(),
                      std::back_inserter(touches_));
  const std::size_t kept = touches_.size() - found.size();
  counters_.nodes_in_contact += kept;
  return static_cast<int>(kept);
}

template <class Real>
template <class Struck, class Visit>
void Contact<Real>::for_each_struck(const VectorField<Real>& position,
                                    const std::vector<TileSolidPair>& pairs, Struck struck, Visit visit) {
  const Grid& grid = position.grid();
  const kernels::Components<const Real> nodes = kernels::components(position);
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    while (end < pairs.size() && pairs[end].tile == pairs[begin].tile) ++end;
    const Tile& tile = broad_phase_.tiles()[static_cast<std::size_t>(pairs[begin].tile)];
    ++counters_.tiles_examined;
    // A border node that two tiles share is looked at in the one below or to the right, whose box holds it as
    // well.
    const int rows = (tile.row_end == grid.rows ? tile.row_end : tile.row_end - 1) - tile.row_begin;
    const int cols = (tile.col_end == grid.cols ? tile.col_end : tile.col_end - 1) - tile.col_begin;
    const std::size_t first = grid.index(tile.row_begin, tile.col_begin);
    const kernels::NodeBlock<Real> block{nodes + first, rows, grid.stride, cols};
    std::uint32_t rows_found = 0;
    for (std::size_t i = begin; i < end; ++i) rows_found |= struck(pairs[i], block, first);
    counters_.nodes_tested += static_cast<std::uint64_t>(rows * cols);
    for (int r = 0; r < rows; ++r) {
      if ((rows_found >> r & 1U) == 0) continue;
      for (int c = 0; c < cols; ++c) visit(tile.row_begin + r, tile.col_begin + c);
    }
  }
}

template class Contact<float>;
template class Contact<double>;

}  // namespace weft
