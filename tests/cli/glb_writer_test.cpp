// .glb files read back with tinygltf: mesh, morph targets and animation are what was written.
#include <tiny_gltf.h>

#include <cstring>
#include <map>
#include <stdexcept>
#include <utility>

#include "fixtures.h"

namespace weft::cli::test {
namespace {

class GlbWriterTest : public OutputTest {
 public:
  tinygltf::Model read(const std::string& name) const {
    tinygltf::Model model;
    std::string error, warning;
    EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning, path(name)));
    EXPECT_EQ(error, "");
    EXPECT_EQ(warning, "");
    return model;
  }
  template <class Component>
  static std::vector<Component> data(const tinygltf::Model& model, int index) {
    const auto& accessor = model.accessors.at(static_cast<std::size_t>(index));
    const auto& view = model.bufferViews.at(static_cast<std::size_t>(accessor.bufferView));
    std::vector<Component> values(accessor.count * static_cast<std::size_t>(tinygltf::GetNumComponentsInType(
                                                       static_cast<std::uint32_t>(accessor.type))));
    std::memcpy(values.data(), &model.buffers[0].data[view.byteOffset + accessor.byteOffset],
                values.size() * sizeof(Component));
    return values;
  }
};

TEST_F(GlbWriterTest, ReadsBack) {
  write("mesh.glb", {one_cell(0, 0.0, 0), one_cell(1, 0.5, 1), one_cell(2, 1.0, -3)});

  const tinygltf::Model model = read("mesh.glb");
  ASSERT_EQ(model.meshes.size(), 1u);
  const auto& primitive = model.meshes[0].primitives.at(0);
  EXPECT_EQ(data<float>(model, primitive.attributes.at("POSITION")), one_cell(0, 0, 0).positions);
  EXPECT_EQ(data<float>(model, primitive.attributes.at("TEXCOORD_0")),
            (std::vector<float>{0, 0, 1, 0, 0, 1, 1, 1}));
  EXPECT_EQ(data<std::uint32_t>(model, primitive.indices), (std::vector<std::uint32_t>{0, 2, 3, 0, 3, 1}));
  const auto& bounds = model.accessors[static_cast<std::size_t>(primitive.attributes.at("POSITION"))];
  EXPECT_EQ(bounds.minValues, (std::vector<double>{0, -1, 0}));
  EXPECT_EQ(bounds.maxValues, (std::vector<double>{1, 0, 0}));

  ASSERT_EQ(primitive.targets.size(), 2u);  // offsets from the first frame
  EXPECT_EQ(data<float>(model, primitive.targets[0].at("POSITION")),
            (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(data<float>(model, primitive.targets[1].at("POSITION")),
            (std::vector<float>{0, 0, -3, 0, 0, -3, 0, 0, -3, 0, 0, -3}));

  ASSERT_EQ(model.animations.size(), 1u);
  const auto& sampler = model.animations[0].samplers.at(0);
  EXPECT_EQ(model.animations[0].channels.at(0).target_path, "weights");
  EXPECT_EQ(sampler.interpolation, "LINEAR");
  EXPECT_EQ(data<float>(model, sampler.input), (std::vector<float>{0, 0.5f, 1}));
  EXPECT_EQ(data<float>(model, sampler.output), (std::vector<float>{0, 0, 1, 0, 0, 1}));
}

// The mesh keeps its digits; a cloth that gets a new place meanwhile stays where it is.
TEST_F(GlbWriterTest, StandsAtThePlaceOfItsFirstFrame) {
  MeshFrame first = one_cell(0, 0.0, 0.25f), second = one_cell(1, 0.5, -0.75f);
  first.place = {10000, -4, 0};
  second.place = {10000, -4, 4};
  write("far.glb", {first, second});
  const tinygltf::Model model = read("far.glb");
  EXPECT_EQ(model.nodes.at(0).translation, (std::vector<double>{10000, -4, 0}));
  const auto& primitive = model.meshes.at(0).primitives.at(0);
  EXPECT_EQ(data<float>(model, primitive.attributes.at("POSITION")), first.positions);
  EXPECT_EQ(data<float>(model, primitive.targets.at(0).at("POSITION")),
            (std::vector<float>{0, 0, 3, 0, 0, 3, 0, 0, 3, 0, 0, 3}));
}

TEST_F(GlbWriterTest, OneFrameIsAStillMesh) {
  write("still.glb", {one_cell(0, 0, 0)});
  const tinygltf::Model model = read("still.glb");
  EXPECT_TRUE(model.animations.empty());
  EXPECT_TRUE(model.meshes.at(0).primitives.at(0).targets.empty());
}

/// The node's size at each time of its animation.
std::vector<std::pair<float, float>> sizes(const tinygltf::Model& model, int node) {
  std::vector<std::pair<float, float>> sizes;
  for (const auto& channel : model.animations.at(0).channels) {
    if (channel.target_node != node || channel.target_path != "scale") continue;
    const auto& sampler = model.animations[0].samplers.at(static_cast<std::size_t>(channel.sampler));
    EXPECT_EQ(sampler.interpolation, "STEP");
    const auto times = GlbWriterTest::data<float>(model, sampler.input),
               scales = GlbWriterTest::data<float>(model, sampler.output);
    for (std::size_t i = 0; i < times.size(); ++i) sizes.emplace_back(times[i], scales[3 * i]);
  }
  return sizes;
}

// 130 frames: stretches of frames 0 to 60, 60 to 120 and 120 to 129, of which one is seen at a time.
TEST_F(GlbWriterTest, ManyFramesAreCutIntoStretchesThatMeet) {
  std::vector<MeshFrame> frames;
  for (int frame = 0; frame < 130; ++frame)
    frames.push_back(one_cell(frame, frame, static_cast<float>(frame)));
  write("long.glb", frames);
  const tinygltf::Model model = read("long.glb");
  ASSERT_EQ(model.nodes.size(), 3u);
  using Sizes = std::vector<std::pair<float, float>>;
  EXPECT_EQ(sizes(model, 0), (Sizes{{0, 1}, {60, 0}}));
  EXPECT_EQ(sizes(model, 1), (Sizes{{0, 0}, {60, 1}, {120, 0}}));
  EXPECT_EQ(sizes(model, 2), (Sizes{{0, 0}, {120, 1}}));
  const std::vector<std::size_t> targets{60, 60, 9};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& primitive = model.meshes.at(i).primitives.at(0);
    EXPECT_EQ(model.nodes[i].mesh, static_cast<int>(i));
    ASSERT_EQ(primitive.targets.size(), targets[i]);
    const float base = data<float>(model, primitive.attributes.at("POSITION"))[2];
    EXPECT_EQ(base, 60.0f * static_cast<float>(i));
    const auto last = data<float>(model, primitive.targets.back().at("POSITION"));
    EXPECT_EQ(last[2], static_cast<float>(targets[i]));
  }
}

TEST_F(GlbWriterTest, ATearEndsAStretch) {
  std::vector<MeshFrame> frames{one_cell(0, 0, 0), one_cell(1, 1, 0), one_cell(2, 2, 0)};
  for (MeshFrame& frame : frames) frame = on_grid(frame, 3, 3);
  frames[1].torn_faces = frames[2].torn_faces = {2};
  write("torn.glb", frames);
  const tinygltf::Model model = read("torn.glb");
  ASSERT_EQ(model.meshes.size(), 2u);
  const auto triangles = [&](std::size_t mesh) {
    return data<std::uint32_t>(model, model.meshes[mesh].primitives.at(0).indices).size() / 3;
  };
  EXPECT_EQ(triangles(0), 8u);
  EXPECT_EQ(triangles(1), 6u);  // from frame 1 on
}

TEST_F(GlbWriterTest, NormalsMoveAsTheMeshDoes) {
  MeshFrame flat = one_cell(0, 0, 0), upright = one_cell(1, 1, 0);
  // Turned about the upper edge: the lower corners go to z = 1, the normal from z to y.
  upright.positions = {0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 1};
  write("turn.glb", {flat, upright});
  const tinygltf::Model model = read("turn.glb");
  const auto& primitive = model.meshes.at(0).primitives.at(0);
  EXPECT_EQ(data<float>(model, primitive.attributes.at("NORMAL")),
            (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(data<float>(model, primitive.targets.at(0).at("NORMAL")),
            (std::vector<float>{0, 1, -1, 0, 1, -1, 0, 1, -1, 0, 1, -1}));
}

TEST_F(GlbWriterTest, BodiesAreNodesThatMove) {
  const Quaternion half_turn(0, 0, 1, 0);  // about y
  const BodyMesh box = body_mesh("obstacle-0", Box{Vec3(1, 2, 3)});
  write("body.glb", {one_cell(0, 0, 0), one_cell(1, 1, 0)}, {box},
        {{Vec3(1, 2, 3), Quaternion::Identity()}, {Vec3(4, 2, 3), half_turn}});
  const tinygltf::Model model = read("body.glb");
  const tinygltf::Node& node = model.nodes.at(1);
  EXPECT_EQ(node.name, "obstacle-0");
  EXPECT_EQ(node.translation, (std::vector<double>{1, 2, 3}));
  const auto& primitive = model.meshes.at(static_cast<std::size_t>(node.mesh)).primitives.at(0);
  EXPECT_EQ(data<float>(model, primitive.attributes.at("POSITION")), box.positions);
  std::map<std::string, std::vector<float>> ways;
  for (const auto& channel : model.animations.at(0).channels) {
    if (channel.target_node != 1) continue;
    const auto& sampler = model.animations[0].samplers.at(static_cast<std::size_t>(channel.sampler));
    EXPECT_EQ(data<float>(model, sampler.input), (std::vector<float>{0, 1}));
    ways[channel.target_path] = data<float>(model, sampler.output);
  }
  EXPECT_EQ(ways.at("translation"), (std::vector<float>{1, 2, 3, 4, 2, 3}));
  EXPECT_EQ(ways.at("rotation"), (std::vector<float>{0, 0, 0, 1, 0, 1, 0, 0}));  // x, y, z, w
}

// 32 bits have the length: 300,000 frames of 33 x 33 nodes have 7.8 GB and more.
TEST_F(GlbWriterTest, MoreThanItsLengthCanTellIsRefusedWithTheFirstFrame) {
  ExportedScene scene{"scene", {"cloth"}, {}};
  scene.frames = 300'000;
  const auto writer = SceneWriter::open(path("long.glb"), scene);
  try {
    writer->write({{on_grid(one_cell(0, 0, 0), 33, 33)}, {}});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with(path("long.glb") + ": a .glb holds at most 4 GiB"))
        << error.what();
  }
}

TEST_F(GlbWriterTest, FramesOfASceneThatStandsStillAreOne) {
  write("paused.glb", {one_cell(0, 0, 0), one_cell(0, 0, 0), one_cell(1, 1, 0)});
  EXPECT_EQ(read("paused.glb").meshes.at(0).primitives.at(0).targets.size(), 1u);
}

}  // namespace
}  // namespace weft::cli::test
