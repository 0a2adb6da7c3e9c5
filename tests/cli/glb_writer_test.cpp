// .glb files read back with tinygltf: mesh, morph targets and animation are what was written.
#include <tiny_gltf.h>

#include <cstring>
#include <stdexcept>

#include "fixtures.h"

namespace weft::cli::test {
namespace {

class GlbWriterTest : public OutputTest {
 protected:
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
  const auto writer = MeshWriter::open(path("mesh.glb"));
  writer->write(one_cell(0, 0.0, 0));
  writer->write(one_cell(1, 0.5, 1));
  writer->write(one_cell(2, 1.0, -3));
  writer->finish();

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
  const auto writer = MeshWriter::open(path("far.glb"));
  MeshFrame first = one_cell(0, 0.0, 0.25f), second = one_cell(1, 0.5, -0.75f);
  first.place = {10000, -4, 0};
  second.place = {10000, -4, 4};
  writer->write(first);
  writer->write(second);
  writer->finish();
  const tinygltf::Model model = read("far.glb");
  EXPECT_EQ(model.nodes.at(0).translation, (std::vector<double>{10000, -4, 0}));
  const auto& primitive = model.meshes.at(0).primitives.at(0);
  EXPECT_EQ(data<float>(model, primitive.attributes.at("POSITION")), first.positions);
  EXPECT_EQ(data<float>(model, primitive.targets.at(0).at("POSITION")),
            (std::vector<float>{0, 0, 3, 0, 0, 3, 0, 0, 3, 0, 0, 3}));
}

TEST_F(GlbWriterTest, OneFrameIsAStillMesh) {
  const auto writer = MeshWriter::open(path("still.glb"));
  writer->write(one_cell(0, 0, 0));
  writer->finish();
  const tinygltf::Model model = read("still.glb");
  EXPECT_TRUE(model.animations.empty());
  EXPECT_TRUE(model.meshes.at(0).primitives.at(0).targets.empty());
}

TEST_F(GlbWriterTest, MoreFramesThanItHoldsAreRefused) {
  const auto writer = MeshWriter::open(path("long.glb"));
  EXPECT_EQ(writer->max_frames(), 1200);
  for (int frame = 0; frame < 1200; ++frame) writer->write(one_cell(frame, frame, 0));
  EXPECT_THROW(writer->write(one_cell(1200, 1200, 0)), std::runtime_error);
}

}  // namespace
}  // namespace weft::cli::test
