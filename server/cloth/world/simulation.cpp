#include "cloth/world/simulation.h"

#include <algorithm>

#include "cloth/core/clock.h"
#include "cloth/core/interrupt.h"
#include "cloth/core/parallel.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/world/step_parts.h"

namespace weft {
namespace {

/// With fewer nodes in all a second thread hardly helps. Measured, two threads to one: two cloths of 9 x 9
/// nodes 1.0 (symplectic Euler) and 1.1 times (BDF2), four 1.5 and 1.2, two of 17 x 17 1.6 and 1.4.
constexpr int kNodesWorthHelp = 300;

template <class Real>
std::vector<Cloth<Real>> make_cloths(const SimulationDescription& description) {
  std::vector<Cloth<Real>> cloths;
  cloths.reserve(description.cloths.size());
  for (const ClothDescription& cloth : description.cloths) {
    // Each cloth draws from its own sequence: adding one leaves the others as they are.
    cloths.emplace_back(cloth, description.effects, description.integrator, description.seed + cloths.size(),
                        description.sleep_speed);
  }
  return cloths;
}

bool of_same_types(const std::vector<EffectDescription>& a, const std::vector<EffectDescription>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& one, const auto& other) { return one.index() == other.index(); });
}

std::optional<ClothContactEffect> cloth_contact(const std::vector<EffectDescription>& effects) {
  std::optional<ClothContactEffect> found;
  for (const EffectDescription& effect : effects) {
    if (const auto* contact = std::get_if<ClothContactEffect>(&effect)) found = *contact;
  }
  return found;
}

}  // namespace

template <class Real>
Simulation<Real>::Simulation(SimulationDescription description) : description_(std::move(description)) {
  reset();
}

template <class Real>
void Simulation<Real>::reset() {
  air_ = Air(description_.wind, description_.seed);
  body_collision_.reset();
  colliders_ = Colliders(description_.balls, description_.obstacles, description_.sleep_speed);
  cloths_ = make_cloths<Real>(description_);
  compose(description_.effects);
  last_advance_.assign(cloths_.size(), AdvanceReport{});
  steps_ = 0;
  next_grab_ = 1;
  guard_events_.clear();
  profile_ = StepProfile{};
}

template <class Real>
void Simulation<Real>::set_integrator(const IntegratorDescription& integrator) {
  for (Cloth<Real>& cloth : cloths_) cloth.set_integrator(integrator);
}

template <class Real>
void Simulation<Real>::set_wind_zone(std::size_t zone, const Vec3& velocity) {
  Wind changed = wind();
  changed.zones[zone].velocity = velocity;
  set_wind(changed);
  for (Cloth<Real>& cloth : cloths_) cloth.wake();  // by the wind outside of zones it would not
}

template <class Real>
void Simulation<Real>::set_effects(const std::vector<EffectDescription>& effects) {
  colliders_.wake();
  const bool same_types = of_same_types(effects, effects_);
  for (Cloth<Real>& cloth : cloths_) same_types ? cloth.tune_effects(effects) : cloth.set_effects(effects);
  compose(effects);
}

template <class Real>
bool Simulation<Real>::set_ball_friction(BallId id, double friction) {
  const Ball* ball = colliders_.find(id);
  if (ball == nullptr) return false;
  if (ball->friction == friction) return true;
  for (Cloth<Real>& cloth : cloths_) cloth.wake();
  return colliders_.set_friction(id, friction);
}

template <class Real>
bool Simulation<Real>::set_obstacle_friction(std::size_t index, double friction) {
  if (index >= colliders_.obstacles().size()) return false;
  if (colliders_.obstacles()[index].solid.friction == friction) return true;
  for (Cloth<Real>& cloth : cloths_) cloth.wake();
  return colliders_.set_obstacle_friction(index, friction);
}

template <class Real>
void Simulation<Real>::compose(const std::vector<EffectDescription>& effects) {
  const auto contact = cloth_contact(effects);
  if (contact != cloth_contact(effects_)) make_layers(contact);
  effects_ = effects;
  gravity_ = total_gravity(effects);
}

template <class Real>
void Simulation<Real>::make_layers(const std::optional<ClothContactEffect>& contact) {
  for (Cloth<Real>& cloth : cloths_) cloth.set_layers(nullptr);
  layers_ = contact ? std::make_unique<ClothContact<Real>>(*contact) : nullptr;
}

template <class Real>
GrabId Simulation<Real>::grab(std::size_t cloth, const Vec2& at, const std::optional<Vec3>& hand,
                              double max_force) {
  const Vec3 place = Grabs<Real>::place(cloths_[cloth].particles(), description_.cloths[cloth], at);
  cloths_[cloth].grab({next_grab_, at, hand.value_or(place), max_force});
  return next_grab_++;
}

template <class Real>
std::optional<GrabId> Simulation<Real>::grab_obstacle(std::size_t index, const Vec3& point,
                                                      const std::optional<Vec3>& hand, double max_force) {
  if (index >= colliders_.obstacles().size()) return {};
  const Pose& pose = colliders_.obstacles()[index].pose;
  const Vec3 place = pose.position + pose.orientation * point;
  if (!colliders_.grab({next_grab_, index, point, hand.value_or(place), max_force})) return {};
  return next_grab_++;
}

template <class Real>
bool Simulation<Real>::move_grab(GrabId id, const Vec3& hand) {
  return colliders_.move_grab(id, hand) ||
         std::any_of(cloths_.begin(), cloths_.end(),
                     [&](Cloth<Real>& cloth) { return cloth.move_grab(id, hand); });
}

template <class Real>
bool Simulation<Real>::release(GrabId id) {
  return colliders_.release(id) ||
         std::any_of(cloths_.begin(), cloths_.end(), [&](Cloth<Real>& cloth) { return cloth.release(id); });
}

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
  std::vector<PinnedNode> pins;
  for (Cloth<Real>& cloth : cloths_) cloth.add_pins_near(colliders_.solids(), time, dt, pins);
  meet_bodies(pins, dt);
  if (cloths_.size() > 1) share_balls(dt);
  settle_cloths(time);
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
  if (colliders_.end_step()) meet_bodies(pins, dt);  // what the cloths press into others stays outside
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
void Simulation<Real>::meet_bodies(const std::vector<PinnedNode>& pins, double dt) {
  if (pins.empty() && !colliders_.may_meet()) return;
  if (!body_collision_) body_collision_ = std::make_unique<BodyCollision>();
  colliders_.meet(*body_collision_, dt, pins);
}

template <class Real>
void Simulation<Real>::share_balls(double dt) {
  if (cloths_.size() < 2) return;  // there is nobody to share with
  for (const Solid& solid : colliders_.solids()) {
    if (!solid.yields()) continue;
    const auto meet = std::count_if(cloths_.begin(), cloths_.end(),
                                    [&](Cloth<Real>& cloth) { return cloth.meets(solid, dt); });
    if (meet > 1) colliders_.share(solid.id, static_cast<int>(meet));
  }
}

template <class Real>
template <class Work>
void Simulation<Real>::for_each_cloth(const Work& work) {
  int nodes = 0;
  for (const Cloth<Real>& cloth : cloths_) nodes += cloth.asleep() ? 0 : cloth.particles().grid().nodes();
  const int count = static_cast<int>(cloths_.size());
  if (nodes >= kNodesWorthHelp) {
    parallel_for(count, work);
  } else {
    for (int i = 0; i < count; ++i) work(i);
  }
}

template <class Real>
void Simulation<Real>::settle_cloths(double time) {
  const std::vector<Solid>& solids = colliders_.solids();
  std::vector<char> unsettled(cloths_.size());
  std::transform(cloths_.begin(), cloths_.end(), unsettled.begin(),
                 [&](Cloth<Real>& cloth) { return cloth.unsettled(solids) ? 1 : 0; });
  if (std::none_of(unsettled.begin(), unsettled.end(), [](char each) { return each != 0; })) return;
  for_each_cloth([&](int i) {
    const auto cloth = static_cast<std::size_t>(i);
    if (unsettled[cloth] != 0) cloths_[cloth].settle_down(solids, time);
  });
}

template <class Real>
void Simulation<Real>::advance_cloths(double time, double dt) {
  for_each_cloth([&](int i) {
    const auto cloth = static_cast<std::size_t>(i);
    last_advance_[cloth] += cloths_[cloth].advance(colliders_.solids(), air_, time, dt);
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

template <class Real>
bool Simulation<Real>::healthy() const {
  return std::all_of(cloths_.begin(), cloths_.end(), [](const Cloth<Real>& cloth) { return cloth.sound(); });
}

template <class Real>
ClothReport Simulation<Real>::report(std::size_t cloth) const {
  const Particles<Real>& particles = cloths_[cloth].particles();
  const Springs<Real>& springs = cloths_[cloth].springs();
  ClothReport report;
  report.level = cloths_[cloth].level();
  report.substeps = last_advance_[cloth].substeps;
  report.nodes_in_contact = last_advance_[cloth].nodes_in_contact;
  report.kinetic_energy = kinetic_energy(particles);
  report.potential_energy = cloths_[cloth].elastic_energy() + gravitational_energy(particles, gravity_);
  report.strain = springs.structural_strain(particles.position);
  return report;
}

template <class Real>
Vec3 Simulation<Real>::centre(std::size_t cloth) const {
  return weft::centre(cloths_[cloth].particles());
}

template class Simulation<float>;
template class Simulation<double>;

}  // namespace weft
