#include "cloth/forces/soft_pins.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

bool is_same(const Waypoint& a, const Waypoint& b) { return a.time == b.time && a.position == b.position; }

bool is_same(const PoseWaypoint& a, const PoseWaypoint& b) {
  return a.time == b.time && a.pose.position == b.pose.position &&
         a.pose.orientation.coeffs() == b.pose.orientation.coeffs();
}

bool is_same(const PinRegion& a, const PinRegion& b) {
  const auto same = [](const auto& one, const auto& other) {
    return std::equal(one.begin(), one.end(), other.begin(), other.end(),
                      [](const auto& x, const auto& y) { return is_same(x, y); });
  };
  return a.u_min == b.u_min && a.u_max == b.u_max && a.v_min == b.v_min && a.v_max == b.v_max &&
         a.from == b.from && a.until == b.until && a.stiffness == b.stiffness && a.obstacle == b.obstacle &&
         a.ball == b.ball && a.loop == b.loop && same(a.path, b.path) && same(a.motion, b.motion);
}

/// The solid that yields and has the region's places; the end if there is none.
auto body_of(const PinRegion& region, auto& solids) {
  if (!region.obstacle && !region.ball) return solids.end();
  const ColliderId id = collider_of(region);
  return std::find_if(solids.begin(), solids.end(),
                      [&](const Solid& each) { return each.id == id && each.yields(); });
}

}  // namespace

template <class Real>
SoftPins<Real>::SoftPins(const std::vector<PinRegion>& regions, double time, const Particles<Real>& particles,
                         const SoftPins* before) {
  const Grid& grid = particles.grid();
  const Real* mass = particles.mass.row(0);
  const auto stride = static_cast<std::size_t>(grid.stride);
  for (const PinRegion& region : regions) {
    Held held{region, {}, {}};
    const Held* had = before == nullptr ? nullptr : before->of(region);
    held.places = had == nullptr ? PinPlaces(region, time, particles) : had->places;
    double sum = 0;
    const std::vector<std::size_t> nodes = nodes_of(region, grid);
    for (const std::size_t node : nodes) sum += double(mass[node]);
    for (const std::size_t node : nodes) {
      const std::size_t row = node / stride, col = node % stride;
      const double u = double(col) / (grid.cols - 1), v = double(row) / (grid.rows - 1);
      held.springs.push_back(
          {node, region.stiffness.value_or(0) * double(mass[node]) / sum, held.places.stencil(u, v)});
    }
    held_.push_back(std::move(held));
  }
}

template <class Real>
auto SoftPins<Real>::of(const PinRegion& region) const -> const Held* {
  const auto same = std::find_if(held_.begin(), held_.end(),
                                 [&](const Held& held) { return is_same(held.region, region); });
  return same == held_.end() ? nullptr : &*same;
}

template <class Real>
template <class Visit>
void SoftPins<Real>::for_each_spring(const Held& held, const Particles<Real>& particles, double time,
                                     Visit visit) {
  held.places.carry(time);
  const auto nodes = kernels::components(particles.position);
  for (const Spring& spring : held.springs)
    visit(spring, Vec3(held.places.at(spring.place) - particles.place - at<Real>(nodes, spring.node)));
}

template <class Real>
std::vector<BodySpring> SoftPins<Real>::on_bodies(const Particles<Real>& particles,
                                                  const std::vector<Solid>& solids, double time, double dt,
                                                  const Substep& substep) {
  std::vector<BodySpring> springs;
  if (substep.from > 0) {  // the substeps before have bent the solids' ways
    std::vector<Solid> in_world;
    in_world.reserve(solids.size());
    for (const Solid& solid : solids) in_world.push_back(solid.from(-particles.place));
    begin_step(in_world, time, dt);
  }
  const double end = time + substep.to * dt;
  for (const Held& held : held_) {
    const auto solid = body_of(held.region, solids);
    if (solid == solids.end()) continue;
    const Vec3 centre = particles.place + solid->at(substep.to);
    for_each_spring(held, particles, end, [&](const Spring& spring, const Vec3& way) {
      const Vec3 arm = solid->yields_turning() ? Vec3(held.places.at(spring.place) - centre) : Vec3(0, 0, 0);
      springs.push_back(
          {spring.node, static_cast<std::size_t>(solid - solids.begin()), arm, way, spring.stiffness});
    });
  }
  return springs;
}

template <class Real>
void SoftPins<Real>::push(const Particles<Real>& particles, std::vector<Solid>& solids, double time,
                          double dt) const {
  for (const Held& held : held_) {
    const auto solid = body_of(held.region, solids);
    if (solid == solids.end()) continue;
    Vec3 impulse(0, 0, 0), turning(0, 0, 0);
    for_each_spring(held, particles, time, [&](const Spring& spring, const Vec3& way) {
      const Vec3 arm = held.places.at(spring.place) - particles.place - solid->position;
      const Vec3 pull = -dt * spring.stiffness * way;
      impulse += pull;
      turning += arm.cross(pull);
    });
    solid->go_on(solid->velocity + solid->inverse_mass * impulse,
                 solid->spin + solid->inverse_inertia * turning, 1, dt);
  }
}

template <class Real>
void SoftPins<Real>::add_forces(const Particles<Real>& particles, const EffectContext& context,
                                VectorField<Real>& force) const {
  const auto total = kernels::components(force);
  for (const Held& held : held_) {
    for_each_spring(held, particles, context.time, [&](const Spring& spring, const Vec3& way) {
      total.x[spring.node] += static_cast<Real>(spring.stiffness * way.x());
      total.y[spring.node] += static_cast<Real>(spring.stiffness * way.y());
      total.z[spring.node] += static_cast<Real>(spring.stiffness * way.z());
    });
  }
}

template <class Real>
double SoftPins<Real>::tension(const Particles<Real>& particles, const EffectContext& context) const {
  const Vec2& size = context.cloth->size;
  const Grid& grid = particles.grid();
  double sum = 0;
  for (const Held& held : held_) {
    const PinRegion& region = held.region;
    const double width = std::max((region.u_max - region.u_min + 1.0 / (grid.cols - 1)) * size.x(),
                                  (region.v_max - region.v_min + 1.0 / (grid.rows - 1)) * size.y());
    Vec3 force(0, 0, 0);
    for_each_spring(held, particles, context.time,
                    [&](const Spring& spring, const Vec3& way) { force += spring.stiffness * way; });
    sum += force.norm() / width;
  }
  return sum;
}

template <class Real>
double SoftPins<Real>::max_damping_rate(const Particles<Real>& particles, const EffectContext&) const {
  const Real* inverse_mass = particles.inverse_mass.row(0);
  double sum = 0;  // regions may share their nodes
  for (const Held& held : held_) {
    double most = 0;
    for (const Spring& spring : held.springs)
      most = std::max(most, spring.stiffness * double(inverse_mass[spring.node]));
    sum += most;
  }
  return std::sqrt(sum);
}

template <class Real>
void SoftPins<Real>::add_stiffness(const Particles<Real>&, const EffectContext&, Real* stiffness) const {
  for (const Held& held : held_) {
    for (const Spring& spring : held.springs) stiffness[spring.node] += static_cast<Real>(spring.stiffness);
  }
}

template class SoftPins<float>;
template class SoftPins<double>;

}  // namespace weft
