/// Cloth's steps: what is done around the integrator's.
#include <algorithm>
#include <utility>

#include "cloth/core/clock.h"
#include "cloth/core/place.h"
#include "cloth/integrators/implicit.h"
#include "cloth/kernels/node_vector.h"
#include "cloth/sheet/motion.h"
#include "cloth/sheet/planar.h"
#include "cloth/world/cloth.h"

namespace weft {

template <class Real>
AdvanceReport Cloth<Real>::advance(const std::vector<Solid>& solids, const Air& air, double time, double dt) {
  if (!begin_advance(solids, air, time, dt)) return left_alone();
  Cloth* self = this;
  return advance_together({&self, 1}, solids, air, time, dt)[0];
}

template <class Real>
bool Cloth<Real>::begin_advance(const std::vector<Solid>& solids, const Air& air, double time, double dt) {
  if (!asleep() && follow(particles_)) {
    guard_.amend(particles_);
    disturbed_ = true;  // heights are seen from the place
  }
  solids_ = met_ = seen(solids);  // nothing is given yet, and nothing while it stands still
  if (pins_.moving() && pins_.begin_step(particles_, solids, time, dt)) wake();
  if (soft_pins_ != nullptr && soft_pins_->begin_step(solids, time, dt)) wake();
  if (resting() && grabs_ != nullptr) wake();
  if (bag_ && bag_->fills(time)) wake();
  work_ = 0;
  if (sleep_.through(particles_, solids, air) || guard_.stands_still()) return false;
  leave_plane(springs(), particles_);
  return true;
}

template <class Real>
std::vector<AdvanceReport> Cloth<Real>::advance_together(std::span<Cloth* const> cloths,
                                                         const std::vector<Solid>& solids, const Air& air,
                                                         double time, double dt) {
  double most = 0, nodes = 0;
  for (const Cloth* cloth : cloths) {
    most += cloth->most_work_;
    nodes += cloth->particles_.grid().nodes();
  }
  const WorkLimit limit(most);
  std::vector<AdvanceReport> reports(cloths.size());
  try {
    reports = advance_soundly(cloths, solids, air, time, dt);
  } catch (const TooMuchWork&) {
    for (Cloth* cloth : cloths) {
      cloth->guard_.give_up(cloth->particles_);
      cloth->forget_attempt();
      cloth->solids_ = cloth->met_;
    }
  }
  for (Cloth* cloth : cloths) cloth->work_ = limit.done() * cloth->particles_.grid().nodes() / nodes;
  return reports;
}

template <class Real>
std::vector<AdvanceReport> Cloth<Real>::advance_soundly(std::span<Cloth* const> cloths,
                                                        const std::vector<Solid>& solids, const Air& air,
                                                        double time, double dt) {
  using Verdict = typename StepGuard<Real>::Verdict;
  for (;;) {
    std::vector<Rung> rungs;
    rungs.reserve(cloths.size());
    for (Cloth* cloth : cloths) {
      cloth->settle_down(solids, time);
      rungs.push_back(cloth->guard_.rung());
    }
    std::vector<AdvanceReport> reports = attempt(cloths, air, time, dt);
    // What one of them has left bad all take back: the good ones before they are judged, which would keep
    // their states. One that is alone is judged at once.
    std::vector<char> passed(cloths.size(), 1);
    for (std::size_t k = 0; k < cloths.size() && cloths.size() > 1; ++k)
      passed[k] = cloths[k]->guard_.passes(cloths[k]->particles_, reports[k]) ? 1 : 0;
    bool good = std::find(passed.begin(), passed.end(), 0) == passed.end(), stand_still = false;
    for (std::size_t k = 0; k < cloths.size(); ++k) {
      Cloth& cloth = *cloths[k];
      if (good || passed[k] == 0) {
        const auto begin = Clock::now();
        const Verdict verdict = cloth.guard_.judge(cloth.particles_, reports[k]);
        reports[k].check_seconds = seconds(Clock::now() - begin);
        good = good && verdict == Verdict::good;
        stand_still = stand_still || verdict == Verdict::stand_still;
      } else {
        cloth.guard_.put_back(cloth.particles_);
      }
      if (good) {
        if (cloth.guard_.rung() != rungs[k]) cloth.integrator_ = make_integrator<Real>(cloth.guard_.method());
        cloth.end_advance(solids, time, dt, reports[k]);
      } else {
        cloth.forget_attempt();
        cloth.solids_ = cloth.met_;
      }
    }
    if (good) return reports;
    if (stand_still) return std::vector<AdvanceReport>(cloths.size());
  }
}

template <class Real>
void Cloth<Real>::end_advance(const std::vector<Solid>& solids, double time, double dt,
                              AdvanceReport& report) {
  sleep_.stepped(guard_.speed(), dt, particles_, solids);
  time_ = time + dt;
  settled_ = Unsettled::no;
  finer_.reset();
  splits_ = 0;
  nodes_in_contact_ = report.nodes_in_contact;
  if (tearing_) tear();
}

template <class Real>
Forces<Real> Cloth<Real>::forces(const EffectContext& context) {
  return {.sheet = &sheet_,
          .effects = &effects_,
          .context = context,
          .soft_pins = soft_pins_,
          .bag = bag_ ? &*bag_ : nullptr};
}

template <class Real>
std::vector<AdvanceReport> Cloth<Real>::attempt(std::span<Cloth* const> cloths, const Air& air, double time,
                                                double dt) {
  if (cloths.size() == 1) {
    Cloth& cloth = *cloths[0];
    return {cloth.integrator_->advance(cloth.particles_, cloth.all_forces(air, time, dt),
                                       cloth.contact_in_step(), cloth.solids_, time, dt)};
  }
  std::vector<typename Implicit<Real>::Step> steps(cloths.size());
  for (std::size_t k = 0; k < cloths.size(); ++k) {
    Cloth& cloth = *cloths[k];
    steps[k].method = cloth.integrator_->implicit();
    steps[k].particles = &cloth.particles_;
    steps[k].forces = cloth.all_forces(air, time, dt);
    steps[k].contact = cloth.contact_in_step();
    steps[k].solids = &cloth.solids_;
  }
  Implicit<Real>::advance_together(steps, time, dt);
  std::vector<AdvanceReport> reports;
  reports.reserve(steps.size());
  for (const auto& step : steps) reports.push_back(step.report);
  return reports;
}

template <class Real>
Contact<Real>* Cloth<Real>::contact_in_step() {
  if (solids_.empty()) return nullptr;
  contact().set_body_touches(&body_touches_);
  for (BodyTouch& touch : body_touches_) touch.impulse = 0;
  return &contact();
}

template <class Real>
Forces<Real> Cloth<Real>::all_forces(const Air& air, double time, double dt) {
  EffectContext context{&description_, &air.wind(), time};
  if (torn_) context.whole_faces = &whole_faces_;
  context.gusts = air.gusts();
  context.node_air = node_air(air, time, dt);
  Forces<Real> all = forces(context);
  if (pins_.moving()) all.pins = &pins_;
  all.layered = layers_ != nullptr;
  if (all.layered && !layers_->empty()) all.layers = layers_;
  all.part = layer_part_;
  all.drive = drive(all, dt);
  all.disturbed = std::exchange(disturbed_, false);
  all.rescued = guard_.rung() == Rung::backward_euler_4 || guard_.rung() == Rung::backward_euler_16;
  return all;
}

template <class Real>
Drive Cloth<Real>::drive(const Forces<Real>& forces, double dt) const {
  const double time = forces.context.time;
  const auto any_effect = [&](bool in_wind) {
    return std::any_of(effects_.begin(), effects_.end(), [&](const auto& effect) {
      return effect->feels_wind() == in_wind && effect->drives(forces.context);
    });
  };
  if (forces.holds_gas() || (forces.layers != nullptr && forces.layers->meets_others()) ||
      (forces.pins != nullptr && way_of_pins(time, time + dt) > 0) || any_effect(false) ||
      std::any_of(solids_.begin(), solids_.end(), [](const Solid& solid) {
        return solid.yields() || !solid.velocity.isZero(0) || !solid.turn.isZero(0);
      }))
    return Drive::other;
  return any_effect(true) ? Drive::wind : Drive::nothing;
}

template <class Real>
const VectorField<float>* Cloth<Real>::node_air(const Air& air, double time, double dt) {
  const auto feels_it = [](const auto& effect) { return effect->feels_wind(); };
  if (air.uniform() || std::none_of(effects_.begin(), effects_.end(), feels_it)) return nullptr;
  if (!node_air_) node_air_ = std::make_unique<NodeAir>();
  const Grid& grid = particles_.grid();
  return &node_air_->sample(air, particles_, cell(grid), time + dt / 2, dt / 2);
}

template <class Real>
void Cloth<Real>::forget_attempt() {
  if (settled_ != Unsettled::no) unsettled_ = std::exchange(settled_, Unsettled::no);
  // Work arrays that must stay zero outside the grid may hold what is not a number now.
  make_sheet();
  integrator_ = make_integrator<Real>(guard_.method());
  earlier_contacts_ = contact_counters();
  contact_.reset();
  nodes_in_contact_ = 0;
}

template AdvanceReport Cloth<float>::advance(const std::vector<Solid>&, const Air&, double, double);
template Forces<float> Cloth<float>::forces(const EffectContext&);
template bool Cloth<float>::begin_advance(const std::vector<Solid>&, const Air&, double, double);
template std::vector<AdvanceReport> Cloth<float>::advance_together(std::span<Cloth* const>,
                                                                   const std::vector<Solid>&, const Air&,
                                                                   double, double);
template std::vector<AdvanceReport> Cloth<float>::advance_soundly(std::span<Cloth* const>,
                                                                  const std::vector<Solid>&, const Air&,
                                                                  double, double);
template std::vector<AdvanceReport> Cloth<float>::attempt(std::span<Cloth* const>, const Air&, double,
                                                          double);
template Forces<float> Cloth<float>::all_forces(const Air&, double, double);
template Contact<float>* Cloth<float>::contact_in_step();
template void Cloth<float>::end_advance(const std::vector<Solid>&, double, double, AdvanceReport&);
template Drive Cloth<float>::drive(const Forces<float>&, double) const;
template const VectorField<float>* Cloth<float>::node_air(const Air&, double, double);
template void Cloth<float>::forget_attempt();
template AdvanceReport Cloth<double>::advance(const std::vector<Solid>&, const Air&, double, double);
template Forces<double> Cloth<double>::forces(const EffectContext&);
template bool Cloth<double>::begin_advance(const std::vector<Solid>&, const Air&, double, double);
template std::vector<AdvanceReport> Cloth<double>::advance_together(std::span<Cloth* const>,
                                                                    const std::vector<Solid>&, const Air&,
                                                                    double, double);
template std::vector<AdvanceReport> Cloth<double>::advance_soundly(std::span<Cloth* const>,
                                                                   const std::vector<Solid>&, const Air&,
                                                                   double, double);
template std::vector<AdvanceReport> Cloth<double>::attempt(std::span<Cloth* const>, const Air&, double,
                                                           double);
template Forces<double> Cloth<double>::all_forces(const Air&, double, double);
template Contact<double>* Cloth<double>::contact_in_step();
template void Cloth<double>::end_advance(const std::vector<Solid>&, double, double, AdvanceReport&);
template Drive Cloth<double>::drive(const Forces<double>&, double) const;
template const VectorField<float>* Cloth<double>::node_air(const Air&, double, double);
template void Cloth<double>::forget_attempt();

}  // namespace weft
