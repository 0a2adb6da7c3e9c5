#include "cloth/integrators/integrator.h"

#include <algorithm>
#include <numeric>

#include "cloth/integrators/implicit.h"
#include "cloth/integrators/symplectic_euler.h"
#include "cloth/integrators/xpbd.h"
#include "cloth/sheet/diagnostics.h"

namespace weft {

AdvanceReport& AdvanceReport::operator+=(const AdvanceReport& next) {
  substeps += next.substeps;
  nodes_in_contact = next.nodes_in_contact;
  linear_iterations += next.linear_iterations;
  forces_seconds += next.forces_seconds;
  contact_seconds += next.contact_seconds;
  check_seconds += next.check_seconds;
  energy_lost += next.energy_lost;
  energy_given_back += next.energy_given_back;
  effects_work += next.effects_work;
  contact_took += next.contact_took;
  sound = sound && next.sound;
  return *this;
}
namespace {

/// Which class follows which description.
template <class Real>
struct IntegratorMaker {
  using Made = std::unique_ptr<Integrator<Real>>;
  Made operator()(const SymplecticEulerDescription& d) const {
    return std::make_unique<SymplecticEuler<Real>>(d);
  }
  Made operator()(const BackwardEulerDescription& d) const {
    return std::make_unique<Implicit<Real>>(d.kName, d, false);
  }
  Made operator()(const Bdf2Description& d) const {
    return std::make_unique<Implicit<Real>>(d.kName, d, true);
  }
  Made operator()(const XpbdDescription& d) const { return std::make_unique<Xpbd<Real>>(d); }
};

}  // namespace

template <class Real>
void Forces<Real>::sum(const Particles<Real>& particles, VectorField<Real>& force) const {
  force.fill(Real(0));
  add_sheet(particles, force);
  for (const auto& effect : *effects) effect->add_forces(particles, context, force);
}

template <class Real>
void Forces<Real>::sum_with(const VectorField<Real>& slow, const Particles<Real>& particles,
                            VectorField<Real>& force) const {
  force = slow;
  add_sheet(particles, force);
  for (const auto& effect : *effects) {
    if (!effect->slow()) effect->add_forces(particles, context, force);
  }
}

template <class Real>
void Forces<Real>::sum_slow(const Particles<Real>& particles, VectorField<Real>& force) const {
  force.fill(Real(0));
  for (const auto& effect : *effects) {
    if (effect->slow()) effect->add_forces(particles, context, force);
  }
}

template <class Real>
bool Forces<Real>::any_slow() const {
  return std::any_of(effects->begin(), effects->end(), [](const auto& effect) { return effect->slow(); });
}

template <class Real>
double Forces<Real>::tension(const Particles<Real>& particles) const {
  return std::accumulate(effects->begin(), effects->end(), 0.0, [&](double sum, const auto& effect) {
    return sum + effect->tension(particles, context);
  });
}

template <class Real>
void Forces<Real>::add_sheet(const Particles<Real>& particles, VectorField<Real>& force) const {
  springs->add_forces(particles.position, force);
  if (plate != nullptr) plate->add_forces(particles.position, force);
}

template <class Real>
void Forces<Real>::sum_effects(const Particles<Real>& particles, VectorField<Real>& force,
                               const Effect<Real>* other) const {
  force.fill(Real(0));
  for (const auto& effect : *effects) {
    if (effect.get() != other) effect->add_forces(particles, context, force);
  }
}

template <class Real>
double Forces<Real>::energy(const Particles<Real>& particles) const {
  double sum = kinetic_energy(particles) + springs->energy(particles.position);
  if (plate != nullptr) sum += plate->energy(particles.position);
  return sum + effects_energy(particles);
}

template <class Real>
double Forces<Real>::effects_energy(const Particles<Real>& particles) const {
  return std::accumulate(effects->begin(), effects->end(), 0.0,
                         [&](double sum, const auto& effect) { return sum + effect->energy(particles); });
}

template <class Real>
DampingRates Forces<Real>::max_damping_rates(const Particles<Real>& particles,
                                             const Effect<Real>* other) const {
  DampingRates rates;
  for (const auto& effect : *effects) {
    if (effect.get() == other) continue;
    (effect->slow() ? rates.slow : rates.other) += effect->max_damping_rate(particles, context);
  }
  return rates;
}

template <class Real>
std::unique_ptr<Integrator<Real>> make_integrator(const IntegratorDescription& description) {
  return std::visit(IntegratorMaker<Real>{}, description);
}

template struct Forces<float>;
template struct Forces<double>;
template std::unique_ptr<Integrator<float>> make_integrator<float>(const IntegratorDescription&);
template std::unique_ptr<Integrator<double>> make_integrator<double>(const IntegratorDescription&);

}  // namespace weft
