#include "cloth/bodies/kept_impulses.h"

#include <gtest/gtest.h>

#include <numbers>

namespace weft {
namespace {

/// Two boxes of 0.2 m.
std::vector<Solid> two_boxes() {
  std::vector<Solid> solids(2);
  for (std::size_t i = 0; i < 2; ++i) {
    solids[i].id = kFirstObstacle + static_cast<ColliderId>(i);
    solids[i].shape = Box{{0.1, 0.1, 0.1}};
    solids[i].inverse_mass = 1;
  }
  return solids;
}

BodyContact contact_at(const Vec3& arm) {
  BodyContact contact;
  contact.b = 1;
  contact.arm_a = arm;
  return contact;
}

TEST(KeptImpulses, TheSamePlaceStartsWithTheSameForce) {
  const std::vector<Solid> solids = two_boxes();
  KeptImpulses kept;
  kept.keep({contact_at({0.1, -0.1, 0}), contact_at({-0.1, -0.1, 0})}, {{2, {0.5, 0, 0}}, {3, {0, 0, 0}}},
            solids, 0.01);
  // A hair aside, in the other order, in a step twice as long.
  std::vector<BodyContact> next{contact_at({-0.1, -0.1, 0.001}), contact_at({0.1, -0.1, 0.001})};
  kept.start(next, solids, 0.02);
  EXPECT_DOUBLE_EQ(next[0].start.along, 6);
  EXPECT_DOUBLE_EQ(next[1].start.along, 4);
  EXPECT_EQ(next[1].start.rubbing, Vec3(1, 0, 0));
}

// As the body turns, the place on it turns with it.
TEST(KeptImpulses, APlaceIsOneOnTheBody) {
  std::vector<Solid> solids = two_boxes();
  KeptImpulses kept;
  kept.keep({contact_at({0.1, -0.1, 0})}, {{2, {0, 0, 0}}}, solids, 0.01);
  solids[0].rotation = Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitY()).toRotationMatrix();
  std::vector<BodyContact> next{contact_at({0, -0.1, 0.1})};
  kept.start(next, solids, 0.01);
  EXPECT_DOUBLE_EQ(next[0].start.along, 2);
}

TEST(KeptImpulses, AnotherPlaceOrBodyStartsFromNothing) {
  std::vector<Solid> solids = two_boxes();
  KeptImpulses kept;
  kept.keep({contact_at({0.1, -0.1, 0})}, {{2, {0, 0, 0}}}, solids, 0.01);
  std::vector<BodyContact> next{contact_at({0.1, -0.1, 0.02})};  // a tenth of 0.1 m is the same
  kept.start(next, solids, 0.01);
  EXPECT_EQ(next[0].start.along, 0);
  solids[1].id += 1;
  next = {contact_at({0.1, -0.1, 0})};
  kept.start(next, solids, 0.01);
  EXPECT_EQ(next[0].start.along, 0);
}

TEST(KeptImpulses, OneIsToldToOneContact) {
  const std::vector<Solid> solids = two_boxes();
  KeptImpulses kept;
  kept.keep({contact_at({0.1, -0.1, 0})}, {{2, {0, 0, 0}}}, solids, 0.01);
  std::vector<BodyContact> next{contact_at({0.1, -0.1, 0.001}), contact_at({0.1, -0.1, 0.002})};
  kept.start(next, solids, 0.01);
  EXPECT_EQ(next[0].start.along + next[1].start.along, 2);
}

// A pinned node is no solid.
TEST(KeptImpulses, PinnedNodesAreNotKept) {
  const std::vector<Solid> solids = two_boxes();
  KeptImpulses kept;
  BodyContact contact = contact_at({0.1, -0.1, 0});
  contact.b = 2;
  kept.keep({contact}, {{2, {0, 0, 0}}}, solids, 0.01);
  std::vector<BodyContact> next{contact};
  kept.start(next, solids, 0.01);
  EXPECT_EQ(next[0].start.along, 0);
}

// What sleeps yields to nothing, and is in no contact then.
TEST(KeptImpulses, WhatSleepsKeepsItsOwn) {
  std::vector<Solid> solids = two_boxes();
  KeptImpulses kept;
  kept.keep({contact_at({0.1, -0.1, 0})}, {{2, {0, 0, 0}}}, solids, 0.01);
  for (Solid& solid : solids) solid.inverse_mass = 0;
  kept.keep({}, {}, solids, 0.01);
  std::vector<BodyContact> next{contact_at({0.1, -0.1, 0})};
  kept.start(next, solids, 0.01);
  EXPECT_EQ(next[0].start.along, 2);
  solids[0].inverse_mass = 1;  // awake, and apart
  kept.keep({}, {}, solids, 0.01);
  next = {contact_at({0.1, -0.1, 0})};
  kept.start(next, solids, 0.01);
  EXPECT_EQ(next[0].start.along, 0);
}

}  // namespace
}  // namespace weft
