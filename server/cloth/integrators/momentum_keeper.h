#pragma once
#include "cloth/integrators/integrator.h"
#include "cloth/integrators/rigid_damping.h"
#include "cloth/sheet/freedom.h"

namespace weft {

/// What a solve leaves of its residual is a force that nobody exerts: over the steps a free sheet loses its
/// momentum and its spin by it, and in a hit what sheet and body have together. This gives a cloth that no
/// node holds back what is missing: after each substep a rigid motion, which strains nothing, is added to the
/// velocities, so that momentum and angular momentum, with those of the bodies that it touches, are what the
/// effects' forces make of them by the formula of the substep: backward Euler's, h F, or BDF2's, where all
/// nodes are stepped by that.
///
/// Turning has its energy from what the substep left of that with which it began, and then from the inner
/// motion. Of a sheet that drew together as its solve failed both may be too little for the same angular
/// momentum: then it turns as fast as they allow.
///
/// What stands firm and does not rub pushes along its normals, by forces that are not known to the last
/// digit: then it is the momenta of the rigid motions against which nothing pushes that are given back, as
/// those of a sheet that slides on a smooth floor.
///
/// It leaves alone what rubs on what stands firm, torn sheets, whose pieces do not move as one, and what
/// other cloths or gas press on.
template <class Real>
class MomentumKeeper {
 public:
  /// Particles and solids as a substep begins. `hung`: all soft pins are on solids that yield, which have
  /// their pull from the same solve.
  void begin_substep(const Particles<Real>& particles, const Forces<Real>& forces,
                     const std::vector<Solid>& solids, bool hung = false);
  /// As it ends; the nodes have come from `start`. `second_order` tells, node by node, if it was stepped by
  /// BDF2; nullptr: none was. `contact` tells what it touched; nullptr: there is nothing to touch. `freedom`
  /// is what firm solids leave it; `rubs`: one of them has friction. Returns by what the motion beside the
  /// free rigid one was multiplied (scale_motion).
  double end_substep(Particles<Real>& particles, const Forces<Real>& forces, const std::vector<Solid>& solids,
                     const VectorField<Real>& start, const Contact<Real>* contact, const Freedom& freedom,
                     bool rubs, const Field<Real>* second_order, double h);
  /// What was before says nothing about what follows.
  void restart() { now_ = before_ = {}; }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(now_, before_);
  }

 private:
  /// Of the cloth alone.
  struct Motion {
    bool known = false;
    double mass = 0;         ///< kg
    Vec3 centre{0, 0, 0};    ///< of mass, in the world, m
    Vec3 momentum{0, 0, 0};  ///< N s
    Vec3 spin{0, 0, 0};      ///< angular momentum about the centre, N m s
    double kinetic = 0;      ///< energy beside the centre's, J
    /// Angular momentum about a point.
    template <class Archive>
    void serialize(Archive& archive) {
      archive(known, mass, centre, momentum, spin, kinetic);
    }
    Vec3 about(const Vec3& point) const { return spin + (centre - point).cross(momentum); }
  };
  /// What comes from outside in a substep.
  struct Input {
    Vec3 force{0, 0, 0};   ///< of the effects, N
    Vec3 torque{0, 0, 0};  ///< of the effects, about the centre as the substep began, N m
    double work = 0;       ///< of the effects beside the centre, J
    Vec3 momentum{0, 0, 0}, angular_momentum{0, 0, 0};  ///< that bodies gave, N s; about that centre, N m s
    double energy = 0;                                  ///< that they lost, J
  };
  static Motion motion_of(const Particles<Real>& particles);
  static bool applies(const Particles<Real>& particles, const Forces<Real>& forces);
  /// A solid that yields touches the cloth.
  static bool touched_by_body(const std::vector<Solid>& solids, const Contact<Real>* contact);
  Input input(const Particles<Real>& particles, const Forces<Real>& forces, const std::vector<Solid>& solids,
              const VectorField<Real>& start);
  /// The rigid motion that is missing where these momenta are, N s and N m s about the centre: what damps it
  /// in `h`, s, takes its part of them. Without, what wind that hardly turned within a solve has not yet
  /// given would be given at one blow, and speed a light cloth up beyond any bound.
  Freedom::Screw response(const Particles<Real>& particles, const Forces<Real>& forces, const Motion& end,
                          const Eigen::Matrix3d& inertia, double h, const Freedom::Screw& momenta);
  bool all_by_bdf2(const std::vector<Solid>& solids, const Field<Real>* second_order) const;

  Motion now_, before_;        ///< as the substep begins, and as the one before began
  std::vector<Solid> solids_;  ///< as the substep begins
  bool hung_ = false;          ///< in this substep
  VectorField<Real> force_;    ///< N
  RigidDamping<Real> damping_;
};

extern template class MomentumKeeper<float>;
extern template class MomentumKeeper<double>;

}  // namespace weft
