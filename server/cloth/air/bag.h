#pragma once
#include <memory>
#include <optional>
#include <utility>

#include "cloth/air/gas.h"
#include "cloth/sheet/seam.h"
#include "cloth/solver/multigrid.h"

namespace weft {

/// A cloth that is sewn into a bag, at one level: its seam, and the gas that may be shut in it.
template <class Real>
class Bag {
 public:
  explicit Bag(const Grid& grid) : seam_(grid) {}
  /// The cloth is of another level; the gas stays.
  void enter(const Grid& grid) { seam_ = Seam<Real>(grid); }

  const Seam<Real>& seam() const { return seam_; }
  /// nullptr where none is shut in.
  const Gas<Real>* gas() const { return gas_.get(); }

  /// Shuts in the gas of `inflation`, which has a volume: from `time`, s, on it is poured in on top of what
  /// is there, unless that is the same. Nothing: opens the bag. Returns whether gas is there at once.
  bool fill(const std::optional<InflationEffect>& inflation, const Particles<Real>& particles, double time);
  /// Some is still to be poured in.
  bool fills(double time) const { return gas_ != nullptr && gas_->fills(time); }
  /// Puts in the place of what is shut in; nothing: opens the bag.
  void take(std::optional<Gas<Real>> gas) {
    gas_ = gas ? std::make_unique<Gas<Real>>(*std::move(gas)) : nullptr;
  }

  /// Makes one of what the seam joins (Seam::join).
  void join(Particles<Real>& particles) const { seam_.join(particles); }
  /// Explicit methods: ends a substep of h seconds to `time`, by the seam and then by the gas, whose volume
  /// an open seam would falsify.
  void close(Particles<Real>& particles, double time, double h);

  /// Implicit methods, at the particles' positions at `time`, s: adds the gas's force, N, and its stiffness
  /// to the system.
  void linearise(const Particles<Real>& particles, double time, VectorField<Real>& force,
                 Multigrid<Real>& system);
  /// Makes one of what a field holds at the nodes that the seam joins.
  void average(kernels::Components<Real> field) const { seam_.average(field); }
  /// By how much more the gas's energy changes than linearise() says if the free nodes move by `change`, J.
  double model_error(kernels::Components<const Real> position, kernels::Components<const Real> change) {
    return gas_ ? gas_->model_error(position, change) : 0;
  }

 private:
  Seam<Real> seam_;
  std::unique_ptr<Gas<Real>> gas_;
};

extern template class Bag<float>;
extern template class Bag<double>;

}  // namespace weft
