#pragma once
#include <optional>

#include "cloth/integrators/integrator.h"

namespace weft {

/// Keeps the books of a cloth that nothing but wind drives (Forces::drive) and nothing touches: what its
/// motion, springs and plate hold together changes by the work of the effects alone, but solves that are left
/// unfinished, the formula and rounding take energy from it, or give some. What they took is given back to
/// the motion and what they gave is taken from it, all of it scaled alike, so that momenta stay where nothing
/// is held (after Dinev et al., FEPR: Fast Energy Projection for Real-Time Simulation of Deformable Objects,
/// 2018, who project each step; and Su, Sheth, Fedkiw, Energy Conservation for the Simulation of Deformable
/// Bodies, 2013). Where a motion turns there is little to scale: what cannot be given then is owed.
///
/// A motion as slow as what a solve leaves undone in a step gets nothing back, or errors alone would keep it
/// going. Nor does a cloth that touches something, where contact takes energy that no work here stands for.
/// Where not even wind drives it, it never has more than it had when it was last driven, contact or not. In
/// wind half of what it loses is given back: folds lose most of it, and what they lose in earnest the drag
/// takes, so that all of it would overdrive the flapping.
///
/// The energy of a cloth of which no node is held is that beside its centre of mass: a fall's formula has its
/// own error, which is none of the inner motion's. Where such a cloth leans on something, that makes inner
/// motion of its fall: a strip that slides off a rail, the sides of a drape. There it is all its energy, with
/// height, that never grows.
template <class Real>
class EnergyLedger {
 public:
  /// `liveliness`, 0 to 1, is the share of what the motion lost or gained that is given back or taken; with 0
  /// it only never has more than it had.
  explicit EnergyLedger(double liveliness) : liveliness_(liveliness) {}

  /// As a step begins.
  void begin_step(const Particles<Real>& particles, const Forces<Real>& forces);
  /// After a substep: the nodes have come from `start`, their dampers by `dampers`, m (null where the springs
  /// are undamped), in h seconds.
  void count_work(const Particles<Real>& particles, const Forces<Real>& forces,
                  const VectorField<Real>& start, const VectorField<Real>* dampers, double h);
  /// After a step of `dt` seconds, in which something may have touched the cloth. Returns by what each
  /// velocity was multiplied: what else the integrator remembers of the motion it has to scale likewise
  /// (scale_motion). Tells `report` what was lost and what given back.
  double end_step(Particles<Real>& particles, const Forces<Real>& forces, double dt, bool touched,
                  AdvanceReport& report);

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(account_, work_);
  }

 private:
  struct Account {
    Drive drive;  ///< wind or nothing
    /// J, that the cloth had when it was last driven, with height where it is held; else since it last leant
    /// on something.
    double most;
    double most_whole;  ///< J, all that it had when it was last driven, with its fall and height
    double owed = 0;    ///< J, that its motion lost before this step and did not get back
    double now;         ///< J, that it has as the step begins, without height
    double motion = 0;  ///< the inner motion's largest energy of late, J
    template <class Archive>
    void serialize(Archive& archive) {
      archive(drive, most, most_whole, owed, now, motion);
    }
  };
  /// Of springs and plate, J.
  static double stored(const Particles<Real>& particles, const Forces<Real>& forces);
  /// Of the effects, J; none beside the centre of mass, as gravity is the only one that has any.
  static double height(const Particles<Real>& particles, const Forces<Real>& forces);
  /// Of what a motion of this energy loses in a step of `dt` seconds, what is given back.
  double kept_share(const Particles<Real>& particles, double motion, double dt) const;

  double liveliness_;
  std::optional<Account> account_;  ///< nothing while something else drives the cloth
  double work_ = 0;                 ///< of the effects in this step, J
  VectorField<Real> force_, way_;   ///< work space
};

extern template class EnergyLedger<float>;
extern template class EnergyLedger<double>;

}  // namespace weft
