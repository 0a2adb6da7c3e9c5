#pragma once
#include <optional>
#include <vector>

#include "cloth/core/vec3.h"
#include "cloth/sheet/cloth_point.h"
#include "cloth/solver/joined_bodies.h"
#include "cloth/solver/one_sided_springs.h"

namespace weft {

/// A spring that holds two bodies apart, or one off what stands firm, along the normal where they touch.
struct BodyPush {
  std::size_t id = 0;  ///< whoever sets it again knows it by this
  int a = 0;
  std::optional<int> b;  ///< none: it stands firm
  Vec3 arm_a{0, 0, 0};   ///< of the place from a's centre, m
  Vec3 arm_b{0, 0, 0};   ///< the same from b's
  Vec3 normal{0, 1, 0};  ///< unit, from b to a
  double overlap = 0;    ///< with the moves that they have without springs, m; below 0 they are apart
  double stiffness = 0;  ///< N/m
  bool touches = true;   ///< the first system holds them together: what lies on another mostly stays on it
};

/// Free bodies that hang on nodes by springs, as unknowns of an implicit step's linear system beside the
/// nodes'. With x the nodes' change, w a body's: of its centre and its small turn, G_i w what the point moves
/// by that its spring to node i hangs on, K_i the stiffness of that spring, which A holds, too, C x = sum
/// G_i^T K_i x_i and D its mass and its inertia / h^2:
///     A x - C^T w = b,   S w - C x = r,   S = D + sum G_i^T K_i G_i.
/// The six unknowns of each body are eliminated (Schur complement): w = S^-1 (r + C x), so that
///     (A - C^T S^-1 C) x = b + C^T S^-1 r,
/// symmetric and positive definite as the whole is. A is an upper bound of it that is off in six directions a
/// body, three of one that hangs by its centre, so a preconditioner of A serves: conjugate gradients need
/// about as many more iterations.
///
/// Bodies that touch one another are held apart in the same system (BodyPush): S then joins them.
template <class Real>
class AttachedBodies {
 public:
  bool empty() const { return bodies_.empty(); }
  /// No bodies.
  void clear();
  /// Another body, of this mass / h^2, N/m, and this inertia about its centre / h^2, N m. Returns its index.
  /// One whose springs all hang by its centre does not turn, whatever its inertia.
  int add(double inertia, const Eigen::Matrix3d& turning_inertia = Eigen::Matrix3d::Identity());
  /// All are where they are without springs.
  void reset();
  int count() const { return static_cast<int>(bodies_.size()); }
  /// Replaces the springs between bodies; what was told of one of the same id goes on.
  void set_pushes(const std::vector<BodyPush>& pushes);
  /// Appends these springs as they are, along the change that find_changes found.
  void append_springs(std::vector<OneSidedSpring>& springs) const;
  /// Of those that the last system held although they would pull now, or did not hold although they are
  /// pressed, the energy, J.
  double misjudged() const;
  /// The force of each, N, in the order in which they were set.
  std::vector<double> push_forces() const;
  /// This one is held off what stands firm.
  bool pushed_by_firm(std::size_t push) const { return !pushes_[push].spring.b; }

  /// A system is assembled as follows: detach(), attach() for every spring, eliminate().
  void detach();
  /// Hangs a body on a node, or a point between nodes, at `arm` from its centre, m, by a spring that now
  /// pulls the point with `force`, N.
  void attach(int body, const ClothPoint<Real>& point, const Vec3& arm, const Eigen::Matrix3d& stiffness,
              const Vec3& force);
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
  /// Of what of a body is at `arm` from its centre, beyond its move without springs, m.
  Vec3 move(int body, const Vec3& arm) const { return of(body).move.at(arm); }
  /// The same of the change that find_changes found, m.
  Vec3 change(int body, const Vec3& arm) const { return of(body).change.at(arm); }
  /// Of a body's centre, beyond its move without springs, m.
  const Vec3& move(int body) const { return of(body).move.shift; }
  /// What a body turns by, beyond its turn without springs, rad.
  const Vec3& turn(int body) const { return of(body).move.turn; }

 private:
  /// Of a body: a move of its centre and a turn about it; or a force and a torque.
  struct Screw {
    Vec3 shift{0, 0, 0}, turn{0, 0, 0};
    Vec3 at(const Vec3& arm) const { return shift + turn.cross(arm); }
    void add_force(const Vec3& force, const Vec3& arm) {
      shift += force;
      turn += arm.cross(force);
    }
    double dot(const Screw& other) const { return shift.dot(other.shift) + turn.dot(other.turn); }
  };
  struct Body {
    double inertia = 0;
    Eigen::Matrix3d turning_inertia = Eigen::Matrix3d::Identity();
    Screw move{}, change{};
    Screw force{};  ///< r
    // S but for what joins bodies, and its inverse by blocks.
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();        ///< shift to force, without D
    Eigen::Matrix3d coupling = Eigen::Matrix3d::Zero();         ///< turn to force
    Eigen::Matrix3d turning = Eigen::Matrix3d::Zero();          ///< turn to torque, without D
    Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();          ///< of shift to force
    Eigen::Matrix3d inverse_turning = Eigen::Matrix3d::Zero();  ///< of its Schur complement
    /// A spring to something beside it holds it at `arm`.
    void hold(const Vec3& arm, const Eigen::Matrix3d& by);
    void invert();
    /// S^-1 f.
    Screw solve(const Screw& f) const;
    JoinedBodies::Matrix6 matrix() const;
  };
  struct Push {
    BodyPush spring;
    std::optional<bool> acts;  ///< in the last system; none: there was none
  };
  struct Spring {
    std::size_t body;
    ClothPoint<Real> point;
    Vec3 arm;
    Eigen::Matrix3d stiffness;
  };
  const Body& of(int body) const { return bodies_[static_cast<std::size_t>(body)]; }
  Body& of(int body) { return bodies_[static_cast<std::size_t>(body)]; }
  /// To which it is pressed as the bodies have moved, m; below 0 they are apart.
  double depth(const BodyPush& push) const;
  /// Adds the pushes that act.
  void push_apart();
  /// S^-1 f, by body.
  void solve(std::vector<Screw>& f) const;

  std::vector<Body> bodies_;
  std::vector<Push> pushes_;
  std::vector<JoinedBodies::Joint> joints_;  ///< of the last system
  JoinedBodies joined_;
  std::vector<Spring> springs_;
  mutable std::vector<Screw> sums_, forces_;  ///< work space
};

extern template class AttachedBodies<float>;
extern template class AttachedBodies<double>;

}  // namespace weft
