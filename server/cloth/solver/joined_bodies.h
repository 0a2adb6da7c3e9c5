#pragma once
#include <Eigen/Core>
#include <memory>
#include <vector>

namespace weft {

/// Solves for bodies that stiff springs join in pairs, each of six unknowns: its centre's move and its turn.
/// Sparse Cholesky factors of blocks of six by six (Eigen::SimplicialLDLT), which piles fill but little.
class JoinedBodies {
 public:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  /// stiffness (on_a . x_a - on_b . x_b)^2 / 2 is its energy, J.
  struct Joint {
    std::size_t a, b;    ///< bodies, not the same
    Vector6 on_a, on_b;  ///< what the spring is lengthened by, m, as they move by 1 m or turn by 1 rad
    double stiffness;    ///< N/m
  };

  JoinedBodies();
  ~JoinedBodies();
  JoinedBodies(const JoinedBodies& other);
  JoinedBodies& operator=(const JoinedBodies& other);

  /// `own`, by body: positive definite, what it has without joints.
  void factorise(const std::vector<Matrix6>& own, const std::vector<Joint>& joints);
  /// The moves by these forces and torques, N and N m, by body; after factorise.
  void solve(std::vector<Vector6>& forces) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft
