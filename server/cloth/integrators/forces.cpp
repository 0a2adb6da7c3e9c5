#include "cloth/integrators/forces.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cloth/sheet/diagnostics.h"

namespace weft {

template <class Real>
void Forces<Real>::sum(const Particles<Real>& particles, VectorField<Real>& force) const {
  force.fill(Real(0));
  sheet->add_forces(particles.position, force);
  for (const auto& effect : *effects) effect->add_forces(particles, context, force);
}

template <class Real>
void Forces<Real>::sum_with(const VectorField<Real>& slow, const Particles<Real>& particles,
                            VectorField<Real>& force) const {
  force = slow;
  sheet->add_forces(particles.position, force);
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
void Forces<Real>::sum_effects(const Particles<Real>& particles, VectorField<Real>& force,
                               const Effect<Real>* other) const {
  force.fill(Real(0));
  for (const auto& effect : *effects) {
    if (effect.get() != other) effect->add_forces(particles, context, force);
  }
}

template <class Real>
double Forces<Real>::energy(const Particles<Real>& particles) const {
  return kinetic_energy(particles) + sheet->energy(particles.position) + effects_energy(particles);
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
kernels::SpringModelError Forces<Real>::model_error(const Grid& grid,
                                                    kernels::Components<const Real> position,
                                                    kernels::Components<const Real> change) const {
  kernels::SpringModelError error = sheet->model_error(grid, position, change);
  if (bag != nullptr) {
    const double of_gas = bag->model_error(position, change);
    error.sum += of_gas;
    error.magnitude += std::abs(of_gas);
  }
  return error;
}

template struct Forces<float>;
template struct Forces<double>;

}  // namespace weft
