#pragma once
#include <vector>

#include "cloth/bodies/body_contact.h"

namespace weft {

/// A solid among others, as contact between them sees it.
struct MovingBody {
  double inverse_mass = 0;  ///< 1/kg; 0: it goes as it goes
  /// About its centre, in the world, 1/(kg m2).
  Eigen::Matrix3d inverse_inertia = Eigen::Matrix3d::Zero();
  Vec3 velocity{0, 0, 0};  ///< m/s
  Vec3 spin{0, 0, 0};      ///< rad/s
  Vec3 shift{0, 0, 0};     ///< out of what it overlaps, without motion, m
  Vec3 turn{0, 0, 0};      ///< the same, rad
};

/// Finds the impulses with which no two bodies come nearer, in a step of dt seconds, than the gap between
/// them: sequential impulses, which are projected Gauss-Seidel sweeps over the contacts in their order, with
/// Coulomb friction and no restitution (Catto, Iterative Dynamics with Temporal Coherence, GDC 2005; gaps
/// ahead as in his Continuous Collision, GDC 2013). What takes no way into a gap loses no speed; what
/// overlaps is shifted apart by a share of it, which gives no speed. All impulses together take energy: of
/// bodies that nothing else moves there is never more.
///
/// The sweeps start from the impulses that the contacts are told. Where they were too few to take back what
/// of those is wrong, and all contacts together would give energy, all start again from nothing.
///
/// Where there is no way that all contacts allow, as of a body between the ground and a press that leaves
/// less room than it has, the firm ones, which come last, are kept and the others overlap.
///
/// Returns the impulses, contact by contact.
std::vector<BodyImpulse> resolve(const std::vector<BodyContact>& contacts, std::vector<MovingBody>& bodies,
                                 double dt);

}  // namespace weft
