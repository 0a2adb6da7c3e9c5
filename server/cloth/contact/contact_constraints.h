#pragma once
#include "cloth/contact/contact.h"
#include "cloth/kernels/link_kernels.h"

namespace weft {

/// Contacts as a part of an implicit step's linear system. A node that touches a solid or will in the step is
/// held to its surface along the normal by a spring so stiff that it hardly gives, and dragged along with the
/// solid by Coulomb friction: a force of at most friction times the normal force, that of the step before. A
/// spring that turns out to pull is taken away. What little the others give, and nodes that were not
/// expected, Contact::resolve puts right after the step.
template <class Real>
class ContactConstraints {
 public:
  /// Nodes that touch or will, with forces from the last step; positions and velocities as the substep
  /// begins.
  void begin(const std::vector<Touch>& touches, const Particles<Real>& particles,
             const std::vector<Solid>& solids, const Substep& substep);
  void clear() { constraints_.clear(); }
  bool empty() const { return constraints_.empty(); }

  /// Adds the constraints to the system of a Newton iteration at `move`. `links_stiffness` is the sum of the
  /// link stiffnesses at a node, N/m, and `diagonal` the system's: together they set how stiff the springs
  /// are.
  void add_to(kernels::Blocks<Real> blocks, kernels::Components<Real> b, const Real* diagonal,
              double links_stiffness, kernels::Components<const Real> move);
  /// Takes away, for the rest of the substep, the constraints that pull their node to the solid at `move`.
  /// Returns the energy that was in their springs, J.
  double release_pulling(kernels::Components<const Real> move);
  /// Reads the forces off the solution and adds the share of momentum of solids that yield to `impulses`.
  void finish(kernels::Components<const Real> move, const std::vector<Solid>& solids,
              std::vector<Vec3>& impulses);
  /// Takes from the velocities what leading nodes out of solids gave them: that is no motion.
  void keep_velocities(kernels::Components<Real> velocity) const;

  /// Calls visit(node index) for every constrained node.
  template <class Visit>
  void for_each_node(Visit visit) const {
    for (const Constraint& constraint : constraints_) visit(constraint.touch.node);
  }

 private:
  struct Constraint {
    Touch touch;
    std::size_t solid;  ///< index
    Vec3 normal;
    double distance;                ///< that the node must move along the normal, m
    double led_out;                 ///< of which it is led out of the solid, m
    Vec3 solid_move;                ///< in the substep, m
    double holds;                   ///< at most, by friction, N
    double sliding;                 ///< along the surface in the substep, if it goes on as before, m
    double stiffness = 0;           ///< N/m
    double friction_stiffness = 0;  ///< N/m
    double force = 0;               ///< along the normal, N
    bool released = false;
  };
  std::vector<Constraint> constraints_, last_;
  double seconds_ = 0;  ///< of the substep
};

extern template class ContactConstraints<float>;
extern template class ContactConstraints<double>;

}  // namespace weft
