#include "cloth/solver/joined_bodies.h"

#include <Eigen/SparseCholesky>

namespace weft {

struct JoinedBodies::Impl {
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors;
};

JoinedBodies::JoinedBodies() = default;
JoinedBodies::~JoinedBodies() = default;
// Factors serve one system, which a copy makes for itself.
JoinedBodies::JoinedBodies(const JoinedBodies&) {}
JoinedBodies& JoinedBodies::operator=(const JoinedBodies&) { return *this; }

void JoinedBodies::factorise(const std::vector<Matrix6>& own, const std::vector<Joint>& joints) {
  if (!impl_) impl_ = std::make_unique<Impl>();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(36 * (own.size() + 4 * joints.size()));
  const auto add = [&](std::size_t row, std::size_t col, const Matrix6& block) {
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j)
        entries.emplace_back(6 * static_cast<int>(row) + i, 6 * static_cast<int>(col) + j, block(i, j));
    }
  };
  for (std::size_t body = 0; body < own.size(); ++body) add(body, body, own[body]);
  for (const Joint& joint : joints) {
    const Vector6 by_a = joint.stiffness * joint.on_a, by_b = joint.stiffness * joint.on_b;
    add(joint.a, joint.a, by_a * joint.on_a.transpose());
    add(joint.b, joint.b, by_b * joint.on_b.transpose());
    add(joint.a, joint.b, -by_a * joint.on_b.transpose());
    add(joint.b, joint.a, -by_b * joint.on_a.transpose());
  }
  const auto size = static_cast<Eigen::Index>(6 * own.size());
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  impl_->factors.compute(matrix);
}

void JoinedBodies::solve(std::vector<Vector6>& forces) const {
  Eigen::Map<Eigen::VectorXd> all(forces.front().data(), static_cast<Eigen::Index>(6 * forces.size()));
  all = impl_->factors.solve(all).eval();
}

}  // namespace weft
