// glTF 2.0: hierarchy and samplers compared with the standard's formulas by hand, and documents that are
// refused.
#include "scene/motion/gltf_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "motion/gltf_fixture.h"
#include "scene/motion/data_uri.h"

namespace weft::scene::test {
namespace {

const float kHalf = std::sqrt(0.5F);  // sine and cosine of 45 degrees

/// Node 0 "root" turns its child 1 "arm", 2 m along x, about z from 0 to 90 degrees between 1 s and 3 s; node
/// 2 "tip" is 1 m along x of that.
GltfText arm(const char* interpolation = "LINEAR") {
  GltfText text;
  text.tree["nodes"] = {{{"name", "root"}, {"children", {1}}, {"translation", {0, 1, 0}}},
                        {{"name", "arm"}, {"children", {2}}, {"translation", {2, 0, 0}}},
                        {{"name", "tip"}, {"translation", {1, 0, 0}}}};
  const int times = text.floats("SCALAR", {1, 3});
  text.animate(0, "rotation", times, text.floats("VEC4", {0, 0, 0, 1, 0, 0, kHalf, kHalf}), interpolation);
  return text;
}

std::string gltf_refusal(GltfText text) {
  try {
    read_gltf(text.document());
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

Vec3 place(const Skeleton& skeleton, std::size_t node, double time) {
  return pose_at(skeleton, &skeleton.clips.at(0), node, time).position;
}

TEST(GltfFile, TurnsWhatHangsOnANode) {
  const Skeleton skeleton = read_gltf(arm().document());
  EXPECT_EQ(skeleton.nodes[2].parent, 1);
  EXPECT_EQ(skeleton.clips[0].duration, 2);  // from the first key, at 1 s
  EXPECT_LT((place(skeleton, 2, 0) - Vec3(3, 1, 0)).norm(), 1e-7);
  const double half = std::sqrt(0.5);  // halfway, by 45 degrees
  EXPECT_LT((place(skeleton, 2, 1) - Vec3(3 * half, 1 + 3 * half, 0)).norm(), 1e-6);
  EXPECT_LT((place(skeleton, 2, 2) - Vec3(0, 4, 0)).norm(), 1e-6);
  EXPECT_LT((place(skeleton, 2, 9) - Vec3(0, 4, 0)).norm(), 1e-6);  // as at the last key
}

TEST(GltfFile, HoldsTheKeyBeforeInSteps) {
  const Skeleton skeleton = read_gltf(arm("STEP").document());
  EXPECT_LT((place(skeleton, 2, 1.99) - Vec3(3, 1, 0)).norm(), 1e-7);
  EXPECT_LT((place(skeleton, 2, 2) - Vec3(0, 4, 0)).norm(), 1e-6);
}

// Appendix C.5 with p0 = 0, p1 = 1, both tangents 0 but the first one's out of 4 /s over 2 s: at t = 1/2 the
// spline is (-2/8 + 3/4) 1 + 2 (1/8 - 2/4 + 1/2) 4 = 0.5 + 1.
TEST(GltfFile, FollowsCubicSplines) {
  GltfText text;
  text.tree["nodes"] = {{{"name", "a"}}};
  text.animate(0, "translation", text.floats("SCALAR", {0, 2}),
               text.floats("VEC3", {0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0}), "CUBICSPLINE");
  const Skeleton skeleton = read_gltf(text.document());
  EXPECT_NEAR(place(skeleton, 0, 1).x(), 1.5, 1e-12);
  EXPECT_NEAR(place(skeleton, 0, 2).x(), 1, 1e-12);
}

// A node above is twice as large along x: what hangs on it is twice as far, and is not turned otherwise.
TEST(GltfFile, AppliesScalesThatStand) {
  GltfText text = arm();
  text.tree["nodes"][0]["scale"] = {2, 1, 1};
  const Skeleton skeleton = read_gltf(text.document());
  EXPECT_LT((place(skeleton, 2, 0) - Vec3(6, 1, 0)).norm(), 1e-7);
  const Pose end = pose_at(skeleton, skeleton.clips.data(), 2, 2);
  EXPECT_LT((end.position - Vec3(0, 7, 0)).norm(), 1e-6);
  EXPECT_NEAR(end.orientation.angularDistance(Quaternion::Identity()), std::numbers::pi / 2, 1e-6);
}

TEST(GltfFile, TakesMatricesApart) {
  GltfText text = arm();
  // Columns: twice a quarter turn about z, then (0, 1, 0).
  text.tree["nodes"][0] = {{"children", {1}}, {"matrix", {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 0, 1, 0, 1}}};
  text.tree.erase("animations");
  const Skeleton skeleton = read_gltf(text.document());
  EXPECT_EQ(skeleton.nodes[0].name, "node 0");
  EXPECT_LT((pose_at(skeleton, nullptr, 2, 0).position - Vec3(0, 7, 0)).norm(), 1e-12);
  text.tree["nodes"][0]["matrix"][0] = 1;
  EXPECT_EQ(gltf_refusal(text), "has at /nodes/0/matrix: mirrors or shears; must be a rotation with scales");
}

// Normalised 8-bit integers: 255 is 1.
TEST(GltfFile, ReadsNormalisedIntegers) {
  GltfText text = arm();
  const auto turn = static_cast<std::size_t>(text.bytes("VEC4", {0, 0, 0, 255, 0, 0, 255, 0}));
  text.tree["accessors"][turn]["normalized"] = true;
  text.tree["animations"][0]["samplers"][0]["output"] = turn;
  EXPECT_LT((place(read_gltf(text.document()), 2, 2) - Vec3(-3, 1, 0)).norm(), 1e-9);  // half a turn
}

TEST(GltfFile, ReadsBuffersInTheText) {
  GltfText text = arm();
  EXPECT_EQ(data_of_uri("data:application/octet-stream;base64,AAECAw=="), std::string("\0\1\2\3", 4));
  EXPECT_THROW(data_of_uri("data:,hello"), std::invalid_argument);
  EXPECT_THROW(data_of_uri("data:x;base64,A?=="), std::invalid_argument);
  EXPECT_EQ(percent_decoded("a%20b%2Gc%"), "a b%2Gc%");
  const std::string document =
      R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": "data:;base64,AACAPw=="}],
          "bufferViews": [{"buffer": 0, "byteLength": 4}],
          "accessors": [{"bufferView": 0, "componentType": 5126, "count": 1, "type": "SCALAR"}]})";
  const GltfDocument read(document, [](const std::string&) { return std::string(); });
  EXPECT_EQ(read.numbers(0, "SCALAR").values, std::vector<double>{1});  // 0x3F800000
}

TEST(GltfFile, SaysWhatIsWrongAndWhere) {
  const auto changed = [](const char* pointer, const nlohmann::json& value) {
    GltfText text = arm();
    text.tree[nlohmann::json::json_pointer(pointer)] = value;
    return gltf_refusal(text);
  };
  EXPECT_EQ(changed("/asset/version", "1.0"), "is of glTF's version \"1.0\"; must be 2.0");
  EXPECT_EQ(changed("/nodes/1/children/0", 7),
            "has at /nodes/1/children/0: is 7; must be a number from 0 to 2");
  EXPECT_EQ(changed("/nodes/1/children/0", 1),
            "has at /nodes/1/children/0: is 1; must be no node that has a parent already");
  EXPECT_EQ(changed("/nodes/2/children", {0}),
            "has more than 256 nodes above node \"root\", or it is its own ancestor");
  EXPECT_EQ(changed("/nodes/1/scale", {1, 0, 1}),
            "has at /nodes/1/scale/1: is 0; must be a number from 1e-06 to 1000000");
  EXPECT_EQ(changed("/animations/0/samplers/0/input", 9),
            "has at /animations/0/samplers/0/input: is 9; must be an integer from 0 to 1");
  EXPECT_EQ(changed("/animations/0/channels/0/sampler", 1),
            "has at /animations/0/channels/0/sampler: is 1; must be an integer from 0 to 0");
  EXPECT_EQ(changed("/accessors/1/count", 1), "has at /animations/0/samplers/0/output 1 values; must have 2");
  EXPECT_EQ(changed("/accessors/1/count", 3), "has at /accessors/1 elements beyond the 32 bytes of its view");
  EXPECT_EQ(changed("/accessors/1/byteOffset", 4),
            "has at /accessors/1 elements beyond the 32 bytes of its view");
  EXPECT_EQ(changed("/accessors/1/type", "VEC3"),
            "has at /accessors/1/type: is \"VEC3\"; must be \"VEC4\" for what it is read as");
  EXPECT_EQ(changed("/accessors/0/componentType", 5124),
            "has components of type 5124, which glTF does not know");
  EXPECT_EQ(changed("/accessors/0/sparse", nlohmann::json::object()),
            "has at /accessors/0/sparse: is given; sparse accessors are not read");
  EXPECT_EQ(changed("/bufferViews/1/byteLength", 4000),
            "has at /bufferViews/1 a view beyond the 40 bytes of its buffer");
  EXPECT_EQ(changed("/bufferViews/0/byteOffset", 8),
            "has at /animations/0/samplers/0/input times that are below 0 or do not ascend");
}

TEST(GltfFile, IsNoFileThatEndsEarly) {
  const std::string whole = arm().glb();
  const auto none = [](const std::string&) { return std::string(); };
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THROW(GltfDocument(whole.substr(0, size), none), std::invalid_argument) << size;
  }
}

}  // namespace
}  // namespace weft::scene::test
