#include "cloth/world/cloth.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "cloth/levels/refine.h"
#include "cloth/levels/unfold.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/start.h"
#include "cloth/sheet/tear/mend.h"
#include "cloth/sheet/tear/pieces.h"
#include "cloth/sheet/tear/tearing.h"

namespace weft {
namespace {

/// Share of the springs' energy by which rounding the new nodes of a split may raise it.
constexpr double kRounded = 0.005;

}  // namespace

template <class Real>
Cloth<Real>::Cloth(const ClothDescription& description, const std::vector<EffectDescription>& effects,
                   const IntegratorDescription& integrator, std::uint64_t seed, double sleep_speed)
    : description_(description),
      total_mass_(description.material.density * description.size.x() * description.size.y()),
      integrator_(make_integrator<Real>(integrator)),
      guard_(integrator),
      sleep_(sleep_speed) {
  compose(effects);
  const int level = std::clamp(description_.initial_level, description_.min_level, description_.max_level);
  enter_level(level, start<Real>(description_, level));
  perturb(description_, seed, particles_);
  if (bag_) bag_->join(particles_);
  fill();
  begins_ = !description_.nodes.empty() && !description_.sewn;
  hand_to_guard();
}

template <class Real>
void Cloth<Real>::compose(const std::vector<EffectDescription>& effects) {
  auto composed = make_effects<Real>(effects);
  const std::size_t count = composed.size();
  const auto added = effects_.begin() + static_cast<std::ptrdiff_t>(composed_);
  std::move(added, effects_.end(), std::back_inserter(composed));
  effects_ = std::move(composed);
  composed_ = count;
  const Vec3 gravity = total_gravity(effects);
  had_ += gravitational_energy(particles_, gravity - gravity_);
  gravity_ = gravity;
  sheet_effects_ = SheetEffects(effects);
  tearing_.reset();
  filling_.reset();
  for (const EffectDescription& effect : effects) {
    const auto* inflation = std::get_if<InflationEffect>(&effect);
    if (inflation != nullptr && inflation->volume && description_.sewn) filling_ = *inflation;
    if (const auto* tearing = std::get_if<TearingEffect>(&effect)) tearing_ = *tearing;
  }
}

template <class Real>
void Cloth<Real>::fill() {
  if (bag_ && bag_->fill(filling_, particles_, time_)) unsettled_ = Unsettled::by_gas;
}

template <class Real>
ContactCounters Cloth<Real>::contact_counters() const {
  return contact_ ? earlier_contacts_ + contact_->counters() : earlier_contacts_;
}

template <class Real>
double Cloth<Real>::energy_of_nodes() const {
  return kinetic_energy(particles_) + gravitational_energy(particles_, gravity_);
}

template <class Real>
void Cloth<Real>::request_level(int level) {
  pending_level_ = within_levels(level);
}

template <class Real>
bool Cloth<Real>::apply_pending_level() {
  if (std::exchange(begins_, false) && is_tangled(particles_, springs())) {
    unfold(particles_, description_, level_);
    hand_to_guard();
  }
  const int target = pending_level_.value_or(level_);
  pending_level_.reset();
  const bool changes = target != level_;
  if (!changes) return false;
  guard_.repair(particles_);
  held_ = elastic_energy();
  had_ = held_ + energy_of_nodes();
  if (target > level_) held_ *= 1 + kRounded;
  const bool by_area = description_.discretization == Discretization::continuum;
  finer_.reset();
  // The paper's own rules change levels as the paper does.
  if (by_area && target < level_ && !torn_) finer_ = particles_;
  while (level_ != target) {
    const int next = level_ < target ? level_ + 1 : level_ - 1;
    Particles<Real> particles(description_.base_cells.at(next));
    if (next > level_) {
      split(particles_, particles);
      ++splits_;
      if (walls_) {
        part_pieces(*torn_, next, *walls_);
        mend_split(walls_->at(next), cell(particles.grid()), particles);
      }
    } else {
      merge(particles_, particles);
      splits_ = std::max(0, splits_ - 1);
      if (by_area && torn_) merge_torn_momentum(particles_, *torn_, particles);
      if (by_area && !torn_) merge_momentum(particles_, particles);
    }
    enter_level(next, std::move(particles));
  }
  if (unsettled_ == Unsettled::no && by_area) unsettled_ = Unsettled::by_level;
  return true;
}

template <class Real>
void Cloth<Real>::enter_level(int level, Particles<Real> particles) {
  level_ = level;
  particles_ = std::move(particles);
  mass_distribution(total_mass_, description_.discretization, particles_.mass);
  if (description_.sewn) {
    if (bag_) {
      bag_->enter(particles_.grid());
    } else {
      bag_.emplace(particles_.grid());
    }
    bag_->join(particles_);
  }
  hold();
  if (walls_) take_over_walls();
  make_sheet();
  earlier_contacts_ = contact_counters();
  contact_.reset();
  integrator_->restart();
  hand_to_guard();
  wake();
}

template <class Real>
void Cloth<Real>::hand_to_guard() {
  const Grid& grid = particles_.grid();
  // A piece that falls off gets as far as it likes from what hangs.
  const bool held = description_.material.structural.least() > 0 && !torn_;
  const double infinite = std::numeric_limits<double>::infinity();
  guard_.enter(particles_, held ? cell(grid) : Vec2(infinite, infinite));
}

template <class Real>
void Cloth<Real>::make_sheet() {
  sheet_ = Sheet<Real>(description_, sheet_effects_, particles_.inverse_mass, torn_);
}

template <class Real>
void Cloth<Real>::tear() {
  if (surely_holds(springs(), particles_.position, *tearing_)) return;
  const std::vector<Link> breaking =
      links_to_break(link_loads(springs(), particles_.position, *tearing_), torn_.get());
  if (breaking.empty()) return;
  if (!walls_) walls_.emplace(description_.base_cells, description_.max_level);
  for (const Link& link : breaking) walls_->add(level_, link);
  take_over_walls();
  make_sheet();
  if (plate() != nullptr) integrator_->restart();  // which has its own copies of the plate
  integrator_->torn();
  hand_to_guard();
  wake();
}

template <class Real>
void Cloth<Real>::take_over_walls() {
  torn_ = std::make_shared<const TornLinks>(walls_->at(level_));
  whole_faces_ = torn_->whole_faces();
}

template <class Real>
void Cloth<Real>::set_integrator(const IntegratorDescription& integrator) {
  integrator_ = make_integrator<Real>(integrator);
  guard_.set_integrator(integrator);
  wake();
}

template <class Real>
void Cloth<Real>::set_effects(const std::vector<EffectDescription>& effects) {
  guard_.repair(particles_);
  compose(effects);
  fill();
  make_sheet();
  node_air_.reset();
  integrator_ = make_integrator<Real>(guard_.method());  // without the arrays of what is gone
  hand_to_guard();
  wake();
}

template <class Real>
void Cloth<Real>::tune_effects(const std::vector<EffectDescription>& effects) {
  const SheetEffects before = sheet_effects_;
  guard_.repair(particles_);
  compose(effects);
  if (sheet_effects_ != before) return set_effects(effects);
  fill();
  hand_to_guard();
  wake();
}

template <class Real>
void Cloth<Real>::set_material(const Material& material) {
  if (material == description_.material) return;
  guard_.repair(particles_);
  description_.material = material;
  const double before = elastic_energy();
  make_sheet();
  held_ += elastic_energy() - before;  // what it gains so is no level's
  had_ += elastic_energy() - before;
  integrator_->stiffness_changed();
  hand_to_guard();
  wake();
}

template <class Real>
void Cloth<Real>::add_effect(std::unique_ptr<Effect<Real>> effect) {
  effects_.push_back(std::move(effect));
  wake();
}

template <class Real>
void Cloth<Real>::moved_from_outside() {
  guard_.amend(particles_);
  if (asleep()) wake();
}

template class Cloth<float>;
template class Cloth<double>;

}  // namespace weft
