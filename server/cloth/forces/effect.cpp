#include "cloth/forces/effect.h"

#include "cloth/forces/aerodynamics.h"
#include "cloth/forces/damping.h"
#include "cloth/forces/gravity.h"
#include "cloth/forces/inflation.h"
#include "cloth/forces/paper_wind.h"

namespace weft {
namespace {

/// Which class simulates which description.
template <class Real>
struct EffectMaker {
  using Made = std::unique_ptr<Effect<Real>>;
  Made operator()(const GravityEffect& e) const { return std::make_unique<Gravity<Real>>(e); }
  Made operator()(const DampingEffect& e) const { return std::make_unique<Damping<Real>>(e); }
  Made operator()(const PaperWindEffect& e) const { return std::make_unique<PaperWind<Real>>(e); }
  Made operator()(const AerodynamicsEffect& e) const { return std::make_unique<Aerodynamics<Real>>(e); }
  Made operator()(const InflationEffect& e) const {
    if (e.volume) return nullptr;  // Gas, which each integrator takes in its own way
    return std::make_unique<Inflation<Real>>(e);
  }
  // The sheet's own affair: Springs and Plate, which each integrator takes in its own way.
  Made operator()(const StrainDampingEffect&) const { return nullptr; }
  Made operator()(const PlateBendingEffect&) const { return nullptr; }
  Made operator()(const StrainLimitEffect&) const { return nullptr; }
  Made operator()(const TearingEffect&) const { return nullptr; }
  // The whole scene's: ClothContact.
  Made operator()(const ClothContactEffect&) const { return nullptr; }
};

}  // namespace

template <class Real>
double Effect<Real>::max_damping_rate(const Particles<Real>&, const EffectContext&) const {
  return 0;
}

template <class Real>
void Effect<Real>::add_damping(const Particles<Real>&, const EffectContext&,
                               const DampingMatrix<Real>&) const {}

template <class Real>
void Effect<Real>::add_stiffness(const Particles<Real>&, const EffectContext&, Real*) const {}

template <class Real>
std::vector<std::unique_ptr<Effect<Real>>> make_effects(const std::vector<EffectDescription>& descriptions) {
  std::vector<std::unique_ptr<Effect<Real>>> effects;
  effects.reserve(descriptions.size());
  for (const EffectDescription& description : descriptions) {
    auto effect = std::visit(EffectMaker<Real>{}, description);
    if (effect) effects.push_back(std::move(effect));
  }
  return effects;
}

const char* name_of(const EffectDescription& description) {
  return std::visit([](const auto& effect) { return effect.kName; }, description);
}

Vec3 total_gravity(const std::vector<EffectDescription>& descriptions) {
  Vec3 sum(0, 0, 0);
  for (const EffectDescription& description : descriptions) {
    if (const auto* gravity = std::get_if<GravityEffect>(&description)) sum += gravity->acceleration;
  }
  return sum;
}

template class Effect<float>;
template class Effect<double>;
template std::vector<std::unique_ptr<Effect<float>>> make_effects<float>(
    const std::vector<EffectDescription>&);
template std::vector<std::unique_ptr<Effect<double>>> make_effects<double>(
    const std::vector<EffectDescription>&);

}  // namespace weft
