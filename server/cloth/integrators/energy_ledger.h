#pragma once
#include <optional>

#include "cloth/contact/constraints/contact_constraints.h"
#include "cloth/integrators/integrator.h"
#include "cloth/sheet/freedom.h"

namespace weft {

/// Keeps the books of a cloth that nothing but wind drives (Forces::drive): what its motion, springs and
/// plate hold together changes by the work of the effects and by what contact with solids that stand takes,
/// but solves that are left unfinished, the formula and rounding take energy from it, or give some. What they
/// took is given back to the motion and what they gave is taken from it, all of it scaled alike, so that
/// momenta stay where nothing is held (after Dinev et al., FEPR: Fast Energy Projection for Real-Time
/// Simulation of Deformable Objects, 2018, who project each step; and Su, Sheth, Fedkiw, Energy Conservation
/// for the Simulation of Deformable Bodies, 2013). Where a motion turns there is little to scale: what cannot
/// be given then is owed, which in each step grows by no more than what gravity gives in one. What a step
/// loses beyond that is of folds that it does not resolve: given back later it would speed up a sheet in
/// flight.
///
/// A motion as slow as what a solve leaves undone in a step gets nothing back, or errors alone would keep it
/// going. Nor does a torn cloth, whose pieces do not move as one, nor one whose layers touch, as nobody
/// counts what they take by meeting and rubbing. Where not even wind drives it, it never has more than it had
/// when it was last driven. In wind half of what it loses is given back: folds lose most of it, and what they
/// lose in earnest the drag takes, so that all of it would overdrive the flapping.
///
/// Backward Euler's nodes run ahead of their speeds: under a steady force a node that began at rest is, after
/// n substeps, where it should be half a substep later. That is no loss: of a cloth that nothing holds height
/// and work are taken where the nodes of a smooth motion were half a substep ago (`lead`).
///
/// The energy of a cloth of which no node is held is that beside its centre of mass: a fall's formula has its
/// own error, which is none of the inner motion's. While such a cloth leans on something, that makes inner
/// motion of its fall and takes up momentum, as held nodes do: a strip that slides off a rail, the sides of a
/// drape. There all its energy counts, with height, and all its velocities are scaled but those of the rigid
/// motion that nothing pushes (Freedom): a floor does not push a sheet sideways. There nothing is owed: what
/// is lost as cloth lands and crumples would come back as a rise of the energy, long after.
template <class Real>
class EnergyLedger {
 public:
  /// `liveliness`, 0 to 1, is the share of what the motion lost or gained that is given back or taken; with 0
  /// it only never has more than it had.
  explicit EnergyLedger(double liveliness) : liveliness_(liveliness) {}

  /// As a step begins whose formula's places run ahead of its speeds by so many seconds.
  void begin_step(const Particles<Real>& particles, const Forces<Real>& forces, double lead);
  /// A substep of h seconds: where its nodes began, m, and how fast, m/s, the ways of their dampers, m (null
  /// where the springs are undamped), and by how many seconds each node's place runs ahead (null if none
  /// does; 0 where the motion was broken).
  struct Ways {
    const VectorField<Real>& start;
    const VectorField<Real>& start_velocity;
    const VectorField<Real>* dampers;
    const Field<Real>* lead;
    double h;
  };
  /// After a substep.
  void count_work(const Particles<Real>& particles, const Forces<Real>& forces, const Ways& ways);
  /// Whether it keeps books of this step, not only the bound.
  bool counts() const { return account_ && books_; }
  /// What contact did to the cloth in a substep.
  void count_contact(const typename ContactConstraints<Real>::Work& work) {
    taken_ += work.taken;
    led_out_ += work.led_out;
  }
  /// After a step of `dt` seconds, in which something may have touched the cloth and left it that freedom.
  /// Returns by what each velocity beside the free rigid motion was multiplied: what else the integrator
  /// remembers of the motion it has to scale likewise (scale_motion). Tells `report` what was lost and what
  /// given back.
  double end_step(Particles<Real>& particles, const Forces<Real>& forces, double dt, bool touched,
                  const Freedom& freedom, AdvanceReport& report);
  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(account_, work_, work_whole_, taken_, led_out_);
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
    double now_whole;   ///< J, the same with all of its motion
    double motion = 0;  ///< the inner motion's largest energy of late, J
    template <class Archive>
    void serialize(Archive& archive) {
      archive(drive, most, most_whole, owed, now, now_whole, motion);
    }
  };
  /// Of the effects, J, where the nodes were so many seconds ago.
  static double height(const Particles<Real>& particles, const Forces<Real>& forces, double before);
  /// Of what a motion of this energy loses in a step of `dt` seconds, what is given back.
  double kept_share(const Particles<Real>& particles, double motion, double dt) const;

  double liveliness_;
  std::optional<Account> account_;  ///< nothing while something else drives the cloth
  bool books_ = true;               ///< in this step it can tell what was lost
  double lead_ = 0;                 ///< s, in this step
  double work_ = 0;                 ///< of the effects in this step, J
  double work_whole_ = 0;           ///< the same with that on the centre of mass
  double taken_ = 0;                ///< by contact in this step, J
  double led_out_ = 0;              ///< that it may have brought in by leading nodes out of solids, J
  VectorField<Real> force_, way_;   ///< work space
};

extern template class EnergyLedger<float>;
extern template class EnergyLedger<double>;

}  // namespace weft
