#include "cloth/guard/step_guard.h"

#include <algorithm>
#include <cmath>

#include "cloth/kernels/state_kernels.h"

namespace weft {
namespace {

IntegratorDescription with_more_substeps(const IntegratorDescription& description, int factor) {
  IntegratorDescription more = description;
  if (auto* euler = std::get_if<SymplecticEulerDescription>(&more); euler && euler->substeps == 0) {
    euler->safety /= factor;  // it chooses its substeps itself
    return more;
  }
  if (auto* xpbd = std::get_if<XpbdDescription>(&more); xpbd && xpbd->substeps == 0) {
    xpbd->longest_substep /= factor;
    return more;
  }
  std::visit([factor](auto& each) { each.substeps *= factor; }, more);
  return more;
}

IntegratorDescription backward_euler(int substeps) {
  BackwardEulerDescription description;
  description.substeps = substeps;
  return description;
}

}  // namespace

template <class Real>
void StepGuard<Real>::set_integrator(const IntegratorDescription& own) {
  own_ = own;
  rung_ = last_rung_ = Rung::own;
  limits_ = {};
  freeze_left_ = 0;
  good_steps_ = kHold;
}

template <class Real>
void StepGuard<Real>::enter(const Particles<Real>& particles, const Vec2& cell) {
  cell_ = cell;
  place_ = particles.place;
  position_ = particles.position;
  velocity_ = particles.velocity;
  const Finding finding = look_at(particles);
  sound_ = finding.fault == Fault::none;
  speed_ = finding.speed;
  freeze_left_ = 0;
}

template <class Real>
IntegratorDescription StepGuard<Real>::method() const {
  switch (rung_) {
    case Rung::substeps_4:
      return with_more_substeps(own_, 4);
    case Rung::substeps_16:
      return with_more_substeps(own_, 16);
    case Rung::backward_euler_4:
      return backward_euler(4);
    case Rung::backward_euler_16:
      return backward_euler(16);
    case Rung::own:
      break;
  }
  return own_;
}

template <class Real>
bool StepGuard<Real>::stands_still() {
  if (!frozen_ || freeze_left_ == 0) return false;
  --freeze_left_;
  return true;
}

template <class Real>
auto StepGuard<Real>::find(const Particles<Real>& particles, const AdvanceReport& report) const -> Finding {
  Finding finding = look_at(particles);
  if (finding.fault == Fault::none && !report.sound) finding.fault = Fault::unsolved;
  if (finding.fault == Fault::none && report.gained > report.could_give) {
    finding.fault = Fault::gained;
    finding.value = report.gained;
    finding.limit = report.could_give;
  }
  return finding;
}

template <class Real>
auto StepGuard<Real>::judge(Particles<Real>& particles, const AdvanceReport& report) -> Verdict {
  const Finding finding = find(particles, report);
  if (finding.fault == Fault::none) {
    keep(particles, finding.speed);
    went_well(finding);
    return Verdict::good;
  }
  const bool last = rung_ == Rung::backward_euler_16;
  went_wrong(finding);
  restore(particles);
  return last ? Verdict::stand_still : Verdict::make_again;
}

template <class Real>
void StepGuard<Real>::give_up(Particles<Real>& particles) {
  relapse_ = good_steps_ < kHold;
  good_steps_ = 0;
  limits_ = {};
  trouble_ = {.fault = Fault::too_costly};
  freeze();
  restore(particles);
}

template <class Real>
void StepGuard<Real>::amend(Particles<Real>& particles) {
  const Finding finding = look_at(particles);
  if (finding.fault == Fault::none) {
    keep(particles, finding.speed);
  } else {
    repair(particles);
  }
}

template <class Real>
void StepGuard<Real>::repair(Particles<Real>& particles) {
  const Finding finding = look_at(particles);
  if (finding.fault == Fault::none) return;
  restore(particles);
  trouble_ = finding;
  tell(GuardEvent::Action::redone);
  trouble_ = {};
}

template <class Real>
auto StepGuard<Real>::look_at(const Particles<Real>& particles) const -> Finding {
  const kernels::StateExtremes<Real> most = kernels::state_extremes(
      particles.grid(), kernels::components(particles.position), kernels::components(particles.velocity));
  const double speed = std::sqrt(double(most.speed));
  const double strain =
      std::max(std::sqrt(double(most.along_u)) / cell_.x(), std::sqrt(double(most.along_v)) / cell_.y()) - 1;
  const double sum = double(most.speed) + double(most.along_u) + double(most.along_v);
  if (!std::isfinite(sum)) return {Fault::not_finite, sum, 0, speed, strain};
  if (speed > limits_.speed) return {Fault::too_fast, speed, limits_.speed, speed, strain};
  if (strain > limits_.strain) return {Fault::too_stretched, strain, limits_.strain, speed, strain};
  return {Fault::none, 0, 0, speed, strain};
}

template <class Real>
void StepGuard<Real>::keep(const Particles<Real>& particles, double speed) {
  place_ = particles.place;
  position_ = particles.position;
  velocity_ = particles.velocity;
  sound_ = true;
  speed_ = speed;
}

template <class Real>
void StepGuard<Real>::restore(Particles<Real>& particles) const {
  particles.place = place_;
  particles.position = position_;
  particles.velocity = velocity_;
  particles.acceleration.fill(Real(0));
}

template <class Real>
void StepGuard<Real>::watch_hold(const Finding& finding) {
  // The first half is left out: what had run away comes to its senses there.
  if (hold_left_ == hold_ / 2) trial_limits_ = {kTrialSpeed, kTrialStrain};
  trial_limits_.speed =
      std::clamp(kTrialFactor * finding.speed + kTrialSpeed, trial_limits_.speed, kMostSpeed);
  trial_limits_.strain =
      std::clamp(kTrialFactor * finding.strain + kTrialStrain, trial_limits_.strain, kMostStrain);
}

template <class Real>
void StepGuard<Real>::went_well(const Finding& finding) {
  if (frozen_ || trouble_.fault != Fault::none) {
    if (rung_ != Rung::own) ++counters_.redone[static_cast<std::size_t>(rung_)];
    tell(frozen_ ? GuardEvent::Action::thawed : GuardEvent::Action::redone);
    frozen_ = false;
    trouble_ = {};
    hold_left_ = hold_;
    last_rung_ = rung_;
  }
  if (rung_ == Rung::own) {
    good_steps_ = std::min(good_steps_ + 1, kHold);
    if (good_steps_ == kHold) limits_ = {};
    return;
  }
  watch_hold(finding);
  if (hold_left_-- > 0) return;
  rung_ = Rung::own;
  limits_ = trial_limits_;
}

template <class Real>
void StepGuard<Real>::went_wrong(const Finding& finding) {
  if (trouble_.fault == Fault::none) {
    trouble_ = finding;
    relapse_ = good_steps_ < kHold;
    hold_ = relapse_ ? std::min(2 * hold_, kLongestHold) : kHold;
    good_steps_ = 0;
    limits_ = {};
    if (relapse_ && last_rung_ > rung_) {
      rung_ = last_rung_;
      return;
    }
  }
  if (rung_ == Rung::backward_euler_16) return freeze();
  rung_ = static_cast<Rung>(static_cast<int>(rung_) + 1);
}

template <class Real>
void StepGuard<Real>::freeze() {
  if (!frozen_) {
    ++counters_.frozen;
    tell(GuardEvent::Action::frozen);
  }
  frozen_ = true;
  freeze_ = relapse_ ? std::min(2 * freeze_, kLongestFreeze) : 1;
  freeze_left_ = freeze_;
  rung_ = Rung::own;
  trouble_ = {};
  velocity_.fill(Real(0));
  speed_ = 0;
}

template <class Real>
void StepGuard<Real>::tell(GuardEvent::Action action) {
  GuardEvent event;
  event.action = action;
  event.fault = trouble_.fault;
  event.value = trouble_.value;
  event.limit = trouble_.limit;
  event.rung = rung_;
  events_.push_back(event);
}

template class StepGuard<float>;
template class StepGuard<double>;

}  // namespace weft
