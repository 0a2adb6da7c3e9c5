// What the effects' damping is to a rigid motion: against the forces and torques node by node.
#include "cloth/integrators/rigid_damping.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "cloth/forces/grab.h"
#include "cloth/sheet/diagnostics.h"
#include "rig.h"

namespace weft {
namespace {

using test::each_node;

// By the effect's own definition -m d v at a node, with d the damping over the density.
TEST(RigidDamping, IsTheForceAndTheTorqueOfTheNodesDrag) {
  const test::Rig<double> rig = test::sheet_rig<double>(6, 8, BackwardEulerDescription{}, {DampingEffect{}});
  const Material& material = rig.cloth.material;
  const Vec3 centre(0.3, -0.2, 0.1), velocity(1, -2, 3), spin(-0.5, 4, 2);
  Vec3 force(0, 0, 0), torque(0, 0, 0);
  each_node(rig.particles.grid(), [&](int r, int c) {
    const Vec3 arm = rig.particles.position_at(r, c) - centre;
    const Vec3 drag =
        rig.particles.mass.at(r, c) * material.damping / material.density * (velocity + spin.cross(arm));
    force += drag;
    torque += arm.cross(drag);
  });
  RigidDamping<double> damping;
  Eigen::Matrix<double, 6, 1> motion, expected;
  motion << velocity, spin;
  expected << force, torque;
  for (int again = 0; again < 2; ++again) {
    const auto matrix = damping.matrix(rig.particles, rig.forces(0), centre, 0.1, nullptr);
    EXPECT_LT((matrix * motion - expected).norm(), 1e-12 * expected.norm());
    EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-12 * matrix.norm());
  }
}

TEST(RigidDamping, LeavesOutWhatItIsTold) {
  const test::Rig<double> rig = test::sheet_rig<double>(6, 8, BackwardEulerDescription{}, {DampingEffect{}});
  RigidDamping<double> damping;
  const Forces<double> forces = rig.forces(0);
  EXPECT_TRUE(damping.matrix(rig.particles, forces, {0, 0, 0}, 0.1, forces.effects->front().get()).isZero(0));
}

// A hand's spring, 400 /s2 times the cloth's mass, resists where a motion leads to in h beside its damping,
// 20 /s times the mass.
TEST(RigidDamping, HasTheStiffnessOfAHandByTheLengthOfTheStep) {
  const test::Rig<double> rig = test::sheet_rig<double>(6, 8, BackwardEulerDescription{}, {});
  auto grabs = std::make_unique<Grabs<double>>();
  grabs->add({1, {0.5, 0.5}, {0, 0, 0}, 1e6});
  std::vector<std::unique_ptr<Effect<double>>> effects;
  effects.push_back(std::move(grabs));
  Forces<double> forces = rig.forces(0);
  forces.effects = &effects;
  const double mass = total_mass(rig.particles), h = 0.1;
  RigidDamping<double> damping;
  for (int again = 0; again < 2; ++again) {
    const auto matrix = damping.matrix(rig.particles, forces, {0, 0, 0}, h, nullptr);
    EXPECT_LT((matrix.topLeftCorner<3, 3>() - mass * (20 + 400 * h) * Eigen::Matrix3d::Identity()).norm(),
              1e-9);
  }
}

}  // namespace
}  // namespace weft
