#include "cloth/integrators/energy_ledger.h"

#include <algorithm>
#include <cmath>

#include "cloth/kernels/implicit_kernels.h"
#include "cloth/kernels/node_kernels.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/motion.h"

namespace weft {
namespace {

/// The largest part of the motion's energy that a step gives back or takes.
constexpr double kMostChange = 0.5;
/// The largest part of the energy that the motion had of late that stays to be given or taken.
constexpr double kMostOwed = 0.4;
/// Seconds in which what the motion had of late falls to 1/e.
constexpr double kOfLate = 1;
/// Of what gravity gives in a step: of a motion so slow a half is left as it is, of a slower one more.
constexpr double kSlowStep = 0.02;
/// Of what the motion loses in wind.
constexpr double kKeptInWind = 0.5;

/// The energy of the speed that gravity gives a cloth at rest in a step of `dt` seconds, J.
template <class Real>
double gravity_gives(const Particles<Real>& particles, double dt) {
  const double speed = standard_gravity().norm() * dt;
  return total_mass(particles) * speed * speed / 2;
}

}  // namespace

template <class Real>
double EnergyLedger<Real>::height(const Particles<Real>& particles, const Forces<Real>& forces,
                                  double before) {
  if (before == 0) return forces.effects_energy(particles);
  Particles<Real> behind = particles;
  kernels::add_scaled(kernels::components(behind.position), kernels::components(particles.velocity),
                      static_cast<Real>(-before), particles.grid().size());
  return forces.effects_energy(behind);
}

template <class Real>
double EnergyLedger<Real>::kept_share(const Particles<Real>& particles, double motion, double dt) const {
  return motion / (motion + kSlowStep * kSlowStep * gravity_gives(particles, dt));
}

template <class Real>
void EnergyLedger<Real>::begin_step(const Particles<Real>& particles, const Forces<Real>& forces,
                                    double lead) {
  lead_ = lead;
  books_ = forces.sheet->torn() == nullptr && forces.layers == nullptr;
  work_ = work_whole_ = taken_ = led_out_ = 0;
  if (forces.disturbed || (account_ && account_->drive != forces.drive)) account_.reset();
  if (forces.drive == Drive::other || account_) return;
  const double springs = forces.sheet->energy(particles.position);
  const double now = motion_energy(particles).beside_centre + springs;
  const double now_whole = motion_energy(particles, Freedom::none()).inner + springs;
  // Beside the centre of mass gravity has none, and it is the only effect with any.
  account_ = {.drive = forces.drive,
              .most = is_held(particles) ? now + height(particles, forces, 0) : now,
              .most_whole = now_whole + height(particles, forces, lead_),
              .now = now,
              .now_whole = now_whole};
}

template <class Real>
void EnergyLedger<Real>::count_work(const Particles<Real>& particles, const Forces<Real>& forces,
                                    const Ways& ways) {
  if (!counts()) return;
  const Grid& grid = particles.grid();
  if (force_.grid() != grid) force_ = way_ = VectorField<Real>(grid);
  forces.sum_effects(particles, force_);
  if (ways.dampers != nullptr) {
    forces.sheet->add_damping_of_way(particles.position, kernels::components(*ways.dampers), ways.h, force_);
  }
  const kernels::Components<Real> way = kernels::components(way_);
  kernels::scaled_difference<Real>(kernels::components(particles.position), kernels::components(ways.start),
                                   Real(1), way, grid.size());
  if (ways.lead != nullptr) {
    const Real* lead = ways.lead->row(0);
    const auto was = kernels::components(ways.start_velocity), is = kernels::components(particles.velocity);
    for (std::size_t i = 0; i < grid.size(); ++i) {
      way.x[i] -= lead[i] * (is.x[i] - was.x[i]);
      way.y[i] -= lead[i] * (is.y[i] - was.y[i]);
      way.z[i] -= lead[i] * (is.z[i] - was.z[i]);
    }
  }
  work_whole_ += work_beside_centre(particles, force_, way_, true);
  if (!is_held(particles)) work_ += work_beside_centre(particles, force_, way_, false);
}

template <class Real>
double EnergyLedger<Real>::end_step(Particles<Real>& particles, const Forces<Real>& forces, double dt,
                                    bool touched, const Freedom& freedom, AdvanceReport& report) {
  if (!account_) return 1;
  Account& account = *account_;
  const bool pinned = is_held(particles), leans = touched && !pinned, firm = touched || pinned;
  const MotionEnergy motion = motion_energy(particles, freedom);
  const double springs = forces.sheet->energy(particles.position);
  const double now =
      (firm ? motion_energy(particles, Freedom::none()).inner : motion.beside_centre) + springs;
  account.motion = std::max(motion.inner, account.motion * std::exp(-dt / kOfLate));
  const double work = firm ? work_whole_ : work_;
  double lost = (firm ? account.now_whole : account.now) + work - taken_ - now;
  if (!books_) lost = account.owed = 0;
  const double owed = account.owed;
  account.owed += lost - std::clamp(lost, -led_out_, led_out_);
  const bool wind = account.drive == Drive::wind;
  const double kept =
      account.owed > 0 ? kept_share(particles, account.motion, dt) * (wind ? kKeptInWind : 1) : 1;
  account.owed *= liveliness_ * kept;
  const double most = kMostChange * motion.inner, most_owed = kMostOwed * account.motion;
  double change = std::clamp(account.owed, -most, most);
  if (!wind) {
    account.most += led_out_;
    account.most_whole += led_out_;
    const double room = leans    ? account.most_whole - now - height(particles, forces, lead_)
                        : pinned ? account.most - now - height(particles, forces, 0)
                                 : account.most - now;
    change = std::min(change, room);
  }
  // Where a motion turns it is about as slow as what gravity gives in a step, and loses less than that. More
  // is lost by folds that the step does not resolve.
  const double may_owe = std::min(most_owed, std::max(0.0, owed) + gravity_gives(particles, dt));
  account.owed = std::clamp(account.owed - change, -most_owed, leans ? 0 : may_owe);
  report.effects_work = work;
  report.contact_took = taken_;
  report.energy_lost = lost;
  report.energy_given_back = change;
  const double scale = add_to_motion(particles, change, freedom);
  (firm ? account.now_whole : account.now) = now + change;
  if (pinned) {
    account.now = account.now_whole;
  } else if (leans) {
    account.most = account.now = motion_energy(particles, Freedom::all()).beside_centre + springs;
  } else {
    account.now_whole = motion_energy(particles, Freedom::none()).inner + springs;
  }
  return scale;
}

template class EnergyLedger<float>;
template class EnergyLedger<double>;

}  // namespace weft
