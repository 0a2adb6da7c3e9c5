// Impulses between two bodies, by the conservation laws.
#include "cloth/bodies/body_impulses.h"

#include <gtest/gtest.h>

namespace weft::test {
namespace {

constexpr double kImpulseStep = 0.01;  // s

MovingBody moving_body(double mass, const Vec3& velocity) {
  MovingBody body;
  body.inverse_mass = 1 / mass;
  body.velocity = velocity;
  return body;
}
/// Between bodies 0 and 1, along x.
BodyContact touching_pair(double gap, double friction = 0) {
  BodyContact contact;
  contact.b = 1;
  contact.normal = {1, 0, 0};
  contact.gap = gap;
  contact.friction = friction;
  return contact;
}

TEST(BodyImpulses, BodiesThatMeetGoOnTogether) {
  std::vector<MovingBody> bodies{moving_body(1, {-3, 0, 0}), moving_body(2, {0, 0, 0})};
  resolve({touching_pair(0)}, bodies, kImpulseStep);
  // 1 kg at -3 m/s and 2 kg at rest: -1 m/s.
  EXPECT_NEAR(bodies[0].velocity.x(), -1, 1e-6);
  EXPECT_NEAR(bodies[1].velocity.x(), -1, 1e-6);
  EXPECT_NEAR(bodies[0].velocity.x() + 2 * bodies[1].velocity.x(), -3, 1e-12) << "N s";
}

TEST(BodyImpulses, AWayIntoAGapIsLeft) {
  std::vector<MovingBody> bodies{moving_body(1, {-3, 0, 0}), moving_body(2, {0, 0, 0})};
  resolve({touching_pair(0.05)}, bodies, kImpulseStep);
  EXPECT_EQ(bodies[0].velocity, Vec3(-3, 0, 0)) << "0.03 m of the gap's 0.05";
  resolve({touching_pair(0.02)}, bodies, kImpulseStep);
  EXPECT_NEAR(bodies[0].velocity.x() - bodies[1].velocity.x(), -0.02 / kImpulseStep, 1e-6) << "all of it";
}

TEST(BodyImpulses, FrictionTakesNoMoreThanItsShareOfTheImpulse) {
  std::vector<MovingBody> bodies{moving_body(1, {-1, 2, 0}), MovingBody{}};
  resolve({touching_pair(0, 0.5)}, bodies, kImpulseStep);
  // The impulse is 1 N s along x, and half of that along y.
  EXPECT_NEAR(bodies[0].velocity.x(), 0, 1e-6);
  EXPECT_NEAR(bodies[0].velocity.y(), 1.5, 1e-6);
  std::vector<MovingBody> slow{moving_body(1, {-1, 0.2, 0}), MovingBody{}};
  resolve({touching_pair(0, 0.5)}, slow, kImpulseStep);
  EXPECT_NEAR(slow[0].velocity.y(), 0, 1e-6) << "it sticks";
}

TEST(BodyImpulses, OverlappingBodiesAreShiftedWithoutASpeed) {
  std::vector<MovingBody> bodies{moving_body(1, {0, 0, 0}), moving_body(3, {0, 0, 0})};
  resolve({touching_pair(-0.1)}, bodies, kImpulseStep);
  EXPECT_EQ(bodies[0].velocity, Vec3(0, 0, 0));
  const double apart = bodies[0].shift.x() - bodies[1].shift.x();
  EXPECT_GT(apart, 0);
  EXPECT_LE(apart, 0.1 + 1e-9);
  EXPECT_NEAR(bodies[0].shift.x() + 3 * bodies[1].shift.x(), 0, 1e-12) << "the common centre stays";
}

// Struck at an arm of 1 m across its way, a body of 1 kg and 1 kg m2 feels as if it had half its mass.
TEST(BodyImpulses, AnOffCentreHitTurns) {
  std::vector<MovingBody> bodies{moving_body(1, {-1, 0, 0}), MovingBody{}};
  bodies[0].inverse_inertia = Eigen::Matrix3d::Identity();
  BodyContact hit = touching_pair(0);
  hit.arm_a = {0, 1, 0};
  resolve({hit}, bodies, kImpulseStep);
  EXPECT_NEAR(bodies[0].velocity.x(), -0.5, 1e-6);
  EXPECT_NEAR(bodies[0].spin.z(), -0.5, 1e-6);
}

TEST(BodyImpulses, TheImpulseThatIsRightIsFoundFromAnyStart) {
  for (const double start : {0.0, 1.0, 3.0, 40.0}) {
    std::vector<MovingBody> bodies{moving_body(1, {-3, 0, 0}), MovingBody{}};
    BodyContact contact = touching_pair(0);
    contact.start.along = start;
    const std::vector<BodyImpulse> found = resolve({contact}, bodies, kImpulseStep);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].along, 3, 1e-6) << "1 kg at 3 m/s, from " << start;
    EXPECT_NEAR(bodies[0].velocity.x(), 0, 1e-6) << start;
  }
}

TEST(BodyImpulses, WithoutFrictionNothingStartsAcrossTheNormal) {
  std::vector<MovingBody> bodies{moving_body(1, {-1, 0, 0}), MovingBody{}};
  BodyContact contact = touching_pair(0, 0);
  contact.start = {1, {0, 20, 0}};
  const std::vector<BodyImpulse> found = resolve({contact}, bodies, kImpulseStep);
  EXPECT_EQ(found[0].rubbing, Vec3(0, 0, 0));
  EXPECT_LT(bodies[0].velocity.norm(), 1e-6);
}

// Bodies in a row, at rest, of which the last stands firm. The sweeps are too few to carry such a start out
// of it.
TEST(BodyImpulses, AStartThatWouldGiveEnergyIsLeft) {
  constexpr int kBodies = 200;
  std::vector<MovingBody> bodies(kBodies, moving_body(1, {0, 0, 0}));
  bodies.back() = MovingBody{};
  std::vector<BodyContact> contacts;
  for (int i = 0; i + 1 < kBodies; ++i) {
    BodyContact contact = touching_pair(0);
    contact.a = i + 1;
    contact.b = i;
    contact.start.along = i % 2 == 0 ? 1e6 : 0;
    contacts.push_back(contact);
  }
  resolve(contacts, bodies, kImpulseStep);
  for (const MovingBody& body : bodies) EXPECT_EQ(body.velocity, Vec3(0, 0, 0));
}

}  // namespace
}  // namespace weft::test
