// A node's way as a path of poses in the scene.
#include "scene/motion/node_path.h"

#include <gtest/gtest.h>

#include <numbers>

#include "motion/gltf_fixture.h"
#include "scene/motion/bvh_file.h"
#include "scene/motion/gltf_file.h"

namespace weft::scene::test {
namespace {

/// A node that goes along x, in cm, by the frames' numbers, one a tenth of a second.
Skeleton walk_of(const std::vector<double>& places) {
  std::string text = "HIERARCHY ROOT a\n{ OFFSET 0 0 0 CHANNELS 1 Xposition }\nMOTION Frames: " +
                     std::to_string(places.size()) + " Frame Time: 0.1";
  for (const double place : places) text += " " + std::to_string(place);
  return parse_bvh(text);
}

std::string path_refusal(const Skeleton& skeleton, const Placement& placement) {
  try {
    path_of(skeleton, skeleton.clips.at(0), 0, placement);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(NodePath, HasTheFramesOfAFile) {
  const Skeleton skeleton = walk_of({0, 10, 40});
  Placement placement;
  placement.scale = 0.01;
  placement.offset = {1, 2, 3};
  placement.orientation = Quaternion(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()));  // x to -z
  placement.start = 5;
  const auto path = path_of(skeleton, skeleton.clips[0], 0, placement);
  ASSERT_EQ(path.size(), 3u);
  EXPECT_DOUBLE_EQ(path[2].time, 5.2);
  EXPECT_LT((path[1].pose.position - Vec3(1, 2, 2.9)).norm(), 1e-12);
  EXPECT_LT((path[2].pose.position - Vec3(1, 2, 2.6)).norm(), 1e-12);
  EXPECT_LT(path[2].pose.orientation.angularDistance(placement.orientation), 1e-7);
}

// The file's cycle lacks its last frame, which is the first one of the next: the way back takes an interval.
TEST(NodePath, LeadsALoopBackToWhereItBegins) {
  Placement loop;
  loop.loop = true;
  const Skeleton open = walk_of({0, 0.3, 0.3});
  const auto path = path_of(open, open.clips[0], 0, loop);
  ASSERT_EQ(path.size(), 4u);
  EXPECT_DOUBLE_EQ(path[3].time, 0.3);
  EXPECT_EQ(path[3].pose.position, path[0].pose.position);
  const Skeleton closed = walk_of({0, 0.3, 0.3, 0});
  EXPECT_EQ(path_of(closed, closed.clips[0], 0, loop).size(), 4u);
}

// The seam may be as long as two of the longest steps, here of 0.3 m.
TEST(NodePath, DoesNotLoopOverAJump) {
  Placement loop;
  loop.loop = true;
  EXPECT_EQ(path_refusal(walk_of({0, 0.3, 0.6}), loop), "");
  EXPECT_EQ(path_refusal(walk_of({0, 0.3, 0.6, 0.9}), loop),
            "does not end where it begins: 0.9 m and 0 degrees apart, which cannot loop");
  loop.loop = false;
  EXPECT_EQ(path_refusal(walk_of({0, 0.3, 0.6, 0.9}), loop), "");
}

TEST(NodePath, StaysInTheScene) {
  EXPECT_EQ(path_refusal(walk_of({0, 20000}), {}),
            "has node \"a\" beyond 10000 m of the origin at 0.1 s; scale tells the file's unit");
}

// 16,000 frames, and as many samples as a path may have.
TEST(NodePath, SamplesLongClipsMoreCoarsely) {
  const Skeleton skeleton = walk_of(std::vector<double>(9'000, 1));
  EXPECT_EQ(path_of(skeleton, skeleton.clips[0], 0, {}).size(), 9'000u);
  const Skeleton longer = walk_of(std::vector<double>(10'001, 1));
  EXPECT_EQ(path_refusal(longer, {}), "");
  const auto path = path_of(longer, longer.clips[0], 0, {});
  EXPECT_EQ(path.size(), kMaxPathPoints - 1);
  EXPECT_NEAR(path.back().time, 1000, 1e-9);
  EXPECT_EQ(path_refusal(walk_of(std::vector<double>(10'002, 1)), {}),
            "lasts 1000.1 s; at most 1000 s are allowed");
}

TEST(NodePath, RefusesScalesInMotionAboveTheNode) {
  GltfText text;
  text.tree["nodes"] = {{{"name", "a"}, {"children", {1}}}, {{"name", "b"}}};
  const int times = text.floats("SCALAR", {0, 1});
  text.animate(0, "scale", times, text.floats("VEC3", {1, 1, 1, 1.0001F, 1, 1}));
  text.animate(1, "scale", times, text.floats("VEC3", {1, 1, 1, 2, 1, 1}));
  text.animate(1, "rotation", times, text.floats("VEC4", {0, 0, 0, 1, 0, 0, 0, 1}));
  const Skeleton skeleton = read_gltf(text.document());
  EXPECT_EQ(path_of(skeleton, skeleton.clips[0], 1, {}).size(), 61u);  // its own scale turns nothing; 60 Hz
  text.animate(0, "scale", times, text.floats("VEC3", {1, 1, 1, 2, 1, 1}));
  const Skeleton scaled = read_gltf(text.document());
  EXPECT_THROW(path_of(scaled, scaled.clips[0], 1, {}), std::invalid_argument);
}

TEST(NodePath, FindsNodesAndClipsByName) {
  Skeleton skeleton = walk_of({0, 1});
  EXPECT_EQ(find_node(skeleton, "a"), 0u);
  EXPECT_THROW(find_node(skeleton, "b"), std::invalid_argument);
  skeleton.nodes.push_back(skeleton.nodes[0]);
  EXPECT_THROW(find_node(skeleton, "a"), std::invalid_argument);
  EXPECT_THROW(find_clip(skeleton, "run"), std::invalid_argument);
  skeleton.clips[0].name = "run";
  EXPECT_EQ(&find_clip(skeleton, "run"), skeleton.clips.data());
}

}  // namespace
}  // namespace weft::scene::test
