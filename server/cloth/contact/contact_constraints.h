#pragma once
#include "cloth/contact/contact.h"
#include "cloth/kernels/link_kernels.h"

namespace weft {

/// Contacts as a part of an implicit step's linear system. A node that touched a solid at the end of the last
/// step is held to its surface along the normal by a spring so stiff that it hardly gives, and dragged along
/// with the solid by Coulomb friction: a force of at most friction times the normal force, that of the step
/// before. What little the spring gives, and nodes that arrive, Contact::resolve puts right after the step; a
/// node whose solid leaves it is free.
template <class Real>
class ContactConstraints {
 public:
  /// Nodes that touched, with forces from the last step; positions and velocities as the substep begins.
  void begin(const std::vector<Touch>& touches, const Particles<Real>& particles,
             const std::vector<Solid>& solids, const Substep& substep);
  void clear() { constraints_.clear(); }
  bool empty() const { return constraints_.empty(); }

  /// Adds the constraints to the system of a Newton iteration at `move`. `links_stiffness` is the sum of the
  /// link stiffnesses at a node, N/m, and `diagonal` the system's: together they set how stiff the springs
  /// are.
  void add_to(kernels::Blocks<Real> blocks, kernels::Components<Real> b, const Real* diagonal,
              double links_stiffness, kernels::Components<const Real> move);
  /// Reads the forces off the solution and adds the share of momentum of solids that yield to `impulses`.
  void finish(kernels::Components<const Real> move, const std::vector<Solid>& solids,
              std::vector<Vec3>& impulses);

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
    Vec3 solid_move;                ///< in the substep, m
    double holds;                   ///< at most, by friction, N
    double sliding;                 ///< along the surface in the substep, if it goes on as before, m
    double stiffness = 0;           ///< N/m
    double friction_stiffness = 0;  ///< N/m
    double force = 0;               ///< along the normal, N
  };
  std::vector<Constraint> constraints_, last_;
  double seconds_ = 0;  ///< of the substep
};

extern template class ContactConstraints<float>;
extern template class ContactConstraints<double>;

}  // namespace weft
