// A simulation's state, written down, read and taken over from another one: each class lists its own part.
#include "cloth/world/state.h"

#include <stdexcept>

#include "cloth/integrators/implicit.h"
#include "cloth/integrators/symplectic_euler.h"
#include "cloth/integrators/xpbd.h"
#include "cloth/world/description_archive.h"

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
template <class Archive>
void ClothContact<Real>::serialize(Archive& archive, std::vector<Cloth<Real>>& cloths) {
  // Where a level has changed since the last step the next one lays it all out anew.
  bool lasts = laid_out(cloths);
  archive(lasts);
  if (Archive::is_loading::value) {
    if (!lasts) grids_.clear();
    lay_out(cloths);
  }
  if (!lasts) return;
  for (std::size_t i = 0; i < cloths.size(); ++i) {
    bool as_torn = torn_[i] == cloths[i].springs().torn();
    archive(as_torn);
    if (!Archive::is_loading::value) continue;
    if (as_torn) {
      take_over_tears(cloths, i);
    } else {
      torn_[i] = nullptr;  // the next step will take it over
    }
  }
  std::vector<std::vector<std::size_t>> groups = groups_;
  archive(nodes_, search_, pairs_, groups);
  if (Archive::is_loading::value && groups != groups_) set_groups(groups, cloths);
  for (const auto& contacts : contacts_) archive(*contacts);
  archive(pressed_, on_solid_, left_out_, crowded_, found_, cells_passed_, may_be_tangled_, tangled_);
}

template <class Real>
template <class Archive>
void Cloth<Real>::serialize(Archive& archive) {
  serialize_sheet(archive);
  serialize_integrator(archive);
  serialize_contact(archive);
  archive(finer_, unsettled_, settled_, splits_, held_, had_, begins_, time_);
  std::optional<Gas<Real>> shut_in;
  if (gas() != nullptr) shut_in = *gas();
  bool filled = shut_in.has_value();
  archive(filled);
  if (filled) {
    if (!shut_in) shut_in.emplace(InflationEffect{}, 0, 0);
    archive(*shut_in);
  }
  if (Archive::is_loading::value && bag_) {
    bag_->take(filled && filling_ ? std::move(shut_in) : std::nullopt);
    fill();
  }
  serialize_soft_pins(archive);
  serialize_grabs(archive);  // which wakes it
  archive(disturbed_, sleep_, most_work_, work_);
}

/// Its integrator keeps what it has laid out where the sheet is the same: steps that are measured make it
/// once, as those of the cloth whose state is read.
template <class Real>
template <class Archive>
void Cloth<Real>::serialize_sheet(Archive& archive) {
  const Grid grid = particles_.grid();
  const Material material = description_.material;
  const auto inverse_mass = particles_.inverse_mass.values();
  const std::optional<TornLinks> torn = torn_ ? std::optional(*torn_) : std::nullopt;
  archive(level_, pending_level_, description_.pins, description_.material, particles_);
  bool tears = walls_.has_value();
  archive(tears);
  if (Archive::is_loading::value) {
    walls_.reset();
    if (tears) walls_.emplace(description_.base_cells, description_.max_level);
  }
  if (tears) archive(*walls_);
  if (Archive::is_loading::value) {
    if (particles_.grid() != description_.base_cells.at(level_))
      throw BadState("a cloth's grid is not its level's");
    const std::optional<TornLinks> torn_now = tears ? std::optional(walls_->at(level_)) : std::nullopt;
    const bool same_tears = torn == torn_now;
    if (!same_tears) {
      torn_ = nullptr;
      whole_faces_.clear();
      if (tears) take_over_walls();
    }
    if (bag_) bag_->enter(particles_.grid());
    if (grid != particles_.grid()) contact_.reset();
    if (grid != particles_.grid() || !same_tears || material != description_.material ||
        inverse_mass != particles_.inverse_mass.values()) {
      make_sheet();
      integrator_->restart();
    }
  }
  archive(pins_);
}

template <class Real>
template <class Archive>
void Cloth<Real>::serialize_integrator(Archive& archive) {
  const IntegratorDescription before = guard_.method();
  archive(guard_);
  const IntegratorDescription method = guard_.method();
  if (Archive::is_loading::value && method != before) integrator_ = make_integrator<Real>(method);
  if (std::holds_alternative<SymplecticEulerDescription>(method)) {
    archive(static_cast<SymplecticEuler<Real>&>(*integrator_));
  } else if (std::holds_alternative<XpbdDescription>(method)) {
    archive(static_cast<Xpbd<Real>&>(*integrator_));
  } else {
    archive(static_cast<Implicit<Real>&>(*integrator_));
  }
}

template <class Real>
template <class Archive>
void Cloth<Real>::serialize_contact(Archive& archive) {
  archive(nodes_in_contact_, earlier_contacts_);
  bool touches = contact_ != nullptr;
  archive(touches);
  if (Archive::is_loading::value && !touches) contact_.reset();
  if (touches) archive(contact());
}

template <class Real>
template <class Archive>
void Cloth<Real>::serialize_soft_pins(Archive& archive) {
  bool soft = soft_pins_ != nullptr;
  archive(next_pins_, soft);
  if (Archive::is_loading::value) {
    std::erase_if(effects_, [&](const auto& effect) { return effect.get() == soft_pins_; });
    soft_pins_ = nullptr;
    if (!soft) return;
    auto made = std::make_unique<SoftPins<Real>>();
    soft_pins_ = made.get();
    effects_.insert(effects_.begin() + static_cast<std::ptrdiff_t>(composed_), std::move(made));
  }
  if (soft) archive(*soft_pins_);
}

template <class Real>
template <class Archive>
void Cloth<Real>::serialize_grabs(Archive& archive) {
  std::vector<Grab> all = grabs();
  archive(all);
  if (!Archive::is_loading::value) return;
  std::erase_if(effects_, [&](const auto& effect) { return effect.get() == grabs_; });
  grabs_ = nullptr;
  for (const Grab& each : all) grab(each);
}

template <class Real>
template <class Archive>
void Simulation<Real>::serialize_cloths(Archive& archive) {
  archive(air_);
  for (Cloth<Real>& cloth : cloths_) archive(cloth);
  bool layered = layers_ != nullptr;
  archive(layered);
  if (layered && layers_) layers_->serialize(archive, cloths_);
}

template <class Real>
template <class Archive>
void Simulation<Real>::serialize(Archive& archive) {
  std::vector<EffectDescription> effects = effects_;
  archive(effects);
  if (Archive::is_loading::value) set_effects(effects);
  serialize_cloths(archive);
  archive(colliders_, last_advance_, steps_, next_grab_, guard_events_);
}

template <class Real>
void Simulation<Real>::take_state(const Simulation& other) {
  expect_same_obstacles(description_, other.description_);
  take_cloths(other);
  std::string bytes;
  StateWriter writer(bytes);
  writer(other.colliders_);
  StateReader reader(bytes);
  reader(colliders_);
}

template <class Real>
void Simulation<Real>::take_cloths(const Simulation& other) {
  expect_same_cloths(description_, other.description_);
  std::string bytes;
  StateWriter writer(bytes);
  const_cast<Simulation&>(other).serialize_cloths(writer);  // which writes to the archive alone
  StateReader reader(bytes);
  serialize_cloths(reader);
  const bool as_layered = (layers_ != nullptr) == (other.layers_ != nullptr);
  if (layers_ && !as_layered) make_layers(layers_->parameters());
  for (std::size_t i = 0; i < cloths_.size(); ++i) {
    if (cloths_[i].of_other_effects(other.cloths_[i])) cloths_[i].disturb();
    if (!as_layered) cloths_[i].wake();  // as set_effects wakes them
  }
  last_advance_ = other.last_advance_;
  steps_ = other.steps_;
  next_grab_ = other.next_grab_;
  guard_events_ = other.guard_events_;
  profile_ = other.profile_;
}

template <class Real>
std::string save_state(const Simulation<Real>& simulation) {
  std::string bytes;
  StateWriter writer(bytes);
  writer(simulation);
  return bytes;
}

template <class Real>
void load_state(Simulation<Real>& simulation, std::string_view state) {
  StateReader reader(state);
  reader(simulation);
  if (reader.rest() > 0) throw BadState("the state goes on too long");
}

template void Simulation<float>::take_state(const Simulation&);
template void Simulation<double>::take_state(const Simulation&);
template void Simulation<float>::take_cloths(const Simulation&);
template void Simulation<double>::take_cloths(const Simulation&);
template std::string save_state(const Simulation<float>&);
template std::string save_state(const Simulation<double>&);
template void load_state(Simulation<float>&, std::string_view);
template void load_state(Simulation<double>&, std::string_view);

}  // namespace weft
