// One pair of solids that meet in a step: where, along which normal and how far apart they began.
#include "cloth/bodies/body_meeting.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "meshes.h"

namespace weft {
namespace {

constexpr double kMeetingStep = 0.01;  // s

/// A dynamic solid of 2 kg that ends the step at `end` with this velocity.
Solid met_solid(const Shape& shape, const Vec3& end, const Vec3& velocity = {0, 0, 0}) {
  Solid solid;
  solid.shape = shape;
  solid.position = end;
  solid.start = end - kMeetingStep * velocity;
  solid.velocity = velocity;
  solid.inverse_mass = 0.5;
  solid.mobile = true;
  return solid;
}

/// One that nothing moves, and that does not move.
Solid firm_solid(const Shape& shape, const Vec3& place = {0, 0, 0}) {
  Solid solid = met_solid(shape, place);
  solid.inverse_mass = 0;
  solid.mobile = false;
  return solid;
}

std::vector<BodyContact> contacts_of(const Solid& a, const Solid& b) {
  BodyGeometry geometry;
  std::vector<BodyContact> contacts;
  add_contacts(a, b, {3, 8}, kMeetingStep, geometry, contacts);
  return contacts;
}

TEST(BodyMeeting, KindsOfSolidsAreTold) {
  EXPECT_TRUE(is_half_space(firm_solid(HalfSpace{})));
  EXPECT_FALSE(is_half_space(firm_solid(Box{{1, 1, 1}})));
  EXPECT_TRUE(is_ball(firm_solid(Sphere{0.1})));
  EXPECT_FALSE(is_ball(firm_solid(Capsule{0.1, 0.1})));
  EXPECT_TRUE(is_pinned_node(firm_solid(Sphere{0})));
  EXPECT_FALSE(is_pinned_node(firm_solid(Sphere{0.1})));
}

// One of two is where it is for good: it neither yields nor may move.
TEST(BodyMeeting, APairWithAFixedSolidIsFirm) {
  const Solid body = met_solid(Sphere{0.1}, {0, 0, 0}), ground = firm_solid(HalfSpace{});
  Solid moved = ground;
  moved.mobile = true;  // on a path
  EXPECT_TRUE(is_firm(body, ground));
  EXPECT_TRUE(is_firm(ground, body));
  EXPECT_FALSE(is_firm(body, moved));
  EXPECT_FALSE(is_firm(body, body));
}

// A ball that has come down by 10 mm to 5 mm over the ground: it began 15 mm over it.
TEST(BodyMeeting, ABallOverTheGroundTouchesItBelowItsMiddle) {
  Solid ball = met_solid(Sphere{0.1}, {2, 0.105, 3}, {0.4, -1, 0}), ground = firm_solid(HalfSpace{});
  ball.friction = 0.9;
  ground.friction = 0.4;
  const std::vector<BodyContact> contacts = contacts_of(ball, ground);
  ASSERT_EQ(contacts.size(), 1U);
  const BodyContact& contact = contacts[0];
  EXPECT_EQ(contact.a, 3);
  EXPECT_EQ(contact.b, 8);
  EXPECT_LT((contact.normal - Vec3(0, 1, 0)).norm(), 1e-14);
  EXPECT_NEAR(contact.gap, 0.015, 1e-14);
  EXPECT_LT((contact.arm_a - Vec3(0, -0.1, 0)).norm(), 1e-14);
  EXPECT_NEAR(contact.friction, 0.6, 1e-14);  // the geometric mean
  EXPECT_TRUE(contact.firm);
}

// Half of the smaller inner radius is looked ahead, and no more.
TEST(BodyMeeting, WhatIsFartherThanTheMarginDoesNotCount) {
  const Solid ground = firm_solid(HalfSpace{});
  const double margin = kBodyMargin * inner_radius(Sphere{0.1});
  EXPECT_EQ(contacts_of(met_solid(Sphere{0.1}, {0, 0.1 + 0.99 * margin, 0}), ground).size(), 1U);
  EXPECT_TRUE(contacts_of(met_solid(Sphere{0.1}, {0, 0.1 + 1.01 * margin, 0}), ground).empty());
}

// From b to a, along the line of their middles.
TEST(BodyMeeting, TwoBallsTouchOnTheLineOfTheirMiddles) {
  const Vec3 line = Vec3(2, 1, -2) / 3;
  const Solid a = met_solid(Sphere{0.1}, 0.305 * line, -0.5 * line), b = met_solid(Sphere{0.2}, {0, 0, 0});
  const std::vector<BodyContact> contacts = contacts_of(a, b);
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_LT((contacts[0].normal - line).norm(), 1e-14);
  EXPECT_NEAR(contacts[0].gap, 0.005 + 0.5 * kMeetingStep, 1e-14);
  EXPECT_LT((contacts[0].arm_a + 0.1 * line).norm(), 1e-14);
  // The same place as seen from both.
  EXPECT_LT((a.position + contacts[0].arm_a - b.position - contacts[0].arm_b).norm(), 1e-14);
  EXPECT_FALSE(contacts[0].firm);
}

// A box that stands on the ground touches it with its four lower corners; so does one on another.
TEST(BodyMeeting, ABoxStandsOnFourCorners) {
  const Vec3 half(0.3, 0.1, 0.2);
  const Solid box = met_solid(Box{half}, {0, 0.1 - 1e-4, 0});
  const Solid lower = met_solid(Box{{1, 0.5, 1}}, {0, -0.5, 0});
  for (const Solid& under : {firm_solid(HalfSpace{}), lower}) {
    const std::vector<BodyContact> contacts = contacts_of(box, under);
    ASSERT_EQ(contacts.size(), 4U);
    Vec3 sum(0, 0, 0);
    for (const BodyContact& contact : contacts) {
      EXPECT_LT((contact.normal - Vec3(0, 1, 0)).norm(), 1e-6);
      EXPECT_NEAR(contact.gap, -1e-4, 1e-6);
      EXPECT_NEAR(std::abs(contact.arm_a.x()), 0.3, 1e-6);
      EXPECT_NEAR(std::abs(contact.arm_a.z()), 0.2, 1e-6);
      sum += contact.arm_a;
    }
    EXPECT_LT(Vec3(sum.x(), 0, sum.z()).norm(), 1e-6);
  }
}

// It ends beyond the wall that it flew through: seen on its way, the wall was before it and is behind it now.
TEST(BodyMeeting, WhatFliesThroughAWallIsSeenOnItsWay) {
  const Solid wall = firm_solid(Box{{0.02, 1, 1}});
  const Solid ball = met_solid(Sphere{0.05}, {0.6, 0, 0}, {120, 0, 0});
  const std::vector<BodyContact> contacts = contacts_of(ball, wall);
  ASSERT_FALSE(contacts.empty());
  for (const BodyContact& contact : contacts) {
    EXPECT_LT((contact.normal - Vec3(-1, 0, 0)).norm(), 1e-6);
    EXPECT_NEAR(contact.gap, 0.6 - 0.02 - 0.05, 1e-4);
  }
  EXPECT_TRUE(contacts_of(met_solid(Sphere{0.05}, {0.6, 3, 0}, {120, 0, 0}), wall).empty());
}

// As an impulse may bring it on: a hair above, where FCL finds nothing.
TEST(BodyMeeting, ABoxJustAboveAnotherTouchesItWithItsCorners) {
  const Solid box = met_solid(Box{{0.3, 0.1, 0.2}}, {0, 0.101, 0});
  const Solid lower = met_solid(Box{{1, 0.5, 1}}, {0, -0.5, 0});
  const std::vector<BodyContact> contacts = contacts_of(box, lower);
  ASSERT_EQ(contacts.size(), 4U);
  for (const BodyContact& contact : contacts) EXPECT_NEAR(contact.gap, 1e-3, 1e-9);
  // Beside it there is nothing below.
  EXPECT_TRUE(contacts_of(met_solid(Box{{0.3, 0.1, 0.2}}, {1.31, 0.101, 0}), lower).empty());
}

// What goes along with it, however fast, is not looked at on its way.
TEST(BodyMeeting, TwoThatFlyTogetherTouchAsAtRest) {
  const Vec3 fast(0, -50, 20);
  const Solid box = met_solid(Box{{0.3, 0.1, 0.2}}, {0, 0.0999, 0}, fast);
  const std::vector<BodyContact> contacts = contacts_of(box, met_solid(Box{{1, 0.5, 1}}, {0, -0.5, 0}, fast));
  ASSERT_EQ(contacts.size(), 4U);
  for (const BodyContact& contact : contacts) EXPECT_NEAR(contact.gap, -1e-4, 1e-6);
}

// An edge of the mesh lies 1 mm in the plate: what of the mesh is next to the place is its side.
TEST(BodyMeeting, AMeshThatSlidesOnAPlateIsHeldUpByIt) {
  const TriangleMesh mesh(test::box_mesh({0.1, 0.1, 0.1}));
  const Solid body = met_solid(Mesh{&mesh}, {0.003, 0.099, 0.002});
  const std::vector<BodyContact> contacts = contacts_of(body, firm_solid(Box{{2, 0.5, 2}}, {0, -0.5, 0}));
  ASSERT_GE(contacts.size(), 4U);
  for (const BodyContact& contact : contacts) EXPECT_GT(contact.normal.y(), 0.999);
}

// Whichever of the two is the first: the normal goes from b to a.
TEST(BodyMeeting, WhichOfTwoMeshesIsTheFirstMakesNoDifference) {
  const TriangleMesh cube(test::box_mesh({0.1, 0.1, 0.1})), plate(test::box_mesh({2, 0.5, 2}));
  const Solid upper = met_solid(Mesh{&cube}, {0.003, 0.099, 0.002});
  const Solid lower = firm_solid(Mesh{&plate}, {0, -0.5, 0});
  for (const bool swapped : {false, true}) {
    const std::vector<BodyContact> contacts = swapped ? contacts_of(lower, upper) : contacts_of(upper, lower);
    EXPECT_GT(contacts.size(), 4U);  // more than the corners
    for (const BodyContact& contact : contacts) EXPECT_GT((swapped ? -1 : 1) * contact.normal.y(), 0.999);
  }
}

}  // namespace
}  // namespace weft
