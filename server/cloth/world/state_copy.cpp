// How a simulation goes on from another one's state: each class takes over its own part.
#include <stdexcept>

#include "cloth/world/simulation.h"

namespace weft {
namespace {

[[noreturn]] void refuse_copy(const std::string& what) {
  throw std::invalid_argument("the states of different scenes are no copies of each other: " + what);
}

void expect_same_cloths(const SimulationDescription& a, const SimulationDescription& b) {
  if (a.time_step != b.time_step) refuse_copy("time steps differ");
  if (a.cloths.size() != b.cloths.size()) refuse_copy("numbers of cloths differ");
  for (std::size_t i = 0; i < a.cloths.size(); ++i) {
    const ClothDescription &one = a.cloths[i], &other = b.cloths[i];
    const std::string of = " of cloth " + std::to_string(i) + " differ";
    if (one.base_cells != other.base_cells) refuse_copy("base cells" + of);
    if (one.min_level != other.min_level || one.max_level != other.max_level) refuse_copy("levels" + of);
    if (one.size != other.size || one.sewn != other.sewn) refuse_copy("sheets" + of);
    if (one.material.density != other.material.density || one.discretization != other.discretization) {
      refuse_copy("masses" + of);
    }
  }
}

void expect_same_obstacles(const SimulationDescription& a, const SimulationDescription& b) {
  if (a.obstacles.size() != b.obstacles.size()) refuse_copy("numbers of obstacles differ");
  for (std::size_t i = 0; i < a.obstacles.size(); ++i) {
    if (a.obstacles[i].shape.index() != b.obstacles[i].shape.index() ||
        a.obstacles[i].body.has_value() != b.obstacles[i].body.has_value()) {
      refuse_copy("kinds of obstacle " + std::to_string(i) + " differ");
    }
  }
}

}  // namespace

template <class Real>
void Simulation<Real>::take_state(const Simulation& other) {
  expect_same_obstacles(description_, other.description_);
  take_cloths(other);
  colliders_.take_state(other.colliders_);
}

template <class Real>
void Simulation<Real>::take_cloths(const Simulation& other) {
  expect_same_cloths(description_, other.description_);
  air_ = other.air_;
  for (std::size_t i = 0; i < cloths_.size(); ++i) cloths_[i].take_state(other.cloths_[i]);
  if (layers_) layers_->take_state(other.layers_.get(), cloths_);
  // As set_effects wakes them.
  if ((layers_ != nullptr) != (other.layers_ != nullptr)) {
    for (Cloth<Real>& cloth : cloths_) cloth.wake();
  }
  last_advance_ = other.last_advance_;
  steps_ = other.steps_;
  next_grab_ = other.next_grab_;
  guard_events_ = other.guard_events_;
  profile_ = other.profile_;
}

template <class Real>
void Cloth<Real>::take_state(const Cloth& other) {
  const bool same_grid = particles_.grid() == other.particles_.grid();
  const bool same_sheet = same_grid && torn_ == other.torn_ &&
                          description_.material == other.description_.material &&
                          particles_.inverse_mass.values() == other.particles_.inverse_mass.values();
  level_ = other.level_;
  pending_level_ = other.pending_level_;
  unsettled_ = other.unsettled_;
  settled_ = other.settled_;
  held_ = other.held_;
  had_ = other.had_;
  begins_ = other.begins_;
  // By other effects it has another energy.
  disturbed_ = other.disturbed_ || composed_ != other.composed_ || gravity_ != other.gravity_ ||
               bends_plate_ != other.bends_plate_ || limits_strain_ != other.limits_strain_ ||
               damping_time_ != other.damping_time_;
  particles_ = other.particles_;
  time_ = other.time_;
  description_.pins = other.description_.pins;
  description_.material = other.description_.material;
  pins_ = other.pins_;
  walls_ = other.walls_;
  torn_ = other.torn_;
  whole_faces_ = other.whole_faces_;
  seam_ = other.seam_;
  if (!same_sheet) make_springs();

  // What the sheet's integrator has laid out for it is kept where it can be: steps that are measured make it
  // once, as those of `other`.
  if (guard_.method() != other.guard_.method()) {
    integrator_ = make_integrator<Real>(other.guard_.method());
  } else if (!same_sheet) {
    integrator_->restart();
  }
  integrator_->take_memory(*other.integrator_);
  guard_ = other.guard_;

  nodes_in_contact_ = other.nodes_in_contact_;
  earlier_contacts_ = other.earlier_contacts_;
  if (!same_grid || !other.contact_) contact_.reset();
  if (other.contact_) contact().take_state(*other.contact_);

  gas_ = filling_ && other.gas_ ? std::make_unique<Gas<Real>>(*other.gas_) : nullptr;
  fill();

  const std::vector<Grab> grabs = other.grabs();
  std::erase_if(effects_, [&](const auto& effect) { return effect.get() == grabs_; });
  grabs_ = nullptr;
  for (const Grab& each : grabs) grab(each);

  sleep_ = other.sleep_;
}

template void Simulation<float>::take_state(const Simulation&);
template void Simulation<double>::take_state(const Simulation&);
template void Simulation<float>::take_cloths(const Simulation&);
template void Simulation<double>::take_cloths(const Simulation&);
template void Cloth<float>::take_state(const Cloth&);
template void Cloth<double>::take_state(const Cloth&);

}  // namespace weft
