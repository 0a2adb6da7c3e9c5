// BVH: what a small file says, compared with its numbers put together by hand, and files that are refused.
#include "scene/motion/bvh_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace weft::scene::test {
namespace {

const std::string kHierarchy = R"(HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Left Arm
  {
    OFFSET 0 2 0
    CHANNELS 1 Zrotation
    JOINT Hand {
      OFFSET 1 0 0
      CHANNELS 0
      End Site
      {
        OFFSET 0.5 0 0
      }
    }
  }
}
)";
const std::string kMotion = R"(MOTION
Frames: 2
Frame Time: 0.5
1 2 3 0 0 0 0
4 5 6 90 90 0 90
)";

std::string bvh_refusal(const std::string& text) {
  try {
    parse_bvh(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

std::string with(std::string text, const std::string& what, const std::string& other) {
  return text.replace(text.find(what), what.size(), other);
}

TEST(BvhFile, HasTheTreeAndTheFrames) {
  const Skeleton skeleton = parse_bvh(kHierarchy + kMotion);
  ASSERT_EQ(skeleton.nodes.size(), 4u);
  EXPECT_EQ(skeleton.nodes[1].name, "Left Arm");
  EXPECT_EQ(skeleton.nodes[1].parent, 0);
  EXPECT_EQ(skeleton.nodes[3].name, "Hand_end");
  EXPECT_TRUE(skeleton.nodes[3].end);
  EXPECT_EQ(skeleton.nodes[3].parent, 2);
  ASSERT_EQ(skeleton.clips.size(), 1u);
  EXPECT_EQ(skeleton.clips[0].duration, 0.5);
  EXPECT_EQ(skeleton.clips[0].interval, 0.5);
}

// Frame 2: the hips turn by Rz(90) Rx(90), which takes x to y, y to z and z to x; the arm, 2 up y, is 2 along
// z from (4, 5, 6). It turns by Rz(90) in the hips' frame: its x is their y, which is the world's z.
TEST(BvhFile, PutsRotationsTogetherInTheOrderOfTheChannels) {
  const Skeleton skeleton = parse_bvh(kHierarchy + kMotion);
  const Skeleton::Clip& clip = skeleton.clips[0];
  const Pose first = pose_at(skeleton, &clip, 2, 0);
  EXPECT_LT((first.position - Vec3(2, 4, 3)).norm(), 1e-12);
  EXPECT_LT(first.orientation.angularDistance(Quaternion::Identity()), 1e-7);
  const Pose hips = pose_at(skeleton, &clip, 0, 0.5);
  EXPECT_LT((hips.orientation * Vec3(1, 0, 0) - Vec3(0, 1, 0)).norm(), 1e-12);
  EXPECT_LT((hips.orientation * Vec3(0, 1, 0) - Vec3(0, 0, 1)).norm(), 1e-12);
  EXPECT_LT((pose_at(skeleton, &clip, 1, 0.5).position - Vec3(4, 5, 8)).norm(), 1e-12);
  EXPECT_LT((pose_at(skeleton, &clip, 2, 0.5).position - Vec3(4, 5, 9)).norm(), 1e-12);
  EXPECT_LT((pose_at(skeleton, &clip, 3, 0.5).position - Vec3(4, 5, 9.5)).norm(), 1e-12);
}

// Halfway between its frames the arm, which turns about z alone, has turned by 45 degrees, seen from the
// hips.
TEST(BvhFile, TurnsEvenlyBetweenFrames) {
  const Skeleton skeleton = parse_bvh(kHierarchy + kMotion);
  const Quaternion half = value_at(skeleton.clips[0].nodes[1].rotation, 0.25);
  EXPECT_NEAR(half.angularDistance(Quaternion::Identity()), std::numbers::pi / 4, 1e-12);
  EXPECT_LT((half * Vec3(1, 0, 0) - Vec3(std::sqrt(0.5), std::sqrt(0.5), 0)).norm(), 1e-12);
}

// Channels of position stand in place of OFFSET; an axis without a channel keeps it.
TEST(BvhFile, TakesPositionsInPlaceOfTheOffset) {
  const Skeleton skeleton = parse_bvh(
      "HIERARCHY ROOT a\n{ OFFSET 10 20 30 CHANNELS 1 Yposition }\nMOTION Frames: 1 Frame Time: 0.1 5");
  EXPECT_EQ(pose_at(skeleton, skeleton.clips.data(), 0, 0).position, Vec3(10, 5, 30));
}

TEST(BvhFile, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(bvh_refusal(""), "ends in line 1; must be \"HIERARCHY\"");
  EXPECT_EQ(bvh_refusal("HIERARCHY\nMOTION"), "has no joint before line 2; must begin with ROOT");
  EXPECT_EQ(bvh_refusal(with(kHierarchy, "Zrotation Xrotation", "Zrotation Wrotation") + kMotion),
            "has \"Wrotation\" in line 5; must be a channel: Xposition, Yposition, Zposition, Xrotation, "
            "Yrotation or Zrotation");
  EXPECT_EQ(bvh_refusal(with(kHierarchy, "CHANNELS 6", "CHANNELS 7") + kMotion),
            "has \"7\" in line 5; must be a number of channels from 0 to 6");
  EXPECT_EQ(bvh_refusal(with(kHierarchy, "OFFSET 0 2 0", "OFFSET 0 nan 0") + kMotion),
            "has \"nan\" in line 8; must be a number from -1e9 to 1e9");
  EXPECT_EQ(bvh_refusal(with(kHierarchy, "JOINT Left Arm", "BONE Left Arm") + kMotion),
            "has \"BONE\" in line 6; must be \"CHANNELS\", \"JOINT\", \"End Site\" or \"}\"");
  EXPECT_EQ(
      bvh_refusal(with(kHierarchy, "CHANNELS 0", "CHANNELS 0 CHANNELS 1 Xrotation CHANNELS 1 Yrotation") +
                  kMotion),
      "has CHANNELS again in line 12; a joint has them once");
  EXPECT_EQ(bvh_refusal(kHierarchy + with(kMotion, "Frames: 2", "Frames: 0")),
            "has \"0\" in line 21; must be a number of frames from 1 to 4000000");
  EXPECT_EQ(bvh_refusal(kHierarchy + with(kMotion, "Frames: 2", "Frames: 1000000")),
            "has 1000000 frames of 7 channels by line 21; at most 4000000 numbers are allowed");
  EXPECT_EQ(bvh_refusal(kHierarchy + with(kMotion, "0.5", "0")),
            "has \"0\" in line 22; must be a time from 0.0001 to 10 s");
  EXPECT_EQ(bvh_refusal(kHierarchy + with(kMotion, "Frames: 2", "Frames: 3")),
            "ends in line 25; must be a number from -1e9 to 1e9");
  EXPECT_EQ(bvh_refusal(kHierarchy + kMotion + "7\n"),
            "has \"7\" in line 25; must be the end: all 2 frames are before it");
  EXPECT_EQ(bvh_refusal(kHierarchy.substr(0, kHierarchy.size() - 2) + kMotion),
            "has \"MOTION\" in line 19; must be \"CHANNELS\", \"JOINT\", \"End Site\" or \"}\"");
}

TEST(BvhFile, IsBoundedInDepth) {
  std::string deep = "HIERARCHY ROOT a\n{ OFFSET 0 0 0 ";
  for (std::size_t i = 0; i < kMaxSkeletonDepth + 1; ++i) deep += "JOINT a\n{ OFFSET 0 0 0 ";
  for (std::size_t i = 0; i < kMaxSkeletonDepth + 2; ++i) deep += "} ";
  EXPECT_EQ(bvh_refusal(deep + "MOTION Frames: 1 Frame Time: 1"),
            "has more than 256 nodes above node \"a\", or it is its own ancestor");
}

}  // namespace
}  // namespace weft::scene::test
