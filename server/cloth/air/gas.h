#pragma once
#include <algorithm>

#include "cloth/core/effect_description.h"
#include "cloth/core/particles.h"
#include "cloth/kernels/components.h"
#include "cloth/sheet/seam.h"

namespace weft {

/// Volume within a bag's sheet at these positions, m3, each cell being the bilinear patch between its
/// corners; below 0 inside out. By the divergence theorem the sum of r . dV/dr is 3 V.
template <class Real>
double enclosed_volume(const VectorField<Real>& position);

/// InflationEffect with a volume: gas shut in a sewn cloth. At an even temperature (Boyle) it has the same p
/// V whatever it fills, and the sheet feels what it has above the air outside,
///     p(V) = c / V - p_a,   c = (p_a + pressure) volume,   p_a = 101325 Pa,
/// on every node p dV/dr (Inflation), the gradient of its energy U(V) = p_a V - c ln V. The bag as a whole it
/// pushes nowhere.
///
/// It is poured in: the bag begins with the air it holds, as much as has no pressure, and gets the rest at an
/// even rate during `fill_time`.
///
/// Such a gas nearly keeps its volume: of a bag of 1 m2 a side, 0.4 kg and 0.1 m3 it makes 500 vibrations a
/// second. Every method therefore takes the pressure that there will be: explicit ones by push(), implicit
/// ones by the rank-one part of their system, stiffness() g g^T with g = dV/dr.
template <class Real>
class Gas {
 public:
  static constexpr double kOutside = 101325;  ///< p_a, Pa: the standard atmosphere
  /// Below this share of its volume it is taken to have no less: no force is infinite.
  static constexpr double kLeastShare = 1e-3;

  /// In a bag that has `begin_amount` of gas at `time`, s. `inflation` has a volume.
  Gas(const InflationEffect& inflation, double begin_amount, double time)
      : inflation_(inflation), begin_(time), begin_amount_(begin_amount) {}
  /// c of the air in a bag that is open, J: as much as has no pressure.
  static double amount_of_air(const Particles<Real>& particles) {
    return kOutside * std::max(0.0, enclosed_volume(particles.position));
  }

  const InflationEffect& inflation() const { return inflation_; }
  /// c at `time`, J.
  double amount(double time) const;
  /// Whether some is still to be poured in.
  bool fills(double time) const { return time < begin_ + inflation_.fill_time; }

  /// Above the outside's, Pa, at a volume, m3, and a time, s.
  double pressure(double volume, double time) const;

  /// U of a bag with its nodes there, J, from where it has the effect's volume.
  double energy(const VectorField<Real>& position, double time) const;

  /// Explicit methods: after a substep of h seconds to `time` under all else the nodes are moved by the
  /// pressure that there is after this move, as backward Euler has it for a volume that grows linearly,
  ///     V = V* + h^2 p(V) g . M^-1 g.
  /// That is a quadratic equation, of which one root is above 0 whatever h and V*: stable, never inside out.
  void push(Particles<Real>& particles, const Seam<Real>& seam, double time, double h);

  /// Implicit methods: linearises at the particles' positions and adds the force there, N.
  void add_force(const Particles<Real>& particles, const Seam<Real>& seam, double time,
                 VectorField<Real>& force);
  /// As linearised: -dp/dV, N/m5.
  double stiffness() const { return stiffness_; }
  /// As linearised: dV/dr, m2; 0 at fixed nodes, the same at nodes that are one.
  const VectorField<Real>& gradient() const { return gradient_; }
  /// By how much more the energy changes than the linearisation says if the free nodes move by `change`, J.
  double model_error(kernels::Components<const Real> position, kernels::Components<const Real> change);

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(inflation_, begin_, begin_amount_, gradient_, volume_, amount_, pressure_, stiffness_);
  }

 private:
  /// J, from one volume to another by `change`, m3, of the amount c, J.
  double energy_change(double volume, double change, double amount) const;
  /// Sets dV/dr of the free nodes, the same at nodes that are one; returns V.
  double differentiate(const Particles<Real>& particles, const Seam<Real>& seam);
  /// How much the volume grows by a change at the rate that it has after a share of it, m3.
  double growth(kernels::Components<const Real> position, kernels::Components<const Real> change,
                double share);

  InflationEffect inflation_;
  double begin_, begin_amount_;  ///< s, J
  VectorField<Real> gradient_;
  double volume_ = 0, amount_ = 0, pressure_ = 0, stiffness_ = 0;  ///< as linearised
  VectorField<Real> moved_, moved_gradient_;                       ///< work space of growth()
  std::vector<Real, AlignedAllocator<Real>> work_;
};

extern template double enclosed_volume(const VectorField<float>&);
extern template double enclosed_volume(const VectorField<double>&);
extern template class Gas<float>;
extern template class Gas<double>;

}  // namespace weft
