#pragma once
#include <vector>

#include "cloth/kernels/components.h"
#include "cloth/vec3.h"

namespace weft {

/// Free bodies that hang on nodes by springs, as unknowns of an implicit step's linear system beside the
/// nodes'. With x the nodes' change, w a body's, K_i the stiffness of its spring to node i, which A holds,
/// too, C x = sum K_i x_i and D its mass / h^2:
///     A x - C^T w = b,   S w - C x = r,   S = D + sum K_i.
/// The three unknowns of each body are eliminated (Schur complement): w = S^-1 (r + C x), so that
///     (A - C^T S^-1 C) x = b + C^T S^-1 r,
/// symmetric and positive definite as the whole is. A is an upper bound of it that is off in three directions
/// a body, so a preconditioner of A serves: conjugate gradients need about three more iterations a body.
template <class Real>
class AttachedBodies {
 public:
  bool empty() const { return bodies_.empty(); }
  /// No bodies.
  void clear();
  /// Another body, of this mass / h^2, N/m. Returns its index.
  int add(double inertia);
  /// All are where they are without springs.
  void reset();

  /// A system is assembled as follows: detach(), attach() for every spring, eliminate().
  void detach();
  /// Hangs a body on a node by a spring that now pulls the node with `force`, N.
  void attach(int body, std::size_t node, const Eigen::Matrix3d& stiffness, const Vec3& force);
  /// b += C^T S^-1 r.
  void eliminate(kernels::Components<Real> b);

  /// y -= C^T S^-1 C x; returns x . of what was added.
  double multiply(kernels::Components<const Real> x, kernels::Components<Real> y) const;

  /// Their changes that belong to the nodes'. Returns by how much the elimination alone lowers the energy x .
  /// A x / 2 - b . x of the whole, J; never below 0.
  double find_changes(kernels::Components<const Real> x);
  /// Takes a share of the changes.
  void scale_changes(double share);
  void take_changes();
  /// Of a body, beyond its move without springs, m.
  const Vec3& move(int body) const { return bodies_[static_cast<std::size_t>(body)].move; }
  /// Of a body, that find_changes found, m.
  const Vec3& change(int body) const { return bodies_[static_cast<std::size_t>(body)].change; }

 private:
  struct Body {
    double inertia;
    Vec3 move{0, 0, 0}, change{0, 0, 0};
    Vec3 force{0, 0, 0};  ///< r
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();  ///< of S
  };
  struct Spring {
    std::size_t body, node;
    Eigen::Matrix3d stiffness;
  };
  std::vector<Body> bodies_;
  std::vector<Spring> springs_;
  mutable std::vector<Vec3> sums_;  ///< work space of multiply
};

extern template class AttachedBodies<float>;
extern template class AttachedBodies<double>;

}  // namespace weft
