#include "criteria.h"

#include <algorithm>
#include <cmath>

#include "cloth/integrators/softened_springs.h"
#include "cloth/sheet/diagnostics.h"

namespace weft::stability {
namespace {

/// Calls visit(one end, the other, strain) for each structural spring.
template <class Visit>
void for_each_spring(const Cloth<float>& cloth, Visit visit) {
  const Particles<float>& state = cloth.particles();
  const Grid& grid = state.grid();
  for (const SpringFamily& family : cloth.springs().families()) {
    if (family.rows + std::abs(family.cols) != 1) continue;  // structural ones join neighbours
    for (int r = 0; r + family.rows < grid.rows; ++r) {
      for (int c = 0; c + family.cols < grid.cols; ++c) {
        if (cloth.springs().torn(family, r, c)) continue;
        const Vec3 one = state.position_at(r, c);
        const Vec3 other = state.position_at(r + family.rows, c + family.cols);
        visit(one, other, (one - other).norm() / family.rest_length - 1);
      }
    }
  }
}

void read_springs(const Cloth<float>& cloth, Reading& reading) {
  for_each_spring(cloth, [&](const Vec3&, const Vec3&, double strain) {
    reading.stretch = std::max(reading.stretch, strain);
    reading.compression = std::max(reading.compression, -strain);
  });
}

void read_nodes(const Cloth<float>& cloth, const std::vector<Solid>& solids, Reading& reading) {
  const Particles<float>& state = cloth.particles();
  for (int r = 0; r < state.grid().rows; ++r) {
    for (int c = 0; c < state.grid().cols; ++c) {
      reading.speed = std::max(reading.speed, state.velocity_at(r, c).norm());
      if (state.inverse_mass.at(r, c) == 0) continue;  // pinned nodes stay where they are
      for (const Solid& each : solids) {
        reading.penetration = std::max(reading.penetration, depth(each, state.position_at(r, c)));
      }
    }
  }
}

/// Of springs and plate. Springs that an implicit step softens (softened_springs.h) give back no more than
/// they then hold.
double elastic_energy(const Simulation<float>& simulation, const Cloth<float>& cloth) {
  const SimulationDescription& scene = simulation.description();
  const auto* backward_euler = std::get_if<BackwardEulerDescription>(&scene.integrator);
  const auto* bdf2 = std::get_if<Bdf2Description>(&scene.integrator);
  const Particles<float>& state = cloth.particles();
  const double whole = cloth.elastic_energy();
  if (backward_euler == nullptr && bdf2 == nullptr) return whole;
  const int substeps = bdf2 != nullptr ? bdf2->substeps : backward_euler->substeps;
  const auto soft =
      softened_springs(cloth.springs(), cloth.description(), state.mass, scene.time_step / substeps);
  return soft ? whole - cloth.springs().energy(state.position) + soft->energy(state.position) : whole;
}

/// Of a body, J.
double kinetic(const Obstacle& obstacle) {
  const RigidBody& body = *obstacle.body;
  const Vec3 spin = body.spin(obstacle.pose.orientation);
  return body.mass() * body.velocity().squaredNorm() / 2 + spin.dot(body.angular_momentum()) / 2;
}

bool falls(const Ball& ball) { return ball.motion == BallDescription::Motion::dynamic; }

}  // namespace

Reading read(const Simulation<float>& simulation, bool springs_count) {
  Reading reading;
  const std::vector<Ball>& balls = simulation.colliders().balls();
  for (const Cloth<float>& cloth : simulation.cloths()) {
    const Particles<float>& state = cloth.particles();
    reading.energy += kinetic_energy(state) + gravitational_energy(state, simulation.gravity());
    if (springs_count) reading.energy += elastic_energy(simulation, cloth);
    read_springs(cloth, reading);
    read_nodes(cloth, simulation.colliders().solids(), reading);
  }
  for (const Ball& each : balls) {
    if (!falls(each)) continue;
    reading.energy += each.mass * (each.velocity.squaredNorm() / 2 - simulation.gravity().dot(each.position));
  }
  for (const Obstacle& each : simulation.colliders().obstacles()) {
    if (!each.flies()) continue;
    reading.energy += kinetic(each) - each.body->mass() * simulation.gravity().dot(each.pose.position);
  }
  return reading;
}

bool is_pierced(const Simulation<float>& simulation) {
  constexpr double kInside = 1e-3;  // m
  double most = -1;
  Vec3 middle(0, 0, 0);
  for (const Cloth<float>& cloth : simulation.cloths()) {
    for_each_spring(cloth, [&](const Vec3& one, const Vec3& other, double strain) {
      if (strain <= most) return;
      most = strain;
      middle = (one + other) / 2;
    });
  }
  const std::vector<Solid>& solids = simulation.colliders().solids();
  return std::any_of(solids.begin(), solids.end(),
                     [&](const Solid& solid) { return depth(solid, middle) > kInside; });
}

Complaint guard_complaint(const Simulation<float>& simulation) {
  for (const GuardEvent& event : simulation.guard_events()) {
    if (event.fault != Fault::crowded) return "guard: " + describe(event, "cloth");
  }
  return {};
}

double energy_room(Method method) {
  constexpr double kRoom = 0.01, kModifiedEnergy = 19;
  return method == Method::explicit_fixed || method == Method::symplectic_euler ? kModifiedEnergy - 1 : kRoom;
}

EnergyBound energy_bound(const Simulation<float>& simulation, const Setup& setup, double input) {
  constexpr double kRoundingStrain = 1e-4;
  EnergyBound bound;
  bound.start = read(simulation, true).energy;
  double moving = input, rounding = 0;
  for (const Cloth<float>& cloth : simulation.cloths()) {
    const Particles<float>& state = cloth.particles();
    // Single precision gives any sheet a strain of its own.
    const ClothDescription& made = cloth.description();
    const double stiffness =
        made.material.structural.most() + made.material.shear + 4 * made.material.bending;
    rounding += stiffness * made.size.x() * made.size.y() * kRoundingStrain * kRoundingStrain / 2;
    // Held by an edge it falls by its height, and back up on the other side.
    const double fall = cloth.description().size.norm();
    moving += kinetic_energy(state) + cloth.elastic_energy() +
              cloth.total_mass() * simulation.gravity().norm() * fall;
  }
  for (const Ball& each : simulation.colliders().balls()) {
    if (falls(each))
      moving += each.mass * (each.velocity.squaredNorm() / 2 + simulation.gravity().norm() * kSize);
  }
  for (const Obstacle& each : simulation.colliders().obstacles()) {
    if (each.flies()) moving += kinetic(each) + each.body->mass() * simulation.gravity().norm() * kSize;
  }
  bound.allowed = rounding + input + moving * energy_room(setup.method);
  return bound;
}

double depth(const Solid& solid, const Vec3& point) {
  const PlacedShape placed = solid.placed(1);
  // What is nearest to a point far from a mesh takes long to find.
  return placed.may_touch(point, 0) ? -placed.surface(point).distance : 0;
}

std::vector<Vec3> positions(const Simulation<float>& simulation) {
  std::vector<Vec3> all;
  for (const Cloth<float>& cloth : simulation.cloths()) {
    const Particles<float>& state = cloth.particles();
    for (int r = 0; r < state.grid().rows; ++r) {
      for (int c = 0; c < state.grid().cols; ++c) all.push_back(state.position_at(r, c));
    }
  }
  return all;
}

double movement(const std::vector<Vec3>& before, const std::vector<Vec3>& now) {
  double largest = 0;
  for (std::size_t i = 0; i < now.size(); ++i) largest = std::max(largest, (now[i] - before[i]).norm());
  return largest;
}

double root_mean_square_movement(const std::vector<Vec3>& before, const std::vector<Vec3>& now) {
  double sum = 0;
  for (std::size_t i = 0; i < now.size(); ++i) sum += (now[i] - before[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(now.size()));
}

void EnergyFall::add(double energy) {
  if (seen_ < third_) lowest_first_ = std::min(lowest_first_, energy);
  if (seen_ >= steps_ - third_) highest_last_ = std::max(highest_last_, energy);
  ++seen_;
}

void Jitter::add(std::vector<Vec3> positions) {
  for (std::size_t i = 0; i < before_last_.size(); ++i) {
    largest_ = std::max(largest_, (positions[i] - 2 * last_[i] + before_last_[i]).norm());
  }
  before_last_ = std::move(last_);
  last_ = std::move(positions);
}

}  // namespace weft::stability
