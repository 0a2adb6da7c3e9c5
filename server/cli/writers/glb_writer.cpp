#include <tiny_gltf.h>

#include <algorithm>
#include <stdexcept>

#include "cli/writers/output_file.h"
#include "cli/writers/writers.h"

namespace weft::cli {
namespace {

/// Each frame is a morph target with a weight at each frame: the weights alone grow with the square of the
/// frames (5.8 MB here), and viewers are not made for more targets.
constexpr int kMaxFrames = 1200;
/// Positions kept until the end: the file's length is part of its header.
constexpr std::size_t kMaxFloats = std::size_t{128} << 20;

class GlbWriter final : public MeshWriter {
 public:
  explicit GlbWriter(const std::string& path) : path_(path), file_(path) {}

  int max_frames() const override { return kMaxFrames; }

  void write(const MeshFrame& frame) override {
    if (frames_.empty()) {
      rows_ = frame.rows;
      cols_ = frame.cols;
    }
    MeshFrame same = on_grid(frame, rows_, cols_);
    if (frames_.size() == kMaxFrames || (frames_.size() + 1) * same.positions.size() > kMaxFloats) {
      throw std::runtime_error(path_ + ": a .glb holds at most " + std::to_string(kMaxFrames) +
                               " frames and " + std::to_string(kMaxFloats / 3) +
                               " nodes in all; .pc2 has no such limit");
    }
    same.velocities.clear();
    frames_.push_back(std::move(same));
  }

  void finish() override {
    tinygltf::Model model;
    model.asset.version = "2.0";
    model.asset.generator = "weft";
    model.buffers.emplace_back();
    if (!frames_.empty()) {
      add_mesh(model);
      if (frames_.size() > 1) add_animation(model);
    }
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, file_.stream(), false, true);
    file_.close();
  }

 private:
  /// Appends `count` elements to the buffer, and the view and accessor that show them. Returns the accessor.
  template <class Component>
  static int add_data(tinygltf::Model& model, const std::vector<Component>& data, int type,
                      int component_type, int target, bool with_bounds) {
    auto& buffer = model.buffers[0].data;
    const auto* bytes = reinterpret_cast<const unsigned char*>(data.data());
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = buffer.size();
    view.byteLength = data.size() * sizeof(Component);
    view.target = target;
    buffer.insert(buffer.end(), bytes, bytes + view.byteLength);
    model.bufferViews.push_back(view);

    const auto width =
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model.bufferViews.size()) - 1;
    accessor.componentType = component_type;
    accessor.type = type;
    accessor.count = data.size() / width;
    if (with_bounds) {
      for (std::size_t axis = 0; axis < width; ++axis) {
        auto low = data[axis], high = data[axis];
        for (std::size_t i = axis; i < data.size(); i += width) {
          low = std::min(low, data[i]);
          high = std::max(high, data[i]);
        }
        accessor.minValues.push_back(static_cast<double>(low));
        accessor.maxValues.push_back(static_cast<double>(high));
      }
    }
    model.accessors.push_back(accessor);
    return static_cast<int>(model.accessors.size()) - 1;
  }
  static int add_floats(tinygltf::Model& model, const std::vector<float>& data, int type, int target,
                        bool with_bounds) {
    return add_data(model, data, type, TINYGLTF_COMPONENT_TYPE_FLOAT, target, with_bounds);
  }

  /// No normals: a viewer then shades each face by its own, which stays right while the mesh moves.
  void add_mesh(tinygltf::Model& model) const {
    const std::vector<float>& base = frames_.front().positions;
    std::vector<float> uv;
    std::vector<std::uint32_t> triangles;
    for (int r = 0; r < rows_; ++r) {
      for (int c = 0; c < cols_; ++c) {
        uv.push_back(static_cast<float>(c) / static_cast<float>(cols_ - 1));
        uv.push_back(static_cast<float>(r) / static_cast<float>(rows_ - 1));
        if (r + 1 == rows_ || c + 1 == cols_) continue;
        const auto top = static_cast<std::uint32_t>(r * cols_ + c),
                   bottom = top + static_cast<std::uint32_t>(cols_);
        triangles.insert(triangles.end(), {top, bottom, bottom + 1, top, bottom + 1, top + 1});
      }
    }
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.attributes["POSITION"] =
        add_floats(model, base, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER, true);
    primitive.attributes["TEXCOORD_0"] =
        add_floats(model, uv, TINYGLTF_TYPE_VEC2, TINYGLTF_TARGET_ARRAY_BUFFER, false);
    primitive.indices = add_data(model, triangles, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                 TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER, false);
    for (std::size_t f = 1; f < frames_.size(); ++f) {
      std::vector<float> offsets(base.size());
      for (std::size_t i = 0; i < base.size(); ++i) {
        offsets[i] = static_cast<float>(frames_[f].coordinate(i) - frames_.front().coordinate(i));
      }
      primitive.targets.push_back(
          {{"POSITION", add_floats(model, offsets, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER, true)}});
    }
    tinygltf::Material material;
    material.doubleSided = true;
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.baseColorFactor = {0.75, 0.25, 0.2, 1};
    model.materials.push_back(material);
    primitive.material = 0;
    tinygltf::Mesh mesh;
    mesh.primitives.push_back(primitive);
    mesh.weights.assign(frames_.size() - 1, 0.0);
    model.meshes.push_back(mesh);
    tinygltf::Node node;
    node.mesh = 0;
    const auto& place = frames_.front().place;
    if (place != std::array<double, 3>{}) node.translation.assign(place.begin(), place.end());
    model.nodes.push_back(node);
    tinygltf::Scene scene;
    scene.nodes.push_back(0);
    model.scenes.push_back(scene);
    model.defaultScene = 0;
  }

  /// At each frame's time its own target weighs 1 and all others 0; linear between.
  void add_animation(tinygltf::Model& model) const {
    const std::size_t targets = frames_.size() - 1;
    std::vector<float> times;
    std::vector<float> weights(frames_.size() * targets, 0.0f);
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      times.push_back(static_cast<float>(frames_[f].time - frames_.front().time));
      if (f > 0) weights[f * targets + f - 1] = 1.0f;
    }
    tinygltf::AnimationSampler sampler;
    sampler.interpolation = "LINEAR";
    sampler.input = add_floats(model, times, TINYGLTF_TYPE_SCALAR, 0, true);
    sampler.output = add_floats(model, weights, TINYGLTF_TYPE_SCALAR, 0, false);
    tinygltf::AnimationChannel channel;
    channel.sampler = 0;
    channel.target_node = 0;
    channel.target_path = "weights";
    tinygltf::Animation animation;
    animation.samplers.push_back(sampler);
    animation.channels.push_back(channel);
    model.animations.push_back(animation);
  }

  std::string path_;
  OutputFile file_;
  int rows_ = 0, cols_ = 0;
  std::vector<MeshFrame> frames_;
};

}  // namespace

std::unique_ptr<MeshWriter> open_glb(const std::string& path) { return std::make_unique<GlbWriter>(path); }

}  // namespace weft::cli
