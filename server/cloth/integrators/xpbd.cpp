#include "cloth/integrators/xpbd.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "cloth/core/clock.h"
#include "cloth/core/interrupt.h"
#include "cloth/kernels/limited_kernels.h"
#include "cloth/kernels/torn_kernels.h"

namespace weft {
namespace {

/// As long as the plate lets it be (xpbd.h), s.
template <class Real>
double damping_time(const Particles<Real>& particles, const Forces<Real>& forces, double h) {
  const double time = forces.springs->damping_time();
  if (time <= h || forces.plate == nullptr) return time;
  return forces.plate->max_squared_frequency(particles.mass) * h * h > 4 ? h : time;
}

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
  if (before != times_) {
    const Real share = static_cast<Real>(before) / static_cast<Real>(times_);
    for (Real& each : multiplier_) each *= share * share;  // forces times h^2
  }
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
    if (forces.seam != nullptr) forces.seam->join(particles);
    report.contact_seconds += seconds(Clock::now() - moved);
  }
  return report;
}

template <class Real>
void Xpbd<Real>::prepare(const Particles<Real>& particles, const Forces<Real>& forces, double h) {
  const Grid& grid = particles.grid();
  if (force_.grid() != grid) {
    rounded_off_ = VectorField<Real>(grid);
    lay_out(grid);
    sheet_.assign(layout_.size(), Real(0));
    multiplier_.clear();
  }
  kernels::set_inverse_masses(layout_, grid, particles.inverse_mass.row(0), sheet_.data());
  prepare_springs(*forces.springs, grid, damping_time(particles, forces, h), h);
  if (forces.plate != nullptr) prepare_plate(*forces.plate, h);
  if (forces.soft_pins != nullptr) prepare_soft_pins(*forces.soft_pins, h);
}

template <class Real>
void Xpbd<Real>::lay_out(const Grid& grid) {
  force_ = VectorField<Real>(grid);
  layout_ = kernels::QuarterRows(grid);
  row_.assign(static_cast<std::size_t>(grid.stride), Real(0));
}

template <class Real>
void Xpbd<Real>::keep_multipliers(const std::vector<SpringFamily>& families, std::size_t sheet_lanes) {
  std::vector<std::array<int, 2>> now;  // as the kernels go through them
  for (auto family = families.rbegin(); family != families.rend(); ++family)
    now.push_back({family->rows, family->cols});
  if (!multiplier_.empty() && now == families_) return;
  const auto before = std::exchange(multiplier_, {});
  const auto families_before = std::exchange(families_, now);
  multiplier_.resize(now.size() * sheet_lanes);
  if (before.empty()) return;
  auto block = multiplier_.begin();
  for (const std::array<int, 2>& family : now) {
    const auto same = std::find(families_before.begin(), families_before.end(), family);
    if (same != families_before.end())
      std::copy_n(
          before.begin() + (same - families_before.begin()) * static_cast<std::ptrdiff_t>(sheet_lanes),
          sheet_lanes, block);
    block += static_cast<std::ptrdiff_t>(sheet_lanes);
  }
}

template <class Real>
void Xpbd<Real>::prepare_springs(const Springs<Real>& springs, const Grid& grid, double damping_time,
                                 double h) {
  const std::vector<SpringFamily>& families = springs.families();
  const std::size_t lanes = layout_.stride;
  const int rows = springs.torn() ? grid.rows : 1;
  stiffness_.assign(families.size() * static_cast<std::size_t>(rows) * lanes, Real(0));
  const std::size_t sheet_lanes = lanes * static_cast<std::size_t>(grid.rows);
  if (springs.damping_time() > 0) {
    keep_multipliers(families, sheet_lanes);
  } else {
    multiplier_.clear();
  }
  springs_.clear();
  // Bending, shear, structural: the stiffest have the last word.
  for (auto family = families.rbegin(); family != families.rend(); ++family) {
    Real* stiffness = stiffness_.data() + springs_.size() * static_cast<std::size_t>(rows) * lanes;
    for (int r = 0; r < rows && (rows == 1 || r + family->rows < grid.rows); ++r) {
      for (int c = std::max(0, -family->cols); c + std::max(0, family->cols) < grid.cols; ++c) {
        // Springs that lie in a border row are scaled by the kernel.
        const bool in_border_column = family->cols == 0 && (c == 0 || c == grid.cols - 1);
        const double share = in_border_column ? family->border_share : 1.0;
        if (springs.torn(*family, r, c)) continue;
        stiffness[static_cast<std::size_t>(r) * lanes +
                  static_cast<std::size_t>(layout_.lane(std::min(c, c + family->cols)))] =
            static_cast<Real>(share * family->stiffness * h * h);
      }
    }
    springs_.push_back({family->rows, family->cols, static_cast<Real>(family->rest_length),
                        static_cast<Real>(family->border_share), stiffness,
                        static_cast<Real>(damping_time / h)});
    if (!multiplier_.empty()) {
      springs_.back().multiplier = multiplier_.data() + (springs_.size() - 1) * sheet_lanes;
    }
    springs_.back().row_step = springs.torn() ? static_cast<std::ptrdiff_t>(lanes) : 0;
    if (std::isfinite(family->limit.length)) {
      springs_.back().limit_length = static_cast<Real>(family->limit.length);
      springs_.back().excess = static_cast<Real>(family->limit.stiffening - 1);
    }
  }
}

template <class Real>
void Xpbd<Real>::prepare_plate(const Plate<Real>& plate, double h) {
  plate_.assign(kernels::plate_lanes_size(layout_), Real(0));
  kernels::set_plate_lanes(layout_, plate.grid(), plate.stencils(), static_cast<Real>(h * h), plate_.data());
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
  const bool damped = forces.springs->damping_time() > 0;
  if (damped) {
    take_back_pins(forces, 1, h);
    for (const auto& family : springs_) kernels::recall(layout_, family, sheet_.data());
  }
  if (forces.plate != nullptr) kernels::project_plate(layout_, plate_.data(), sheet_.data());
  for (const auto& family : springs_) {
    const bool torn = family.row_step > 0;
    if (family.excess > Real(0)) {
      (torn ? kernels::project_limited_torn<Real> : kernels::project_limited<Real>)(layout_, family,
                                                                                    sheet_.data());
    } else if (torn) {
      kernels::project_torn(layout_, family, sheet_.data());
    } else {
      kernels::project(layout_, family, sheet_.data());
    }
  }
  if (damped) take_back_pins(forces, -1, h);
  kernels::take_over(layout_, grid, sheet_.data(), static_cast<Real>(h), nodes, row_.data());
}

template class Xpbd<float>;
template class Xpbd<double>;

}  // namespace weft
