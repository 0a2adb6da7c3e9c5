#include "cloth/integrators/symplectic_euler.h"

#include <algorithm>
#include <cmath>

#include "cloth/clock.h"
#include "cloth/kernels/node_kernels.h"
#include "cloth/solver/node_vector.h"

namespace weft {
namespace {

/// In substeps. Where a spring passes its limit its frequency jumps, and with it what symplectic Euler keeps
/// instead of the energy: without damping a sheet that rings about its limits gains without bound. With this
/// much a sheet let go at 1.055 or 1.1 times its size, limit 1.05, never has more than it began with (20 s).
constexpr double kLimitDamping = 0.25;

/// Eq. 6.
template <class Real>
void update(Particles<Real>& particles, const VectorField<Real>& force, double h) {
  kernels::euler_update(
      {kernels::components(force), particles.inverse_mass.row(0), kernels::components(particles.acceleration),
       kernels::components(particles.velocity), kernels::components(particles.position)},
      static_cast<Real>(h), particles.grid().size());
}

}  // namespace

int stable_substeps(double squared_frequency, double damping_rate, double dt, double safety) {
  const double limit = 4 * safety * safety;
  const auto stable = [&](int n) {
    const double h = dt / n;
    return squared_frequency * h * h + 2 * damping_rate * h <= limit;
  };
  // The positive root of w2 h^2 + 2 c h = limit, in the form that loses no digits for small w2; the
  // comparison itself decides, so that rounding of the root cannot.
  const double h =
      limit / (damping_rate + std::sqrt(damping_rate * damping_rate + squared_frequency * limit));
  const double estimate = std::ceil(dt / h);
  if (!(estimate < kMaxSubsteps)) return kMaxSubsteps;
  int n = std::max(1, static_cast<int>(estimate));
  while (n > 1 && stable(n - 1)) --n;
  while (n < kMaxSubsteps && !stable(n)) ++n;
  return n;
}

template <class Real>
AdvanceReport SymplecticEuler<Real>::advance(Particles<Real>& particles, Forces<Real> forces,
                                             Contact<Real>* contact, std::vector<Solid>& solids, double time,
                                             double dt) {
  if (force_.grid() != particles.grid()) force_ = VectorField<Real>(particles.grid());
  AdvanceReport report;
  double squared_frequency = forces.springs->max_squared_frequency(particles.mass);
  if (forces.springs->limited()) squared_frequency *= 1 + 2 * kLimitDamping;
  const double rate = forces.max_damping_rate(particles) + forces.springs->max_damping_rate(particles.mass);
  if (forces.plate != nullptr) squared_frequency += forces.plate->max_squared_frequency(particles.mass);
  report.substeps = description_.substeps > 0
                        ? description_.substeps
                        : stable_substeps(squared_frequency, rate, dt, description_.safety);
  const double h = dt / report.substeps;
  if (description_.substeps == 0 && !(squared_frequency * h * h + 2 * rate * h <= 4)) {
    report.sound = false;  // not even the most substeps are stable
    return report;
  }
  // What the rate may grow to within this step: half of the room that the springs leave.
  forces.context.damping_limit = std::max(rate, (4 - squared_frequency * h * h) / (4 * h));
  for (int s = 0; s < report.substeps; ++s) {
    const auto begin = Clock::now();
    forces.context.time = time + s * h;
    forces.carry_pins(particles, time + (s + 1) * h);
    forces.sum(particles, force_);
    if (forces.springs->damping_time() > 0) add_damping(particles, forces, h);
    if (forces.springs->limited()) {
      forces.springs->add_limit_damping(particles.position, particles.velocity, kLimitDamping * h, force_);
    }
    update(particles, force_, h);
    forces.close(particles, time + (s + 1) * h, h);
    const auto moved = Clock::now();
    report.forces_seconds += seconds(moved - begin);
    if (forces.layers != nullptr) forces.layers->resolve(particles, Substep::of(s, report.substeps, dt));
    if (contact == nullptr) continue;
    report.nodes_in_contact = contact->resolve(particles, solids, Substep::of(s, report.substeps, dt));
    if (forces.seam != nullptr) forces.seam->join(particles);
    report.contact_seconds += seconds(Clock::now() - moved);
  }
  return report;
}

template <class Real>
void SymplecticEuler<Real>::add_damping(Particles<Real>& particles, const Forces<Real>& forces, double h) {
  const kernels::Components<Real> velocity = kernels::components(particles.velocity);
  // The update takes it from them again.
  forces.for_each_pin_way(forces.context.time, forces.context.time + h,
                          [&](std::size_t node, const Vec3& way) { add<Real>(velocity, node, way / h); });
  forces.springs->add_damping(particles.position, velocity, force_);
}

template class SymplecticEuler<float>;
template class SymplecticEuler<double>;

}  // namespace weft
