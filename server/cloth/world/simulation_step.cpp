/// Simulation's steps: what cloths, colliders and contact between cloths do in turn.
#include <algorithm>

#include "cloth/core/clock.h"
#include "cloth/core/disjoint_sets.h"
#include "cloth/core/interrupt.h"
#include "cloth/core/parallel.h"
#include "cloth/world/simulation.h"
#include "cloth/world/step_parts.h"

namespace weft {
namespace {

/// With fewer nodes in all a second thread hardly helps. Measured, two threads to one: two cloths of 9 x 9
/// nodes 1.0 (symplectic Euler) and 1.1 times (BDF2), four 1.5 and 1.2, two of 17 x 17 1.6 and 1.4.
constexpr int kNodesWorthHelp = 300;

}  // namespace

template <class Real>
void Simulation<Real>::step() {
  const auto begin = Clock::now();
  profile_ = StepProfile{};
  guard_events_.clear();

  for (Cloth<Real>& cloth : cloths_) cloth.apply_pending_level();
  profile_.levels = seconds(Clock::now() - begin);

  const int parts = step_parts(cloths_, layers_.get(), colliders_.solids(), time(), description_.time_step);
  const double dt = description_.time_step / parts, start = time();
  last_advance_.assign(cloths_.size(), AdvanceReport{});
  for (int part = 0; part < parts; ++part) step_part(start + part * dt, dt, parts - part);
  ++steps_;

  for (const AdvanceReport& report : last_advance_) {
    profile_.forces += report.forces_seconds;
    profile_.contact += report.contact_seconds;
    profile_.check += report.check_seconds;
  }
  profile_.total = seconds(Clock::now() - begin);
}

template <class Real>
void Simulation<Real>::step_part(double time, double dt, int parts_left) {
  check_interrupt(0);
  for (Cloth<Real>& cloth : cloths_) cloth.change_pins(time);
  colliders_.begin_step(time, dt, gravity_, colliders_.may_rest() ? sleepers() : std::vector<Sleeper>(),
                        parts_left);
  for (Cloth<Real>& cloth : cloths_) cloth.lift_new_pins(colliders_.solids());
  std::vector<PinnedNode> pins;
  for (Cloth<Real>& cloth : cloths_) cloth.add_pins_near(colliders_.solids(), time, dt, pins);
  meet_bodies(pins, dt);
  join_bodies();
  if (cloths_.size() > 1) share_balls(dt);
  settle_cloths(time, dt);
  double layers = 0;  // s
  if (layers_) {
    const auto search = Clock::now();
    layers_->begin_step(cloths_, dt);
    layers += seconds(Clock::now() - search);
  }
  advance_cloths(time, dt);
  if (layers_) {
    const auto net = Clock::now();
    layers_->end_step(cloths_, dt);
    layers += seconds(Clock::now() - net);
  }
  profile_.contact += layers;
  for (const Cloth<Real>& cloth : cloths_) cloth.push_balls(colliders_);
  add_body_impulses();
  // What the cloths press into others stays outside.
  if (colliders_.end_step()) meet_bodies(pins, dt, &touches_);
  colliders_.watch(dt);
  collect_guard_events();
}

template <class Real>
std::vector<Sleeper> Simulation<Real>::sleepers() const {
  std::vector<Sleeper> all;
  for (const Cloth<Real>& cloth : cloths_) all.push_back(cloth.sleeper());
  return all;
}

template <class Real>
void Simulation<Real>::meet_bodies(const std::vector<PinnedNode>& pins, double dt,
                                   const std::vector<BodyTouch>* pushed) {
  if (pins.empty() && !colliders_.may_meet()) return;
  if (!body_collision_) body_collision_ = std::make_unique<BodyCollision>();
  colliders_.meet(*body_collision_, dt, pins, pushed);
}

template <class Real>
void Simulation<Real>::join_bodies() {
  touches_.clear();
  if (colliders_.may_meet() &&
      std::any_of(cloths_.begin(), cloths_.end(), [](const Cloth<Real>& c) { return c.steps_implicitly(); }))
    touches_ = colliders_.touches(*body_collision_);
  for (Cloth<Real>& cloth : cloths_) cloth.set_body_touches(touches_);
}

template <class Real>
void Simulation<Real>::add_body_impulses() {
  for (const Cloth<Real>& cloth : cloths_) {
    const std::vector<BodyTouch>& pushed = cloth.body_touches();
    for (std::size_t i = 0; i < touches_.size(); ++i) touches_[i].impulse += pushed[i].impulse;
  }
}

template <class Real>
void Simulation<Real>::share_balls(double dt) {
  if (cloths_.size() < 2) return;  // there is nobody to share with
  // Whoever meets one of those that touch one another meets them all.
  const std::vector<Solid>& solids = colliders_.solids();
  DisjointSets piles(solids.size());
  for (const BodyTouch& touch : touches_) {
    if (solids[touch.a()].yields() && solids[touch.b()].yields()) piles.join(touch.a(), touch.b());
  }
  std::vector<int> meet(solids.size());  // by what stands for the pile
  for (Cloth<Real>& cloth : cloths_) {
    std::vector<char> met(solids.size());
    for (std::size_t i = 0; i < solids.size(); ++i) {
      if (met[piles.of(i)] == 0 && solids[i].yields() && cloth.meets(solids[i], dt)) met[piles.of(i)] = 1;
    }
    for (std::size_t i = 0; i < solids.size(); ++i) meet[i] += met[i];
  }
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const int cloths = meet[piles.of(i)];
    if (cloths > 1 && solids[i].yields()) colliders_.share(solids[i].id, cloths);
  }
}

template <class Real>
template <class Work>
void Simulation<Real>::for_each(std::size_t count, const Work& work) {
  int nodes = 0;
  for (const Cloth<Real>& cloth : cloths_) nodes += cloth.asleep() ? 0 : cloth.particles().grid().nodes();
  if (nodes >= kNodesWorthHelp) {
    parallel_for(static_cast<int>(count), work);
  } else {
    for (int i = 0; i < static_cast<int>(count); ++i) work(i);
  }
}

template <class Real>
void Simulation<Real>::settle_cloths(double time, double dt) {
  const std::vector<Solid>& solids = colliders_.solids();
  std::vector<char> unsettled(cloths_.size());
  std::transform(cloths_.begin(), cloths_.end(), unsettled.begin(),
                 [&](Cloth<Real>& cloth) { return cloth.unsettled(solids) ? 1 : 0; });
  if (std::none_of(unsettled.begin(), unsettled.end(), [](char each) { return each != 0; })) return;
  for (std::size_t i = 0; i < cloths_.size(); ++i) {
    if (unsettled[i] != 0) cloths_[i].keep_sides(solids);
  }
  if (layers_) layers_->begin_settling(cloths_);
  for_each(cloths_.size(), [&](int i) {
    const auto cloth = static_cast<std::size_t>(i);
    if (unsettled[cloth] != 0) cloths_[cloth].settle_down(solids, time);
  });
  if (layers_) layers_->end_settling(cloths_, dt);
}

template <class Real>
void Simulation<Real>::advance_cloths(double time, double dt) {
  const std::vector<Solid>& solids = colliders_.solids();
  if (!layers_) {
    return for_each(cloths_.size(), [&](int i) {
      const auto cloth = static_cast<std::size_t>(i);
      last_advance_[cloth] += cloths_[cloth].advance(solids, air_, time, dt);
    });
  }
  std::vector<char> steps(cloths_.size());
  for_each(cloths_.size(), [&](int i) {
    const auto cloth = static_cast<std::size_t>(i);
    steps[cloth] = cloths_[cloth].begin_advance(solids, air_, time, dt) ? 1 : 0;
  });
  layers_->make_groups(cloths_, steps);
  const auto& groups = layers_->groups();
  for_each(groups.size(), [&](int i) {
    const std::vector<std::size_t>& group = groups[static_cast<std::size_t>(i)];
    if (steps[group[0]] == 0) {  // it is alone
      last_advance_[group[0]] += cloths_[group[0]].left_alone();
      return;
    }
    std::vector<Cloth<Real>*> members;
    members.reserve(group.size());
    for (const std::size_t cloth : group) members.push_back(&cloths_[cloth]);
    const auto reports = Cloth<Real>::advance_together(members, solids, air_, time, dt);
    for (std::size_t k = 0; k < group.size(); ++k) last_advance_[group[k]] += reports[k];
  });
}

template <class Real>
void Simulation<Real>::collect_guard_events() {
  const std::uint64_t step = steps_ + 1;  // the one in hand
  for (std::size_t i = 0; i < cloths_.size(); ++i) {
    for (GuardEvent& event : cloths_[i].take_guard_events()) {
      event.cloth = i;
      event.step = step;
      guard_events_.push_back(event);
    }
    if (layers_ && layers_->crowded(i)) {
      guard_events_.push_back(
          {.action = GuardEvent::Action::let_through, .fault = Fault::crowded, .cloth = i, .step = step});
    }
  }
  for (const ColliderId ball : colliders_.take_stopped()) {
    guard_events_.push_back(
        {.action = GuardEvent::Action::ball_stopped, .fault = Fault::not_finite, .ball = ball, .step = step});
  }
}

template void Simulation<float>::step();
template void Simulation<float>::step_part(double, double, int);
template std::vector<Sleeper> Simulation<float>::sleepers() const;
template void Simulation<float>::meet_bodies(const std::vector<PinnedNode>&, double,
                                             const std::vector<BodyTouch>*);
template void Simulation<float>::join_bodies();
template void Simulation<float>::add_body_impulses();
template void Simulation<float>::share_balls(double);
template void Simulation<float>::settle_cloths(double, double);
template void Simulation<float>::advance_cloths(double, double);
template void Simulation<float>::collect_guard_events();
template void Simulation<double>::step();
template void Simulation<double>::step_part(double, double, int);
template std::vector<Sleeper> Simulation<double>::sleepers() const;
template void Simulation<double>::meet_bodies(const std::vector<PinnedNode>&, double,
                                              const std::vector<BodyTouch>*);
template void Simulation<double>::join_bodies();
template void Simulation<double>::add_body_impulses();
template void Simulation<double>::share_balls(double);
template void Simulation<double>::settle_cloths(double, double);
template void Simulation<double>::advance_cloths(double, double);
template void Simulation<double>::collect_guard_events();

}  // namespace weft
