#include "cloth/air/bag.h"

namespace weft {

template <class Real>
bool Bag<Real>::fill(const std::optional<InflationEffect>& inflation, const Particles<Real>& particles,
                     double time) {
  if (!inflation) {
    gas_.reset();
    return false;
  }
  if (gas_ && gas_->inflation() == *inflation) return false;
  const double amount = gas_ ? gas_->amount(time) : Gas<Real>::amount_of_air(particles);
  gas_ = std::make_unique<Gas<Real>>(*inflation, amount, time);
  return !gas_->fills(time);
}

template <class Real>
void Bag<Real>::close(Particles<Real>& particles, double time, double h) {
  seam_.join(particles);
  if (gas_) gas_->push(particles, seam_, time, h);
}

template <class Real>
void Bag<Real>::linearise(const Particles<Real>& particles, double time, VectorField<Real>& force,
                          Multigrid<Real>& system) {
  if (!gas_) return;
  gas_->add_force(particles, seam_, time, force);
  system.set_rank_one(gas_->stiffness(), kernels::components(gas_->gradient()));
}

template class Bag<float>;
template class Bag<double>;

}  // namespace weft
