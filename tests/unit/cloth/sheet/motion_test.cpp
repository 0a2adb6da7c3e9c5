// Energy taken from a cloth's motion: by how much it slows down, and what stays.
#include "cloth/sheet/motion.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "cloth/sheet/diagnostics.h"
#include "fixtures.h"

namespace weft {
namespace {

const Vec2 kSize(2, 2);

Particles<double> moving_sheet() {
  Particles<double> sheet = test::flat_sheet<double>(5, 5, kSize);
  test::randomise(sheet.position, -1, 1, 7);
  test::randomise(sheet.velocity, -1, 2, 1);
  return sheet;
}

/// Of a rigid body with the sheet's momentum and angular momentum: p^2 / 2m + L . I^-1 L / 2 about the centre
/// of mass, J. The nodes weigh the same.
double rigid_energy(const Particles<double>& sheet) {
  const Vec3 middle = centre(sheet), momentum = linear_momentum(sheet);
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  double mass = 0;
  test::each_node(sheet.grid(), [&](int r, int c) {
    const double m = sheet.mass.at(r, c);
    const Vec3 arm = sheet.position_at(r, c) - middle;
    mass += m;
    inertia += m * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  });
  const Vec3 turning = angular_momentum(sheet) - middle.cross(momentum);
  return momentum.squaredNorm() / (2 * mass) + turning.dot(inertia.inverse() * turning) / 2;
}

TEST(TakeFromMotion, TakesWhatItIsAskedForAndLeavesBothMomenta) {
  Particles<double> sheet = moving_sheet();
  const Vec3 momentum = linear_momentum(sheet), turning = angular_momentum(sheet);
  const double energy = kinetic_energy(sheet), rigid = rigid_energy(sheet);
  // Of the motion beside the rigid one half the energy is left: 1 / sqrt(2) of each velocity.
  EXPECT_NEAR(take_from_motion(sheet, 0.5 * (energy - rigid)), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(kinetic_energy(sheet), 0.5 * (energy + rigid), 1e-12 * energy);
  EXPECT_LT((linear_momentum(sheet) - momentum).norm(), 1e-12 * momentum.norm());
  EXPECT_LT((angular_momentum(sheet) - turning).norm(), 1e-12 * turning.norm());
  EXPECT_EQ(take_from_motion(sheet, 2 * energy), 0) << "more than there is";
  EXPECT_NEAR(kinetic_energy(sheet), rigid, 1e-12 * energy);
}

TEST(TakeFromMotion, WhereANodeIsHeldTheRestMayLoseAll) {
  Particles<double> sheet = moving_sheet();
  sheet.inverse_mass.at(2, 2) = 0;
  const Particles<double> before = sheet;
  EXPECT_EQ(take_from_motion(sheet, 0), 1);
  EXPECT_EQ(take_from_motion(sheet, -1), 1) << "there is nothing to give";
  EXPECT_EQ(sheet.velocity.x.values(), before.velocity.x.values());
  take_from_motion(sheet, 2 * kinetic_energy(sheet));
  EXPECT_EQ(kinetic_energy(sheet), 0);
  EXPECT_EQ(sheet.velocity_at(2, 2), before.velocity_at(2, 2));
}

TEST(TakeFromMotion, WhatARigidBodyHasStays) {
  Particles<double> sheet = moving_sheet();
  const Vec3 spin(1, 2, -3), middle = centre(sheet);
  test::each_node(sheet.grid(), [&](int r, int c) {
    test::set(sheet.velocity, r, c, Vec3(4, 5, 6) + spin.cross(sheet.position_at(r, c) - middle));
  });
  const double energy = kinetic_energy(sheet);
  take_from_motion(sheet, energy);
  EXPECT_NEAR(kinetic_energy(sheet), energy, 1e-12 * energy);
}

// Given and taken alike: of the inner motion alone, which is what the whole has beside the rigid one.
TEST(AddToMotion, GivesToTheInnerMotionAndLeavesBothMomenta) {
  Particles<double> sheet = moving_sheet();
  const Vec3 momentum = linear_momentum(sheet), turning = angular_momentum(sheet);
  const double energy = kinetic_energy(sheet), inner = motion_energy(sheet).inner;
  EXPECT_NEAR(inner, energy - rigid_energy(sheet), 1e-12 * energy);
  EXPECT_NEAR(add_to_motion(sheet, 0.21 * inner), 1.1, 1e-12);
  EXPECT_NEAR(kinetic_energy(sheet), energy + 0.21 * inner, 1e-12 * energy);
  EXPECT_LT((linear_momentum(sheet) - momentum).norm(), 1e-12 * momentum.norm());
  EXPECT_LT((angular_momentum(sheet) - turning).norm(), 1e-12 * turning.norm());
  EXPECT_EQ(add_to_motion(sheet, std::nan("")), 1) << "no energy at all";
}

// Koenig: the whole is that of the centre and that about it; what forces do on the centre is their sum's.
TEST(MotionEnergy, BesideTheCentreIsTheWholeLessTheCentres) {
  Particles<double> sheet = moving_sheet();
  double mass = 0, work = 0;
  Vec3 force(0, 0, 0), moved(0, 0, 0);
  test::each_node(sheet.grid(), [&](int r, int c) {
    const double m = sheet.mass.at(r, c);
    mass += m;
    work += sheet.position_at(r, c).dot(sheet.velocity_at(r, c));
    force += sheet.position_at(r, c);
    moved += m * sheet.velocity_at(r, c);
  });
  const double energy = kinetic_energy(sheet);
  EXPECT_NEAR(motion_energy(sheet).beside_centre, energy - linear_momentum(sheet).squaredNorm() / (2 * mass),
              1e-12 * energy);
  // Any two fields: here the positions stand for forces, the velocities for ways.
  EXPECT_NEAR(work_beside_centre(sheet, sheet.position, sheet.velocity), work - force.dot(moved) / mass,
              1e-12);
  sheet.inverse_mass.at(2, 2) = 0;
  const double held = sheet.mass.at(2, 2) * sheet.velocity_at(2, 2).squaredNorm() / 2;
  EXPECT_NEAR(motion_energy(sheet).beside_centre, energy - held, 1e-12 * energy);
  EXPECT_NEAR(work_beside_centre(sheet, sheet.position, sheet.velocity), work, 1e-12);
}

// What is remembered of a motion is scaled as the motion is.
TEST(ScaleMotion, AsTheMotionFromWhichEnergyWasTaken) {
  for (const bool held : {false, true}) {
    Particles<double> sheet = moving_sheet();
    if (held) sheet.inverse_mass.at(0, 0) = 0;
    VectorField<double> remembered = sheet.velocity;
    const double kept = take_from_motion(sheet, 0.1 * kinetic_energy(sheet));
    ASSERT_LT(kept, 1);
    scale_motion(sheet, kept, remembered);
    EXPECT_EQ(remembered.y.values(), sheet.velocity.y.values());
  }
}

}  // namespace
}  // namespace weft
