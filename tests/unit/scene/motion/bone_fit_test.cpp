// Capsules on bones: by the hierarchy alone, and by a skin that is a cylinder of known radius.
#include "scene/motion/bone_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "motion/gltf_fixture.h"
#include "scene/motion/bvh_file.h"
#include "scene/motion/gltf_file.h"

namespace weft::scene::test {
namespace {

const char* const kBoneFigure = R"(HIERARCHY
ROOT hip
{ OFFSET 0 100 0 CHANNELS 1 Xrotation
  JOINT leg
  { OFFSET 0 -50 0 CHANNELS 1 Xrotation
    End Site
    { OFFSET 0 -50 0 } }
  JOINT finger
  { OFFSET 1 0 0 CHANNELS 0
    End Site
    { OFFSET 20 0 0 } }
}
MOTION Frames: 1 Frame Time: 0.1 0 0)";

// 100 cm high: a bone of 50 cm has a radius of 0.15 of that, the one of 20 cm 3 cm; the one of 1 cm is
// shorter than 5 cm. A capsule's own axis is y, so that of the finger, along x, is turned.
TEST(BoneFit, GoesByTheHierarchy) {
  const Skeleton skeleton = parse_bvh(kBoneFigure);
  EXPECT_NEAR(height_of(skeleton, skeleton.clips.data()), 100, 1e-12);
  BoneFitRule rule;
  const auto capsules = fit_capsules(skeleton, skeleton.clips.data(), {}, 0.01, rule);
  ASSERT_EQ(capsules.size(), 3u);
  EXPECT_EQ(capsules[0].node, 0u);
  EXPECT_DOUBLE_EQ(capsules[0].length, 0.5);
  EXPECT_DOUBLE_EQ(capsules[0].radius, 0.075);
  EXPECT_LT((capsules[0].position - Vec3(0, -0.25, 0)).norm(), 1e-12);
  EXPECT_EQ(skeleton.nodes[capsules[1].node].name, "leg");
  EXPECT_EQ(skeleton.nodes[capsules[2].node].name, "finger");
  EXPECT_DOUBLE_EQ(capsules[2].radius, 0.03);
  EXPECT_LT((capsules[2].orientation * Vec3(0, 1, 0) - Vec3(1, 0, 0)).norm(), 1e-12);
  rule.thickest = 0.06;
  rule.radii["leg"] = 0.2;
  const auto other = fit_capsules(skeleton, skeleton.clips.data(), {}, 0.01, rule);
  EXPECT_DOUBLE_EQ(other[0].radius, 0.06);
  EXPECT_DOUBLE_EQ(other[1].radius, 0.2);
  rule.radii["arm"] = 0.2;
  EXPECT_THROW(fit_capsules(skeleton, skeleton.clips.data(), {}, 0.01, rule), std::invalid_argument);
}

/// A cylinder of radius 0.1 around y from 0 to 1 on two joints: "low" at its foot holds the lower half,
/// "high" in its middle the upper one, whose vertices are stored as seen from the foot.
GltfText cylinder() {
  std::vector<float> places;
  std::vector<float> weights;
  std::vector<std::uint8_t> joints;
  for (int ring = 0; ring <= 20; ++ring) {
    for (int i = 0; i < 16; ++i) {
      const double angle = i * std::numbers::pi / 8;
      places.insert(places.end(),
                    {float(0.1 * std::cos(angle)), float(ring) / 20, float(0.1 * std::sin(angle))});
      const bool high = ring > 10;
      joints.insert(joints.end(), {0, 1, 0, 0});
      weights.insert(weights.end(), {high ? 0.3F : 0.7F, high ? 0.7F : 0.3F, 0, 0});
    }
  }
  GltfText text;
  text.tree["nodes"] = {{{"name", "low"}, {"children", {1}}},
                        {{"name", "high"}, {"translation", {0, 0.5, 0}}},
                        {{"mesh", 0}, {"skin", 0}}};
  const int bind = text.floats("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,     0, 1,
                                        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -0.5F, 0, 1});
  text.tree["skins"] = {{{"joints", {0, 1}}, {"inverseBindMatrices", bind}}};
  text.tree["meshes"] = {{{"primitives",
                           {{{"attributes",
                              {{"POSITION", text.floats("VEC3", places)},
                               {"JOINTS_0", text.bytes("VEC4", joints)},
                               {"WEIGHTS_0", text.floats("VEC4", weights)}}}}}}}};
  return text;
}

TEST(BoneFit, TakesTheRadiusOfASkin) {
  const GltfDocument document = cylinder().document();
  const Skeleton skeleton = read_gltf(document);
  const Skin skin = read_skin(document);
  ASSERT_EQ(skin.size(), 2u);
  EXPECT_EQ(skin.at(0).size(), 11u * 16);
  EXPECT_EQ(skin.at(1).size(), 10u * 16);
  const auto capsules = fit_capsules(skeleton, nullptr, skin, 2, {});  // twice as large
  ASSERT_EQ(capsules.size(), 2u);
  EXPECT_NEAR(capsules[0].radius, 0.2, 1e-6);
  EXPECT_NEAR(capsules[0].length, 1, 1e-6);
  // A joint without children: its skin reaches 0.5 beyond it, of which the round end is 0.1.
  EXPECT_EQ(capsules[1].node, 1u);
  EXPECT_NEAR(capsules[1].radius, 0.2, 1e-6);
  EXPECT_NEAR(capsules[1].length, 0.8, 1e-6);
  EXPECT_LT((capsules[1].position - Vec3(0, 0.4, 0)).norm(), 1e-6);
}

// One vertex in ten is ten times as far from the bone: the capsule does not care.
TEST(BoneFit, LeavesStrayVerticesOut) {
  const GltfDocument document = cylinder().document();
  Skin skin = read_skin(document);
  std::vector<Vec3>& vertices = skin.at(0);
  for (std::size_t i = 0; i < vertices.size(); i += 10) vertices[i] = Vec3(1, 0.25, 0);
  const auto capsules = fit_capsules(read_gltf(document), nullptr, skin, 1, {});
  EXPECT_NEAR(capsules[0].radius, 0.1, 1e-6);
}

TEST(BoneFit, RefusesASkinOfJointsThatAreNotThere) {
  GltfText text = cylinder();
  text.tree["skins"][0]["joints"] = {0};
  EXPECT_THROW(read_skin(text.document()), std::invalid_argument);
  text.tree["skins"][0]["joints"] = {0, 1, 0};  // for which there are two matrices
  EXPECT_THROW(read_skin(text.document()), std::invalid_argument);
}

}  // namespace
}  // namespace weft::scene::test
