#include "cloth/solver/joined_bodies.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include "cloth/solver/attached_bodies.h"

namespace weft::test {
namespace {

using Matrix6 = JoinedBodies::Matrix6;
using Vector6 = JoinedBodies::Vector6;

/// Of 2 and 3 kg: stiffness to inertia, N/m.
constexpr double kFirst = 2, kSecond = 3, kStiff = 1e4;

/// The second lies on the first and overlaps it by 1 mm, beside its centre.
AttachedBodies<double> pile() {
  AttachedBodies<double> bodies;
  bodies.add(kFirst);
  bodies.add(kSecond);
  bodies.set_pushes({{.a = 1,
                      .b = 0,
                      .arm_a = {0.1, -0.1, 0},
                      .arm_b = {0.1, 0.1, 0},
                      .normal = {0, 1, 0},
                      .overlap = 1e-3,
                      .stiffness = kStiff}});
  return bodies;
}

/// Assembles, solves and takes the changes.
void solve(AttachedBodies<double>& bodies) {
  bodies.detach();
  bodies.eliminate({});
  bodies.find_changes({});
  bodies.take_changes();
}

}  // namespace

// Against Cholesky factors of the dense matrix: a chain of three, and one that nothing joins.
TEST(JoinedBodies, SolveAsADenseMatrixDoes) {
  std::mt19937 random(1);
  const auto number = [&] { return double(random()) / double(std::mt19937::max()) - 0.5; };
  const auto six = [&] { return Vector6(Vector6::NullaryExpr(number)); };
  std::vector<Matrix6> own(4);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(24, 24);
  for (int i = 0; i < 4; ++i) {
    const Matrix6 root = Matrix6::NullaryExpr(number);
    own[static_cast<std::size_t>(i)] = Matrix6::Identity() + root * root.transpose();
    dense.block<6, 6>(6 * i, 6 * i) = own[static_cast<std::size_t>(i)];
  }
  const std::vector<JoinedBodies::Joint> joints{{0, 1, six(), six(), 100}, {2, 1, six(), six(), 1000}};
  for (const JoinedBodies::Joint& joint : joints) {
    Eigen::VectorXd lengthened = Eigen::VectorXd::Zero(24);
    lengthened.segment<6>(6 * static_cast<int>(joint.a)) = joint.on_a;
    lengthened.segment<6>(6 * static_cast<int>(joint.b)) = -joint.on_b;
    dense += joint.stiffness * lengthened * lengthened.transpose();
  }
  const std::vector<Vector6> forces{six(), six(), six(), six()};
  std::vector<Vector6> moves = forces;
  JoinedBodies joined;
  joined.factorise(own, joints);
  joined.solve(moves);
  const Eigen::VectorXd expected =
      dense.llt().solve(Eigen::Map<const Eigen::VectorXd>(forces.front().data(), 24));
  EXPECT_LT((Eigen::Map<Eigen::VectorXd>(moves.front().data(), 24) - expected).norm(), 1e-12);
}

// The spring's way is its overlap over 1 + stiffness x mobility, of which each body takes its part: 1/2 + 1/3
// by the centres' moves, and 0.1^2 (1 + 1) by turns about inertias of 1.
TEST(JoinedBodies, ArePushedApartByEqualForces) {
  AttachedBodies<double> bodies = pile();
  solve(bodies);
  constexpr double kMobility = 1 / kFirst + 1 / kSecond + 0.02;
  const double force = kStiff * 1e-3 / (1 + kStiff * kMobility);
  ASSERT_EQ(bodies.push_forces().size(), 1u);
  EXPECT_NEAR(bodies.push_forces()[0], force, 1e-12);
  EXPECT_LT((bodies.move(1) - Vec3(0, force / kSecond, 0)).norm(), 1e-15);
  EXPECT_LT((bodies.move(0) - Vec3(0, -force / kFirst, 0)).norm(), 1e-15);
  EXPECT_LT((bodies.turn(1) - Vec3(0, 0, 0.1 * force)).norm(), 1e-15);
  EXPECT_LT((bodies.turn(0) - Vec3(0, 0, -0.1 * force)).norm(), 1e-15);
  EXPECT_EQ(bodies.misjudged(), 0);
}

// Solved once more from there it stays: the spring bears what brought them there.
TEST(JoinedBodies, StayWhereTheyAreSolvedFor) {
  AttachedBodies<double> bodies = pile();
  solve(bodies);
  const Vec3 before = bodies.move(1);
  solve(bodies);
  EXPECT_LT((bodies.move(1) - before).norm(), 1e-15);
}

TEST(JoinedBodies, ThatAreApartAreLeftAlone) {
  AttachedBodies<double> bodies;
  bodies.add(kFirst);
  bodies.set_pushes({{.a = 0, .b = {}, .overlap = -1e-3, .stiffness = kStiff, .touches = false}});
  solve(bodies);
  EXPECT_EQ(bodies.push_forces()[0], 0);
  EXPECT_EQ(bodies.move(0), Vec3(0, 0, 0));
}

// One that lies on another stays on it in the first system, and is let go in the next if it pulls.
TEST(JoinedBodies, ThatTouchAreHeldTogetherAtFirst) {
  AttachedBodies<double> bodies;
  bodies.add(kFirst);
  bodies.set_pushes({{.a = 0, .b = {}, .overlap = -1e-3, .stiffness = kStiff}});
  solve(bodies);
  EXPECT_LT(bodies.move(0).y(), -0.9e-3);
  EXPECT_GT(bodies.misjudged(), 0);
  solve(bodies);
  EXPECT_LT(bodies.move(0).norm(), 1e-15);
  EXPECT_EQ(bodies.misjudged(), 0);
}

// Off what stands firm, as off another body of no mobility.
TEST(JoinedBodies, AreHeldOffWhatStandsFirm) {
  AttachedBodies<double> bodies;
  bodies.add(kFirst);
  bodies.set_pushes({{.a = 0, .b = {}, .overlap = 1e-3, .stiffness = kStiff}});
  solve(bodies);
  const double force = kStiff * 1e-3 / (1 + kStiff / kFirst);
  EXPECT_NEAR(bodies.push_forces()[0], force, 1e-12);
  EXPECT_LT((bodies.move(0) - Vec3(0, force / kFirst, 0)).norm(), 1e-15);
  EXPECT_TRUE(bodies.pushed_by_firm(0));
}

}  // namespace weft::test
