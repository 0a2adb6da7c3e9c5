#pragma once
#include <algorithm>
#include <optional>

#include "cloth/contact/recovery/contact.h"
#include "cloth/kernels/link_kernels.h"
#include "cloth/solver/attached_bodies.h"
#include "cloth/solver/node_couplings.h"
#include "cloth/solver/one_sided_springs.h"

namespace weft {

/// The solid that the node touches, one of these.
inline const Solid& solid_of(const Touch& touch, const std::vector<Solid>& solids) {
  return *std::find_if(solids.begin(), solids.end(),
                       [&](const Solid& each) { return each.id == touch.collider; });
}

/// Contacts as a part of an implicit step's linear system. A node that touches a solid or will in the step is
/// held to its surface along the normal by a spring so stiff that it hardly gives, and dragged along with the
/// solid by Coulomb friction: a force of at most friction times the normal force, that of the steps before. A
/// spring that turns out to pull is taken away. Near rest a node that sticks goes on with the force that held
/// it: found anew in each step it would have to slip for it each time, and a drape would creep. What little
/// the others give, and nodes that were not expected, Contact::resolve puts right after the step.
///
/// A solid that yields hangs on its nodes by these springs: it is one of the system's bodies, stepped by
/// backward Euler as they are. Held for a body that nothing moves, and given the impulses afterwards, one
/// that is heavier than they are would gain energy without bound.
///
/// Between two solids that leave it no room a node is held by the one that moves least, as Contact::resolve
/// does: both would squeeze it out sideways and stretch its springs without doing work. It is not released
/// there, whatever pulls: it would enter the other solid and be projected out after each step.
///
/// Nodes that will meet a solid in the step are held to its surface from the start, and those that a Newton
/// iteration has put into one from the next on: put there after the step they would stretch their springs at
/// nobody's cost.
///
/// A point between nodes (points_between) is held as a node is, by a spring that couples its nodes.
///
/// A tangent plane stands for its solid only as far as that is wide (kSlidOff): a node that is drawn along it
/// past the solid's side has slid off, and is let go.
template <class Real>
class ContactConstraints {
 public:
  /// Nodes that touch or will, and those that arrive at a solid that yields, with forces from the last step;
  /// positions and velocities as the substep begins. The cloth may be near rest. `bodies` become the solids
  /// that yield and are touched.
  void begin(const std::vector<Touch>& touches, const std::vector<Arrival>& arrivals,
             const Particles<Real>& particles, const std::vector<Solid>& solids, const Substep& substep,
             bool near_rest, AttachedBodies<Real>& bodies);
  /// Between Newton iterations: holds the nodes that are inside at `move` and not held yet, if it takes more
  /// energy than `missed`, J, to push them out one by one against links of this stiffness at a node, N/m.
  /// False if it holds no more than before.
  bool hold_inside(const std::vector<Touch>& inside, const Particles<Real>& particles,
                   const std::vector<Solid>& solids, kernels::Components<const Real> move,
                   AttachedBodies<Real>& bodies, double links_stiffness, double missed);
  /// The solids as they go by the system's solution so far.
  std::vector<Solid> bent(std::vector<Solid> solids, const AttachedBodies<Real>& bodies) const;
  /// Between Newton iterations: lets go of the nodes that lay on a solid when the substep began and at `move`
  /// have slid off its side. False if there are none.
  bool let_go_of_slid_off(const Particles<Real>& particles, const std::vector<Solid>& solids,
                          kernels::Components<const Real> move, const AttachedBodies<Real>& bodies);
  /// What lay on a solid when the substep began and is not held to it, as it leaves or has slid off; ordered.
  const std::vector<Touch>& not_held() const { return not_held_; }
  /// After finish: what was held on its side of a body, or of what stands firm if it went less than half
  /// through it, or came off on that side; ordered.
  const std::vector<Touch>& kept_aside() const { return kept_aside_; }
  /// After finish: what impacts and friction took from the cloth in the substep, J.
  double taken(kernels::Components<const Real> move, const AttachedBodies<Real>& bodies) const;
  /// After finish: something that stands firm pushed the cloth in the substep.
  bool pushed_by_firm() const {
    return std::any_of(constraints_.begin(), constraints_.end(),
                       [](const Constraint& c) { return !c.body && c.force > 0; });
  }
  void clear() {
    constraints_.clear();
    not_held_.clear();
  }
  bool empty() const { return constraints_.empty(); }
  /// The cloth tore: where a point between nodes was held may be a hole.
  void forget_points_between() {
    std::erase_if(constraints_, [](const Constraint& c) { return c.touch.point().between_nodes(); });
  }

  /// Adds the constraints to the system of a Newton iteration at `move`. `links_stiffness` is the sum of the
  /// link stiffnesses at a node, N/m, and `diagonal` the system's: together they set how stiff the springs
  /// are, held to what the masses of torn pieces bear, `piece_mass`, kg, by node; empty if it is whole.
  void add_to(kernels::Blocks<Real> blocks, NodeCouplings<Real>& couplings, kernels::Components<Real> b,
              AttachedBodies<Real>& bodies, const Real* diagonal, double links_stiffness,
              const std::vector<double>& piece_mass, kernels::Components<const Real> move);
  /// Appends the constraints as they are at `move` along `change`.
  void append_springs(kernels::Components<const Real> move, kernels::Components<const Real> change,
                      const AttachedBodies<Real>& bodies, std::vector<OneSidedSpring>& springs) const;
  /// Takes away the constraints that pull their node to the solid at `move`, and brings back those without
  /// which a node is inside. Returns the energy of their springs, J.
  double release_pulling(kernels::Components<const Real> move, const AttachedBodies<Real>& bodies);
  /// Reads the forces off the solution, and the ways of solids that yield. Returns the nodes pressed onto
  /// those, in their order.
  const std::vector<Touch>& finish(kernels::Components<const Real> move, const AttachedBodies<Real>& bodies,
                                   std::vector<Solid>& solids);
  /// Takes from the velocities what leading nodes out of solids gave them: that is no motion.
  void keep_velocities(kernels::Components<Real> velocity) const;

  /// Calls visit(node index) for every constrained node, and those of every constrained point.
  template <class Visit>
  void for_each_node(Visit visit) const {
    for (const Constraint& constraint : constraints_) {
      constraint.point.for_each_node([&](std::size_t node, double) { visit(node); });
    }
  }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(constraints_, last_, pressed_, not_held_, kept_aside_, yielding_, substep_, near_rest_);
  }

 private:
  struct Constraint {
    Touch touch;
    ClothPoint<Real> point;   ///< that touches
    std::optional<int> body;  ///< index
    Vec3 arm;                 ///< where the node hangs on the body, from its centre, m; 0: by it
    Vec3 normal;
    double distance;                ///< that the node must move along the normal, m
    double led_out;                 ///< of which it is led out of the solid, where it began, m
    Vec3 solid_move;                ///< in the substep if nothing bends its way, m
    double holds;                   ///< at most, by friction, N
    double slid;                    ///< along the surface in the substep, if it goes on as before, m
    double sliding;                 ///< that is expected, m
    double width;                   ///< of the solid, its inner radius, m
    double approach;                ///< to the solid, along the normal, as the substep begins, m/s
    double stiffness = 0;           ///< N/m
    double friction_stiffness = 0;  ///< N/m
    double force = 0;               ///< along the normal, N
    /// In the last step and the one before; negative where it did not touch yet, N.
    double last_force = -1, force_before = -1;
    bool has_stuck = false;  ///< since it touches
    /// By how much farther it slid in this step, and in the last one, than if it had gone on as it went, m.
    double gained = 0, gained_before = 0;
    double speeding_up = 0;  ///< then: by how much more it will slide by what pulls at it, m
    bool released = false;
    bool pinched = false;  ///< held both ways: another solid keeps the node from leaving this one
    Vec3 grip{0, 0, 0};    ///< of static friction when the substep begins; after finish, when it ends, N

    template <class Archive>
    void serialize(Archive& archive) {
      archive(touch, point, body, arm, normal, distance, led_out, solid_move, holds, slid, sliding, width,
              approach, stiffness, friction_stiffness, force, last_force, force_before, has_stuck, gained,
              gained_before, speeding_up, released, pinched, grip);
    }
    /// What friction goes by: the median of three steps' forces, the lesser of two, N.
    double usual_force() const;
    bool sticks() const { return friction_stiffness > 0 && friction_stiffness == stiffness; }
  };
  /// The force along the surface at `moved`, N.
  static Vec3 friction(const Constraint& c, const Vec3& moved);
  static bool is_before(const Constraint& c, const Touch& touch);
  void sort_by_touch();
  bool holds_already(const Touch& touch, const Vec3& normal) const;
  /// `place` is the point's when the substep begins, `way` its move that `surface` was looked up for.
  Constraint held_by(const Touch& touch, const ClothPoint<Real>& point, const Solid& solid,
                     const Surface& surface, const Vec3& place, const Vec3& way) const;
  /// By how much more than `slid`, m, a node that has stuck will slide in the substep by what pulled at it in
  /// the last one, when `last` held it, but for a friction of `holds`, N.
  double speeding_up(const Constraint& last, double slid, double holds, double mass) const;
  void let_go_of_pinched(kernels::Components<const Real> velocity);
  /// It did when the substep began, when the node was there.
  bool lay_on(const Solid& solid, const Vec3& place) const;
  /// Going on as it goes, the node comes out on the other side: it does not leave the solid by that.
  bool flies_through(const Solid& solid, const Vec3& place, const Vec3& to) const;
  /// The body that the solid is, a new one if need be; none if it does not yield.
  std::optional<int> body_of(const Solid& solid, const std::vector<Solid>& solids,
                             AttachedBodies<Real>& bodies);
  static Vec3 move_of(const Constraint& c, kernels::Components<const Real> move,
                      const AttachedBodies<Real>& bodies);

  std::vector<Constraint> constraints_, last_;
  std::vector<Touch> pressed_, not_held_, kept_aside_;
  std::vector<std::size_t> yielding_;  ///< solid of each body, index
  Substep substep_;
  bool near_rest_ = false;
};

extern template class ContactConstraints<float>;
extern template class ContactConstraints<double>;

}  // namespace weft
