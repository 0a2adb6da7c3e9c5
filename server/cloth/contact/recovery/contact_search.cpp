/// What a contact finds and leaves as it is: nodes in solids, on ways into them and near them.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "cloth/contact/recovery/contact.h"
#include "cloth/contact/recovery/struck_rows.h"
#include "cloth/core/interrupt.h"
#include "cloth/kernels/node_kernels.h"

namespace weft {
namespace {

bool stands_firm(const Solid& solid) { return !solid.yields(); }

bool is_any(const Solid&) { return true; }

std::vector<PlacedShape> placed_at(const std::vector<Solid>& solids, double fraction) {
  std::vector<PlacedShape> placed;
  placed.reserve(solids.size());
  for (const Solid& solid : solids) placed.push_back(solid.placed(fraction));
  return placed;
}

}  // namespace

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
  find_inside(particles, particles.position, solids, substep, is_any, inside_);
  return inside_;
}

template <class Real>
void Contact<Real>::find_inside(const Particles<Real>& particles, const VectorField<Real>& position,
                                const std::vector<Solid>& solids, const Substep& substep,
                                bool (*sought)(const Solid&), std::vector<Touch>& found) {
  const Sweep sweep{substep.to, substep.to, 0};
  const std::vector<PlacedShape> placed = placed_at(solids, substep.to);
  const std::vector<TileSolidPair>& pairs = broad_phase_.find_pairs(position, solids, sweep);
  for_each_struck(
      position, broad_phase_.tiles(), pairs, counters_,
      [&](const TileSolidPair& pair, const kernels::NodeBlock<Real>& block, std::size_t) {
        const auto i = static_cast<std::size_t>(pair.solid);
        return sought(solids[i]) ? rows_inside(block, placed[i]) : std::uint32_t{0};
      },
      [&](int row, int col, std::span<const std::size_t> met) {
        if (particles.inverse_mass.at(row, col) == Real(0)) return;
        const Vec3 place(double(position.x.at(row, col)), double(position.y.at(row, col)),
                         double(position.z.at(row, col)));
        for (const std::size_t i : met) {
          if (placed[i].contains(place)) found.push_back({particles.grid().index(row, col), solids[i].id});
        }
      });
  for (const NearPoint& near : points_near(particles, position, pairs, solids, sweep)) {
    const Solid& solid = solids[near.solid];
    const Vec3 place = ClothPoint<Real>(near.point, particles).of(kernels::components(position));
    if (!sought(solid) || !placed[near.solid].contains(place)) continue;
    found.push_back({near.point.node, solid.id, near.point.within});
  }
  check_interrupt(kWorkOfContact * static_cast<double>(found.size()));
}

template <class Real>
const std::vector<Arrival>& Contact<Real>::foresee(const Particles<Real>& particles,
                                                   const VectorField<Real>& velocity,
                                                   const std::vector<Solid>& solids, const Substep& substep,
                                                   bool (*sought)(const Solid&)) {
  arrivals_.clear();
  if (std::none_of(solids.begin(), solids.end(), sought)) return arrivals_;
  const double h = substep.seconds;
  const kernels::Components<const Real> v = kernels::components(velocity);
  const double longest =
      h * std::sqrt(kernels::largest_square(v, v, Real(1), Real(0), particles.grid().size()));
  find_arrivals(
      particles, particles.position, Way<Real>::by(velocity, h), longest, 0,
      [&](const auto& value) { return Vec3(h * value(v)); }, solids, substep, sought);
  return arrivals_;
}

template <class Real>
const std::vector<Arrival>& Contact<Real>::passed(const Particles<Real>& particles,
                                                  const VectorField<Real>& start,
                                                  const std::vector<Solid>& solids, const Substep& substep) {
  arrivals_.clear();
  const Way<Real> ends = Way<Real>::to(particles.position);
  const double longest = ends.longest(start);
  const auto is_fast = [&](const Solid& solid) {
    return longest + sweep_of(solid, substep) > kSlowMove * inner_radius(solid.shape);
  };
  if (std::none_of(solids.begin(), solids.end(), is_fast)) return arrivals_;
  const kernels::Components<const Real> from = kernels::components(start),
                                        to = kernels::components(particles.position);
  find_arrivals(
      particles, start, ends, longest, kSlowMove,
      [&](const auto& value) { return Vec3(value(to) - value(from)); }, solids, substep, is_fast);
  return arrivals_;
}

template <class Real>
template <class Ends, class Way, class Sought>
void Contact<Real>::find_arrivals(const Particles<Real>& particles, const VectorField<Real>& position,
                                  const Ends& ends, double longest, double share, Way way_of,
                                  const std::vector<Solid>& solids, const Substep& substep, Sought sought) {
  const kernels::Components<const Real> nodes = kernels::components(position);
  const Sweep sweep{substep.from, substep.to, longest};
  const std::vector<PlacedShape> placed = placed_at(solids, substep.to);
  std::vector<RigidMove> moves;
  moves.reserve(solids.size());
  for (const Solid& solid : solids) moves.push_back(solid.move(substep.from, substep.to));
  const std::vector<TileSolidPair>& pairs = broad_phase_.find_pairs(position, solids, sweep);
  const auto look = [&](const PointId& id, const Vec3& place, const Vec3& way, std::size_t i) {
    const Solid& solid = solids[i];
    // As seen from the solid where it will be.
    const PlacedShape& shape = placed[i];
    const Vec3 begin =
        moves[i].turns ? Vec3(place + moves[i].of(place)) : Vec3(place + shape.centre - moves[i].centre);
    const Vec3 end = place + way;
    const double shortest = share * inner_radius(solid.shape);
    const double square = (end - begin).squaredNorm();
    if (square < shortest * shortest || !shape.may_touch(begin, std::sqrt(square))) return;
    const std::optional<Hit> hit = shape.contains(begin) ? std::nullopt : shape.first_hit(begin, end);
    if (!hit) return;
    const double inward = (end - begin).dot(hit->normal);
    arrivals_.push_back({{id.node, solid.id, id.within},
                         i,
                         {(1 - hit->fraction) * inward, hit->normal},
                         -inward / substep.seconds});
  };
  for_each_struck(
      position, broad_phase_.tiles(), pairs, counters_,
      [&](const TileSolidPair& pair, const kernels::NodeBlock<Real>& block, std::size_t first) {
        const Solid& solid = solids[static_cast<std::size_t>(pair.solid)];
        if (!sought(solid)) return std::uint32_t{0};
        const auto* sphere = std::get_if<Sphere>(&solid.shape);
        if (sphere == nullptr)
          return rows_near_way(block, solid, placed[static_cast<std::size_t>(pair.solid)], substep, longest);
        // The kernel looks at the way back: from where node and ball will be to where they are.
        const Vec3 place = solid.at(substep.from), back = place - solid.at(substep.to);
        return kernels::rows_swept(block, {ends.other + first, ends.own, ends.factor},
                                   {back.x(), back.y(), back.z()},
                                   {place.x(), place.y(), place.z(), sphere->radius * sphere->radius});
      },
      [&](int row, int col, std::span<const std::size_t> met) {
        if (particles.inverse_mass.at(row, col) == Real(0)) return;
        const std::size_t node = particles.grid().index(row, col);
        const Vec3 way = way_of([&](const kernels::Components<const Real>& c) { return at(c, node); });
        for (const std::size_t i : met) look({node}, at(nodes, node), way, i);
      });
  for (const NearPoint& near : points_near(particles, position, pairs, solids, sweep)) {
    if (!sought(solids[near.solid])) continue;
    const ClothPoint<Real> point(near.point, particles);
    const Vec3 way = way_of([&](const kernels::Components<const Real>& c) { return point.of(c); });
    look(near.point, point.of(nodes), way, near.solid);
  }
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
      particles.position, broad_phase_.tiles(), pairs, counters_,
      [&](const TileSolidPair& pair, const kernels::NodeBlock<Real>& block, std::size_t) {
        const Solid& solid = solids[static_cast<std::size_t>(pair.solid)];
        if (!solid.yields()) return std::uint32_t{0};
        // Whatever bends its way may turn it, too.
        const double way = (solid.at(step.to) - solid.at(step.from)).norm() + reach;
        return kernels::rows_inside(
            block, sphere_of(solid.placed(step.to), Sphere{outer_radius(solid.shape) + way}));
      },
      [&](int row, int col, std::span<const std::size_t> met) {
        if (particles.inverse_mass.at(row, col) != Real(0)) return;
        const Vec3 place = particles.local_position_at(row, col);
        for (const std::size_t i : met) {
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

template const std::vector<Touch>& Contact<float>::expect(const Particles<float>&, const std::vector<Solid>&,
                                                          const Substep&);
template const std::vector<Touch>& Contact<float>::inside(const Particles<float>&, const std::vector<Solid>&,
                                                          const Substep&);
template const std::vector<Arrival>& Contact<float>::foresee(const Particles<float>&,
                                                             const VectorField<float>&,
                                                             const std::vector<Solid>&, const Substep&,
                                                             bool (*)(const Solid&));
template const std::vector<Arrival>& Contact<float>::passed(const Particles<float>&,
                                                            const VectorField<float>&,
                                                            const std::vector<Solid>&, const Substep&);
template void Contact<float>::find_inside(const Particles<float>&, const VectorField<float>&,
                                          const std::vector<Solid>&, const Substep&, bool (*)(const Solid&),
                                          std::vector<Touch>&);
template std::vector<NearPoint> Contact<float>::pinned_near(const Particles<float>&,
                                                            const std::vector<Solid>&, double);
template const std::vector<Touch>& Contact<double>::expect(const Particles<double>&,
                                                           const std::vector<Solid>&, const Substep&);
template const std::vector<Touch>& Contact<double>::inside(const Particles<double>&,
                                                           const std::vector<Solid>&, const Substep&);
template const std::vector<Arrival>& Contact<double>::foresee(const Particles<double>&,
                                                              const VectorField<double>&,
                                                              const std::vector<Solid>&, const Substep&,
                                                              bool (*)(const Solid&));
template const std::vector<Arrival>& Contact<double>::passed(const Particles<double>&,
                                                             const VectorField<double>&,
                                                             const std::vector<Solid>&, const Substep&);
template void Contact<double>::find_inside(const Particles<double>&, const VectorField<double>&,
                                           const std::vector<Solid>&, const Substep&, bool (*)(const Solid&),
                                           std::vector<Touch>&);
template std::vector<NearPoint> Contact<double>::pinned_near(const Particles<double>&,
                                                             const std::vector<Solid>&, double);

}  // namespace weft
