#include "cloth/integrators/xpbd.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cloth/core/clock.h"
#include "cloth/core/interrupt.h"

namespace weft {
namespace {

/// From the velocities before the substep, which the accelerations hold, to the mean over the substep.
template <class Real>
void make_acceleration(Particles<Real>& particles, double h) {
  const Real rate = static_cast<Real>(1 / h);
  const auto make = [rate](const Field<Real>& velocity, Field<Real>& acceleration) {
    std::transform(velocity.values().begin(), velocity.values().end(), acceleration.values().begin(),
                   acceleration.values().begin(),
                   [rate](Real after, Real before) { return (after - before) * rate; });
  };
  make(particles.velocity.x, particles.acceleration.x);
  make(particles.velocity.y, particles.acceleration.y);
  make(particles.velocity.z, particles.acceleration.z);
}

}  // namespace

int substeps(const XpbdDescription& description, double dt) {
  if (description.substeps > 0) return description.substeps;
  constexpr double kSpread = 0.1;  // of a substep, over the others
  return std::max(1, static_cast<int>(std::ceil(dt / description.longest_substep - kSpread)));
}

template <class Real>
AdvanceReport Xpbd<Real>::advance(Particles<Real>& particles, Forces<Real> forces, Contact<Real>* contact,
                                  std::vector<Solid>& solids, double time, double dt) {
  AdvanceReport report;
  const int described = substeps(description_, dt), before = times_;
  times_ = refinement_.begin_step(particles, forces, contact, solids, dt / described, dt);
  report.substeps = described * times_;
  const double h = dt / report.substeps;
  prepare(particles, forces, h);
  if (before != times_) projection_.scale_substep(static_cast<Real>(before) / static_cast<Real>(times_));
  // Explicit drag reverses velocities where its rate exceeds 1/h: forces are then scaled so that it stops
  // them at most, which leaves every terminal velocity as it is.
  const double rate = forces.max_damping_rates(particles, forces.soft_pins).sum();
  const double force_share = rate * h > 1 ? 1 / (rate * h) : 1;
  forces.context.damping_limit = std::max(rate, 1 / h);
  for (int s = 0; s < report.substeps; ++s) {
    check_interrupt(static_cast<double>(particles.grid().size()));
    const auto begin = Clock::now();
    forces.context.time = time + s * h;
    forces.carry_pins(particles, time + (s + 1) * h);
    const bool last = s + 1 == report.substeps;
    if (last) particles.acceleration = particles.velocity;
    substep(particles, forces, force_share, h);
    forces.close(particles, time + (s + 1) * h, h);
    if (last) make_acceleration(particles, h);
    const auto moved = Clock::now();
    report.forces_seconds += seconds(moved - begin);
    if (forces.layers != nullptr) forces.layers->resolve(particles, Substep::of(s, report.substeps, dt));
    if (contact == nullptr) continue;
    report.nodes_in_contact =
        contact->resolve(particles, solids, Substep::of(s, report.substeps, dt), nullptr, &rounded_off_);
    forces.join(particles);
    report.contact_seconds += seconds(Clock::now() - moved);
  }
  if (forces.soft_pins != nullptr) forces.soft_pins->push(particles, solids, time + dt, dt);
  return report;
}

template <class Real>
void Xpbd<Real>::prepare(const Particles<Real>& particles, const Forces<Real>& forces, double h) {
  const Grid& grid = particles.grid();
  if (force_.grid() != grid) {
    rounded_off_ = VectorField<Real>(grid);
    lay_out(grid);
    sheet_.assign(layout_.size(), Real(0));
    projection_.restart();
  }
  kernels::set_inverse_masses(layout_, grid, particles.inverse_mass.row(0), sheet_.data());
  projection_.prepare(*forces.sheet, particles.mass, layout_, h);
  if (forces.soft_pins != nullptr) prepare_soft_pins(*forces.soft_pins, h);
}

template <class Real>
void Xpbd<Real>::lay_out(const Grid& grid) {
  force_ = VectorField<Real>(grid);
  layout_ = kernels::QuarterRows(grid);
  row_.assign(static_cast<std::size_t>(grid.stride), Real(0));
}

template <class Real>
void Xpbd<Real>::prepare_soft_pins(const SoftPins<Real>& pins, double h) {
  soft_shares_.clear();
  pins.for_each_stiffness([&](std::size_t node, double stiffness) {
    Real& inverse_mass = lane_of(node)[kernels::QuarterRows::kInverseMass * layout_.stride];
    const double ratio = stiffness * h * h * double(inverse_mass);
    inverse_mass = static_cast<Real>(double(inverse_mass) / (1 + ratio));
    soft_shares_.push_back(ratio / (1 + ratio));
  });
}

template <class Real>
void Xpbd<Real>::draw_to_soft_pins(const SoftPins<Real>& pins, const Vec3& place, double time) {
  auto share = soft_shares_.begin();
  pins.for_each_place(time, [&](std::size_t node, const Vec3& to) {
    Real* lane = lane_of(node);
    for (const int component : {0, 1, 2}) {
      Real& move = lane[kernels::QuarterRows::kMove * layout_.stride];
      move += static_cast<Real>(*share * (to[component] - place[component] - double(lane[0]) - double(move)));
      lane += layout_.stride;
    }
    ++share;
  });
}

template <class Real>
Real* Xpbd<Real>::lane_of(std::size_t node) {
  const auto stride = static_cast<std::size_t>(force_.grid().stride);
  return sheet_.data() + node / stride * layout_.row_size() +
         static_cast<std::size_t>(layout_.lane(static_cast<int>(node % stride)));
}

template <class Real>
void Xpbd<Real>::take_back_pins(const Forces<Real>& forces, double share, double h) {
  const double begin = forces.context.time;
  forces.for_each_pin_way(begin, begin + h, [&](std::size_t node, const Vec3& way) {
    Real* lane = lane_of(node);
    for (const int component : {0, 1, 2}) {
      const Real part = static_cast<Real>(share * way[component]);
      lane[0] -= part;
      lane[kernels::QuarterRows::kMove * layout_.stride] += part;
      lane += layout_.stride;
    }
  });
}

template <class Real>
void Xpbd<Real>::substep(Particles<Real>& particles, const Forces<Real>& forces, double force_share,
                         double h) {
  const Grid& grid = particles.grid();
  forces.sum_effects(particles, force_, forces.soft_pins);
  const kernels::XpbdNodes<Real> nodes{kernels::components(std::as_const(force_)),
                                       particles.inverse_mass.row(0), kernels::components(particles.velocity),
                                       kernels::components(particles.position),
                                       kernels::components(rounded_off_)};
  kernels::predict(layout_, grid, nodes, static_cast<Real>(force_share * h), static_cast<Real>(h),
                   sheet_.data(), row_.data());
  if (forces.soft_pins != nullptr)
    draw_to_soft_pins(*forces.soft_pins, particles.place, forces.context.time + h);
  const bool damped = forces.sheet->damped();
  if (damped) {
    take_back_pins(forces, 1, h);
    projection_.recall(sheet_.data());
  }
  projection_.project(sheet_.data());
  if (damped) take_back_pins(forces, -1, h);
  kernels::take_over(layout_, grid, sheet_.data(), static_cast<Real>(h), nodes, row_.data());
}

template class Xpbd<float>;
template class Xpbd<double>;

}  // namespace weft
