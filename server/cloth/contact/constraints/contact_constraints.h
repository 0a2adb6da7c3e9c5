#pragma once
#include <algorithm>
#include <optional>

#include "cloth/contact/constraints/body_spring.h"
#include "cloth/contact/constraints/surface_friction.h"
#include "cloth/contact/recovery/contact.h"
#include "cloth/kernels/link_kernels.h"
#include "cloth/sheet/freedom.h"
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
/// held off its surface along the normal by a spring, and dragged along with the solid by Coulomb friction
/// (SurfaceFriction). A spring that turns out to pull is taken away. Nodes that were not expected
/// Contact::resolve puts outside after the step.
///
/// A spring is as stiff as it must be to bear what it bore in the last steps by a small depth, no stiffer:
/// what it holds then is far more than the error that a solve may leave, so that the normal force, by which
/// friction goes, is known. It bears within a margin outside of the surface: what is not in a solid need not
/// be put out of it after the step, which would strain the cloth's springs. Near rest it keeps its stiffness
/// as long as it bears within the margin: one that followed each step's force would do work by that, and
/// shake the cloth for ever.
///
/// A solid that yields hangs on its nodes by these springs: it is one of the system's bodies, stepped by
/// backward Euler as they are. Its springs are stiff, without a margin, and friction on it has no memory
/// but near rest: what a force that no solve tells would keep shakes a pile for ever. Held for a body that
/// nothing moves, and given the impulses afterwards, one that is heavier than they are would gain energy
/// without bound.
///
/// Between two solids that leave it no room a node is held by the one that moves least, as Contact::resolve
/// does: both would squeeze it out sideways and stretch its springs without doing work. It is not released
/// there, whatever pulls: it would enter the other solid and be projected out after each step.
///
/// Nodes that will meet a solid in the step are held to its surface from the start, and those that a Newton
/// iteration has put into one, or through a fast one, from the next on: put outside after the step they would
/// stretch their springs without anything doing the work.
///
/// A point between nodes (points_between) is held as a node is, by a spring that couples its nodes.
///
/// A tangent plane stands for its solid only as far as that is wide (is_off_side): a node that is drawn along
/// it past the solid's side has slid off, and is let go.
///
/// A node must begin on the plane's outer side, or the plane pushes it on past where it came from, which does
/// work. So the plane is that of the surface next to the way's end only if the surface turns but little from
/// the way's begin until there (kTurned); else the one where the way enters, or where the node lies. What
/// begins inside a body, which another has moved there, is led out by the surface next to the way's end.
template <class Real>
class ContactConstraints {
 public:
  /// Nodes that touch or will, and those that arrive at a solid that yields, with forces from the last step;
  /// positions and velocities as the substep begins. The cloth may be near rest. `bodies` become the solids
  /// that yield and are touched.
  void begin(const std::vector<Touch>& touches, const std::vector<Arrival>& arrivals,
             const Particles<Real>& particles, const std::vector<Solid>& solids, const Substep& substep,
             bool near_rest, AttachedBodies<Real>& bodies);
  /// After begin: springs as the substep begins, with places as they will be at its end if nothing bends the
  /// solids' ways. The effects have the springs' forces on the nodes for such ways, and the system their
  /// stiffness there: here the solids, too, are pulled, in the same system.
  void hang(const std::vector<BodySpring>& springs, const Particles<Real>& particles,
            const std::vector<Solid>& solids, AttachedBodies<Real>& bodies);
  bool hangs() const { return !hung_.empty(); }
  /// After begin and hang, and again when more is held: what bodies of the system touch becomes a part of it,
  /// and other bodies that they touch.
  void join(const std::vector<BodyTouch>& touches, const std::vector<Solid>& solids,
            AttachedBodies<Real>& bodies);
  bool joins() const { return !joined_.empty(); }
  /// After finish: adds to the touches' impulses, N s. True if what stands firm pushed a body.
  bool add_impulses(const AttachedBodies<Real>& bodies, std::vector<BodyTouch>& touches) const;
  /// The cloth's share of its mass and that of the solids that hang on it together; 1 without any.
  double hung_share(double mass, const std::vector<Solid>& solids) const;
  /// After finish: the torque of what hangs on the cloth beside that of the same forces at the solids'
  /// centres, N m. Of solids that do not turn, whose places are as far from their centres as they were.
  Vec3 torque_beside_centres(kernels::Components<const Real> move, const Particles<Real>& particles,
                             const std::vector<Solid>& solids, const AttachedBodies<Real>& bodies) const;
  /// Between Newton iterations: holds the nodes that are inside at `move`, or have passed a surface by it,
  /// and are not held yet, if it takes more energy than `missed`, J, to push them out one by one against
  /// links of this stiffness at a node, N/m. False if it holds no more than before.
  bool hold_inside(const std::vector<Touch>& inside, const std::vector<Arrival>& passed,
                   const Particles<Real>& particles, const std::vector<Solid>& solids,
                   kernels::Components<const Real> move, AttachedBodies<Real>& bodies, double links_stiffness,
                   double missed);
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
  /// Energies by which the last system misjudges contact, J.
  struct Misjudged {
    double all = 0;    ///< friction, and springs that were too weak to keep their node out of the solid
    double begun = 0;  ///< of that what begins with this substep or began with the last, on what stands firm
  };
  Misjudged error(kernels::Components<const Real> move, const AttachedBodies<Real>& bodies) const;
  /// Nodes' velocities as a substep begins and ends, m/s, and by how many seconds their places run ahead of
  /// them (EnergyLedger; null if none does).
  struct Velocities {
    kernels::Components<const Real> start, end;
    const Real* lead;
  };
  /// J, in a substep.
  struct Work {
    double taken = 0;    ///< by friction, as Coulomb's law has it at the end, by the normal forces of what
                         ///< lasts, and by impacts
    double led_out = 0;  ///< what leading nodes out may have brought in besides
  };
  /// After finish and keep_velocities: what contact did to the cloth.
  Work work(kernels::Components<const Real> move, const Velocities& velocities,
            const AttachedBodies<Real>& bodies) const;
  /// After finish: what stands firm and pushed the cloth in the substep.
  struct Firm {
    std::vector<Push> pushes;  ///< in the world
    bool rubs = false;         ///< with friction
  };
  /// Its own constraints, and what else the cloth touches now, at the substep's end.
  Firm firm(const std::vector<Touch>& touches, const Particles<Real>& particles,
            const std::vector<Solid>& solids) const;
  void clear() {
    constraints_.clear();
    not_held_.clear();
    yielding_.clear();
    hung_.clear();
    joined_.clear();
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
  /// Reads the forces off the solution, and the ways of solids that yield. Returns the nodes that are pressed
  /// onto solids, in their order.
  const std::vector<Touch>& finish(kernels::Components<const Real> move, const AttachedBodies<Real>& bodies,
                                   std::vector<Solid>& solids);
  /// Takes from the velocities what leading nodes out of solids that stand firm gave them: that is no motion.
  void keep_velocities(kernels::Components<Real> velocity) const;

  /// Calls visit(node index) for every constrained node, and those of every constrained point, whose motion
  /// contact breaks in this substep: all but what firm solids have pressed upon in the last two; and those of
  /// springs on bodies, which are stepped by backward Euler.
  template <class Visit>
  void for_each_broken(Visit visit) const {
    for (const Constraint& c : constraints_) {
      if (!c.lasts()) c.point.for_each_node([&](std::size_t node, double) { visit(node); });
    }
    for (const Hung& hung : hung_) visit(hung.spring.node);
  }
  /// After finish: what touches so moves smoothly in the next substep, too, if contact goes on.
  bool goes_on(const Touch& touch) const {
    const auto c = std::lower_bound(constraints_.begin(), constraints_.end(), touch, is_before);
    return c != constraints_.end() && c->touch == touch && c->goes_on();
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
    double distance;  ///< that the node must move along the normal, m
    double led_out;   ///< of which it is led out of the solid, where it began, m
    double curves;    ///< of the point's way along the normal, what the surface itself curves by, m
    Vec3 solid_move;  ///< in the substep if nothing bends its way, m
    double width;     ///< of the solid, its inner radius, m
    Vec3 face;        ///< the normal along the solid's own axes
    double stiffness = 0, most = 0;  ///< as it is or last was, and may become, N/m
    double force = 0;                ///< along the normal, N
    /// In the last step and the one before; negative where it did not touch yet, N.
    double last_force = -1, force_before = -1;
    bool released = false;
    bool pinched = false;    ///< held both ways: another solid keeps the node from leaving this one
    bool solved = false;     ///< in this substep, once
    double coefficient = 0;  ///< of friction
    SurfaceFriction friction{};

    template <class Archive>
    void serialize(Archive& archive) {
      archive(touch, point, body, arm, normal, distance, led_out, curves, solid_move, width, face, stiffness,
              most, force, last_force, force_before, released, pinched, solved, coefficient, friction);
    }
    /// The lesser of the last two forces, since one may be an impact's; 0 if there were not two, N.
    double usual_force() const { return std::max(0.0, std::min(last_force, force_before)); }
    /// A firm solid pressed upon it in the last two steps: since the first of them its motion is smooth.
    bool lasts() const { return !body && usual_force() > 0; }
    bool goes_on() const { return !body && force > 0 && last_force > 0; }
    /// Along the surface, as it has moved, m.
    Vec3 slip(const Vec3& moved) const { return across(moved - solid_move, normal); }
    /// Along the normal as it has moved, N.
    double force_at(const Vec3& moved) const;
    /// The most that friction holds as it has moved, N.
    double holds(const Vec3& moved) const;
  };
  struct Hung {
    BodySpring spring;
    ClothPoint<Real> point;
    int body;
  };
  static bool is_before(const Constraint& c, const Touch& touch);
  /// As it was in the last substep, or null.
  const Constraint* as_last(const Touch& touch) const {
    const auto last = std::lower_bound(last_.begin(), last_.end(), touch, is_before);
    return last != last_.end() && last->touch == touch ? &*last : nullptr;
  }
  void sort_by_touch();
  bool holds_already(const Touch& touch, const Vec3& normal) const;
  /// To which what usually presses a contact's spring presses it, and from where it bears, m.
  double depth() const;
  double margin() const;
  /// The plane that holds what goes from `place` to `end`, next to which the surface is `near`: as seen from
  /// the end. None if that passes the solid by.
  std::optional<Surface> plane_for(const Solid& solid, const Surface& near, const Vec3& place,
                                   const Vec3& end) const;
  /// `near`, or for what lay on a body in the last substep and is now inside, next to another face: that
  /// which it lay on. Another body has moved this one since; out of the other face it would be drawn around
  /// an edge.
  Surface as_before(const Touch& touch, const Solid& solid, const Surface& near, const Vec3& end) const;
  /// `place` is the point's when the substep begins, `way` its move that `surface` was looked up for.
  Constraint held_by(const Touch& touch, const ClothPoint<Real>& point, const Solid& solid,
                     const Surface& surface, const Vec3& place, const Vec3& way) const;
  /// Sets how stiff the spring of a point that has moved so is in the next linear system; `links` is the
  /// stiffness of the links there, `inertia` the point's resistance to a move, N/m.
  void stiffen(Constraint& c, const Vec3& moved, double links, double inertia) const;
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
  std::vector<Hung> hung_;
  std::vector<std::size_t> joined_;  ///< touches in the system, indices
  Substep substep_;
  bool near_rest_ = false;
};

extern template class ContactConstraints<float>;
extern template class ContactConstraints<double>;

}  // namespace weft
