/// Cloth's steps: what is done around the integrator's.
#include <algorithm>
#include <map>
#include <utility>

#include "cloth/core/clock.h"
#include "cloth/core/place.h"
#include "cloth/kernels/node_vector.h"
#include "cloth/sheet/motion.h"
#include "cloth/sheet/planar.h"
#include "cloth/world/cloth.h"

namespace weft {
namespace {

/// Of one step of relaxation, s, whatever the scene's steps and their parts: a cloth is left in the same
/// state by whichever integrator it is stepped.
constexpr double kLongestRelaxation = 1.0 / 60;

}  // namespace

template <class Real>
bool Cloth<Real>::unsettled(const std::vector<Solid>& solids) {
  const bool just_put = std::any_of(solids.begin(), solids.end(), [](const Solid& s) { return s.just_put; });
  if (just_put && is_put_onto(particles_, contact(), seen(solids))) {
    unsettled_ = Unsettled::by_solid;
    wake();
  }
  return unsettled_ != Unsettled::no && !asleep() && !frozen();
}

template <class Real>
void Cloth<Real>::settle_down(const std::vector<Solid>& solids, double time) {
  if (unsettled_ == Unsettled::no) return;
  settled_ = std::exchange(unsettled_, Unsettled::no);
  bool moved = false;
  try {
    const WorkLimit limit(most_work_);
    moved = settle(particles_, settled_, forces({.cloth = &description_, .time = time}),
                   solids.empty() ? nullptr : &contact(), seen(solids), kLongestRelaxation, held_);
  } catch (const TooMuchWork&) {
    guard_.put_back(particles_);
  }
  // Springs that expand against a pin lift the sheet: at one pin a merge gave 2 m of cloth 0.15 J of height.
  if (moved && settled_ == Unsettled::by_level)
    take_from_motion(particles_, std::max(0.0, elastic_energy() + energy_of_nodes() - had_));
}

template <class Real>
AdvanceReport Cloth<Real>::advance(const std::vector<Solid>& solids, const Air& air, double time, double dt) {
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
  if (sleep_.through(particles_, solids, air) || guard_.stands_still())
    return {.nodes_in_contact = nodes_in_contact_};
  leave_plane(springs(), particles_);
  const WorkLimit limit(most_work_);
  AdvanceReport report;
  try {
    report = advance_soundly(solids, air, time, dt);
  } catch (const TooMuchWork&) {
    guard_.give_up(particles_);
    forget_attempt();
    solids_ = met_;
  }
  work_ = limit.done();
  return report;
}

template <class Real>
AdvanceReport Cloth<Real>::advance_soundly(const std::vector<Solid>& solids, const Air& air, double time,
                                           double dt) {
  using Verdict = typename StepGuard<Real>::Verdict;
  for (;;) {
    settle_down(solids, time);
    const Rung rung = guard_.rung();
    AdvanceReport report = attempt(air, time, dt);
    const auto begin = Clock::now();
    const Verdict verdict = guard_.judge(particles_, report);
    if (verdict == Verdict::good) {
      if (guard_.rung() != rung) integrator_ = make_integrator<Real>(guard_.method());
      sleep_.stepped(guard_.speed(), dt, particles_, solids);
      time_ = time + dt;
      settled_ = Unsettled::no;
      nodes_in_contact_ = report.nodes_in_contact;
      report.check_seconds = seconds(Clock::now() - begin);
      if (tearing_) tear();
      return report;
    }
    forget_attempt();
    solids_ = met_;
    if (verdict == Verdict::stand_still) return {};
  }
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
AdvanceReport Cloth<Real>::attempt(const Air& air, double time, double dt) {
  EffectContext context{&description_, &air.wind(), time};
  if (torn_) context.whole_faces = &whole_faces_;
  context.gusts = air.gusts();
  context.node_air = node_air(air, time, dt);
  Forces<Real> all = forces(context);
  if (pins_.moving()) all.pins = &pins_;
  all.layered = layers_ != nullptr;
  if (all.layered && !layers_->empty()) all.layers = layers_;
  all.drive = drive(all, dt);
  all.disturbed = std::exchange(disturbed_, false);
  all.rescued = guard_.rung() == Rung::backward_euler_4 || guard_.rung() == Rung::backward_euler_16;
  if (solids_.empty()) return integrator_->advance(particles_, all, nullptr, solids_, time, dt);
  contact().set_body_touches(&body_touches_);
  for (BodyTouch& touch : body_touches_) touch.impulse = 0;
  return integrator_->advance(particles_, all, &contact(), solids_, time, dt);
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

template <class Real>
std::vector<Solid> Cloth<Real>::seen(const std::vector<Solid>& solids) const {
  std::vector<Solid> from_here;
  from_here.reserve(solids.size());
  for (const Solid& solid : solids) from_here.push_back(solid.from(particles_.place));
  return from_here;
}

template <class Real>
Contact<Real>& Cloth<Real>::contact() {
  if (!contact_) contact_ = std::make_unique<Contact<Real>>(particles_.grid());
  contact_->set_torn(torn_.get());
  return *contact_;
}

template <class Real>
std::vector<Touch> Cloth<Real>::keep_outside(const VectorField<Real>& before, double dt) {
  if (solids_.empty()) return {};
  std::vector<Touch> touches = contact().touches();
  std::sort(touches.begin(), touches.end());
  contact().resolve(particles_, solids_, {1, 1, dt}, &before);
  std::vector<Touch> met = contact().touches();
  contact().keep(touches);
  return met;
}

template <class Real>
void Cloth<Real>::add_pins_near(const std::vector<Solid>& solids, double time, double dt,
                                std::vector<PinnedNode>& found) {
  const auto yields = [](const Solid& solid) { return solid.yields(); };
  if (description_.pins.empty() || std::none_of(solids.begin(), solids.end(), yields)) return;
  std::map<std::size_t, Vec3> ways;  // by node
  double longest = 0;
  if (pins_.moving() && !frozen() && pins_.begin_step(particles_, solids, time, dt)) {
    pins_.for_each_way(time, time + dt, [&](std::size_t node, const Vec3& way) {
      ways[node] = way;
      longest = std::max(longest, way.norm());
    });
  }
  for (const NearPoint& near : contact().pinned_near(particles_, seen(solids), longest)) {
    const ClothPoint<Real> point(near.point, particles_);
    Solid pin;
    pin.shape = Sphere{0};
    pin.friction = solids[near.solid].friction;
    pin.start = pin.position =
        particles_.place + point.of(kernels::components(std::as_const(particles_.position)));
    point.for_each_node([&](std::size_t node, double weight) {
      const auto way = ways.find(node);
      if (way == ways.end()) return;
      pin.mobile = true;
      pin.position += weight * way->second;
      pin.velocity += weight / dt * way->second;
    });
    found.push_back({near.solid, pin});
  }
}

template <class Real>
bool Cloth<Real>::meets(const Solid& solid, double dt) {
  const std::vector<Touch>& touches = contact().touches();
  return std::any_of(touches.begin(), touches.end(),
                     [&](const Touch& t) { return t.collider == solid.id; }) ||
         !contact().foresee(particles_, {solid.from(particles_.place)}, {0, 1, dt}).empty();
}

template <class Real>
void Cloth<Real>::push_balls(Colliders& colliders) const {
  colliders.push(met_, solids_);
}

template bool Cloth<float>::unsettled(const std::vector<Solid>&);
template void Cloth<float>::settle_down(const std::vector<Solid>&, double);
template AdvanceReport Cloth<float>::advance(const std::vector<Solid>&, const Air&, double, double);
template Forces<float> Cloth<float>::forces(const EffectContext&);
template AdvanceReport Cloth<float>::advance_soundly(const std::vector<Solid>&, const Air&, double, double);
template AdvanceReport Cloth<float>::attempt(const Air&, double, double);
template Drive Cloth<float>::drive(const Forces<float>&, double) const;
template const VectorField<float>* Cloth<float>::node_air(const Air&, double, double);
template void Cloth<float>::forget_attempt();
template std::vector<Solid> Cloth<float>::seen(const std::vector<Solid>&) const;
template Contact<float>& Cloth<float>::contact();
template std::vector<Touch> Cloth<float>::keep_outside(const VectorField<float>&, double);
template void Cloth<float>::add_pins_near(const std::vector<Solid>&, double, double,
                                          std::vector<PinnedNode>&);
template bool Cloth<float>::meets(const Solid&, double);
template void Cloth<float>::push_balls(Colliders&) const;
template bool Cloth<double>::unsettled(const std::vector<Solid>&);
template void Cloth<double>::settle_down(const std::vector<Solid>&, double);
template AdvanceReport Cloth<double>::advance(const std::vector<Solid>&, const Air&, double, double);
template Forces<double> Cloth<double>::forces(const EffectContext&);
template AdvanceReport Cloth<double>::advance_soundly(const std::vector<Solid>&, const Air&, double, double);
template AdvanceReport Cloth<double>::attempt(const Air&, double, double);
template Drive Cloth<double>::drive(const Forces<double>&, double) const;
template const VectorField<float>* Cloth<double>::node_air(const Air&, double, double);
template void Cloth<double>::forget_attempt();
template std::vector<Solid> Cloth<double>::seen(const std::vector<Solid>&) const;
template Contact<double>& Cloth<double>::contact();
template std::vector<Touch> Cloth<double>::keep_outside(const VectorField<double>&, double);
template void Cloth<double>::add_pins_near(const std::vector<Solid>&, double, double,
                                           std::vector<PinnedNode>&);
template bool Cloth<double>::meets(const Solid&, double);
template void Cloth<double>::push_balls(Colliders&) const;

}  // namespace weft
