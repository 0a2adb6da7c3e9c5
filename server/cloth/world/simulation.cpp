#include "cloth/world/simulation.h"

#include <algorithm>

#include "cloth/sheet/diagnostics.h"

namespace weft {
namespace {

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
  make_layers(cloth_contact(description_.effects));  // what contact remembers is of the old cloths
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
  for (Cloth<Real>& cloth : cloths_) cloth.set_layers(nullptr, 0);
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
