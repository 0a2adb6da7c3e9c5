#pragma once
#include <span>

#include "cloth/integrators/integrator.h"
#include "cloth/integrators/rigid_damping.h"
#include "cloth/sheet/freedom.h"

namespace weft {

/// What a solve leaves of its residual is a force that nobody exerts: over the steps a free sheet loses its
/// momentum and its spin by it, and in a hit what sheet and body have together. This gives a cloth that no
/// node holds back what is missing: after each substep a rigid motion, which strains nothing, is added to the
/// velocities, so that momentum and angular momentum, with those of the bodies that it touches, are what the
/// effects' forces make of them by the formula of the substep: backward Euler's, h F, or BDF2's, where all
/// nodes are stepped by that. Angular momentum is that about the cloth's own centre, which goes on in the
/// substep: about a fixed point the forces at the substep's end would have a lever of h V on the momentum at
/// its beginning, and gravity would make what is thrown spin. What a hand or a pin draws turns about a fixed
/// point all the same, as its hold does not go on with it.
///
/// Turning has its energy from what the substep left of that with which it began, and then from the inner
/// motion. Of a sheet that drew together as its solve failed both may be too little for the same angular
/// momentum: then it turns as fast as they allow.
///
/// What stands firm and does not rub pushes along its normals, by forces that are not known to the last
/// digit: then it is the momenta of the rigid motions against which nothing pushes that are given back, as
/// those of a sheet that slides on a smooth floor.
///
/// Of cloths that are stepped together it is what they have together that is given back: what they push one
/// another with sums to nothing, and their motion beside one another is left as the solve has found it.
///
/// A hand or a soft pin draws the harder the farther its cloth is: what such a one draws is moved, too, by as
/// much as the formula of the substep says. With the velocity alone a cloth that is slung by its corner at 30
/// Hz would be where it is without that, and be slung up beyond any bound.
///
/// It leaves alone what rubs on what stands firm, torn sheets, whose pieces do not move as one, what touches
/// something while it is drawn, and what cloth that is stepped apart presses on. The gas in a bag pushes it
/// as a whole nowhere.
template <class Real>
class MomentumKeeper {
 public:
  /// Particles and solids as a substep begins. `hung`: all soft pins are on solids that yield, which have
  /// their pull from the same solve.
  void begin_substep(const Particles<Real>& particles, const Forces<Real>& forces,
                     const std::vector<Solid>& solids, bool hung = false);
  /// A cloth as a substep ends. Its nodes have come from `start`. `second_order` tells, node by node, if it
  /// was stepped by BDF2; nullptr: none was. `contact` tells what it touched; nullptr: there is nothing to
  /// touch. `freedom` is what firm solids leave it; `rubs`: one of them has friction.
  struct Member {
    MomentumKeeper* keeper;
    Particles<Real>* particles;
    const Forces<Real>* forces;
    const std::vector<Solid>* solids;
    const VectorField<Real>* start;
    const Contact<Real>* contact;
    const Freedom* freedom;
    bool rubs;
    const Field<Real>* second_order;
    double to;         ///< when the substep ends, share of the step
    Vec3 hung_torque;  ///< of soft pins on solids that do not turn, beside that of the same forces at the
                       ///< solids' centres, N m
  };
  /// As it ends, after h seconds, of those that are stepped together. Returns by what the motion beside the
  /// free rigid one was multiplied (scale_motion).
  static double end_substep(std::span<const Member> members, double h);
  /// What was before says nothing about what follows.
  void restart() { now_ = before_ = {}; }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(now_, before_);
  }

 private:
  /// Of cloth alone.
  struct Motion {
    bool known = false;
    double mass = 0;         ///< kg
    Vec3 centre{0, 0, 0};    ///< of mass, in the world, m
    Vec3 momentum{0, 0, 0};  ///< N s
    Vec3 spin{0, 0, 0};      ///< angular momentum about the centre, N m s
    double kinetic = 0;      ///< energy beside the centre's, J
    template <class Archive>
    void serialize(Archive& archive) {
      archive(known, mass, centre, momentum, spin, kinetic);
    }
    /// Angular momentum about a point.
    Vec3 about(const Vec3& point) const { return spin + (centre - point).cross(momentum); }
    /// With another cloth's; unknown if one of them is.
    void join(const Motion& other);
  };
  /// What comes from outside in a substep.
  struct Input {
    Vec3 force{0, 0, 0};                                ///< of the effects, N
    Vec3 torque{0, 0, 0};                               ///< of the effects, about `centre`, N m
    double work = 0;                                    ///< of the effects, J
    Vec3 moved{0, 0, 0};                                ///< the nodes' ways, each by its mass, kg m
    Vec3 momentum{0, 0, 0}, angular_momentum{0, 0, 0};  ///< that bodies gave, N s; about `centre`, N m s
    double energy = 0;                                  ///< that they lost, J
    void operator+=(const Input& other);
  };
  static Motion motion_of(const Particles<Real>& particles);
  static bool applies(const Particles<Real>& particles, const Forces<Real>& forces);
  /// A solid that yields touches the cloth.
  static bool touched_by_body(const std::vector<Solid>& solids, const Contact<Real>* contact);
  /// Something draws it to a place, other than to solids that yield.
  static bool is_drawn(const Member& member);
  /// Moves all by `shift`, m, and by `turn`, rad, about the centre.
  static void go_on(Particles<Real>& particles, const Vec3& centre, const Vec3& shift, const Vec3& turn);
  Input input(const Member& member, const Vec3& centre);
  /// The rigid motion that is missing where these momenta are, N s and N m s about the centre: what damps it
  /// in `h`, s, takes its part of them. Without, what wind that hardly turned within a solve has not yet
  /// given would be given at one blow, and speed a light cloth up beyond any bound.
  static Freedom::Screw response(std::span<const Member> members, const Motion& end,
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
