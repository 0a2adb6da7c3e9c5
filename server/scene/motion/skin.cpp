#include "scene/motion/skin.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace weft::scene {
namespace {

using nlohmann::json;

struct SkinJoints {
  std::vector<std::size_t> nodes;
  std::vector<Eigen::Matrix4d> from_mesh;  ///< inverse bind matrices: mesh to joint
};

SkinJoints read_joints(const GltfDocument& document, std::size_t skin) {
  SkinJoints joints;
  const std::size_t nodes = document.count("nodes");
  std::optional<std::size_t> matrices;
  document.read("skins", skin, [&](Object& object) {
    object.require("joints", "an array of nodes");
    object.each("joints", 1, nodes, [&](const json& node, const std::string& at) {
      const auto index = read_number(node, at, {0, static_cast<double>(nodes) - 1}, object.report());
      joints.nodes.push_back(static_cast<std::size_t>(index.value_or(0)));
    });
    if (object.has("inverseBindMatrices"))
      matrices = document.index(object, "inverseBindMatrices", "accessors");
  });
  joints.from_mesh.assign(joints.nodes.size(), Eigen::Matrix4d::Identity());
  if (!matrices) return joints;
  const GltfDocument::Numbers numbers = document.numbers(*matrices, "MAT4");
  if (numbers.count < joints.nodes.size())
    throw std::invalid_argument("has at " + element_path("/skins", skin) + "/inverseBindMatrices " +
                                std::to_string(numbers.count) + " matrices for " +
                                std::to_string(joints.nodes.size()) + " joints");
  for (std::size_t i = 0; i < joints.nodes.size(); ++i)
    joints.from_mesh[i] = Eigen::Map<const Eigen::Matrix4d>(numbers.at(i));
  return joints;
}

/// Adds a primitive's vertices, each to the joint of its largest weight.
void add_vertices(const GltfDocument& document, Object& primitive, const SkinJoints& joints, Skin& skin) {
  const json* attributes = primitive.find("attributes");
  if (attributes == nullptr || !attributes->is_object() || !attributes->contains("JOINTS_0")) return;
  std::size_t position = 0, joint = 0, weight = 0;
  GltfDocument::read_part(*attributes, primitive.path("attributes"), [&](Object& object) {
    position = document.index(object, "POSITION", "accessors");
    joint = document.index(object, "JOINTS_0", "accessors");
    weight = document.index(object, "WEIGHTS_0", "accessors");
  });
  const GltfDocument::Numbers places = document.numbers(position, "VEC3");
  const GltfDocument::Numbers owners = document.numbers(joint, "VEC4");
  const GltfDocument::Numbers weights = document.numbers(weight, "VEC4");
  if (owners.count != places.count || weights.count != places.count)
    throw std::invalid_argument("has at " + primitive.path("attributes") +
                                " other numbers of positions, joints and weights");
  for (std::size_t i = 0; i < places.count; ++i) {
    const double* shares = weights.at(i);
    const auto most = static_cast<std::size_t>(std::max_element(shares, shares + 4) - shares);
    const double owner = owners.at(i)[most];
    if (!(owner < static_cast<double>(joints.nodes.size())))
      throw std::invalid_argument("has at " + primitive.path("attributes") + " a joint beyond the skin's " +
                                  std::to_string(joints.nodes.size()));
    const auto index = static_cast<std::size_t>(std::max(owner, 0.0));
    const Vec3 place = (joints.from_mesh[index] * Vec3(places.at(i)).homogeneous()).head<3>();
    skin[joints.nodes[index]].push_back(place);
  }
}

}  // namespace

Skin read_skin(const GltfDocument& document) {
  constexpr std::size_t kMostPrimitives = 10'000;
  Skin skin;
  for (std::size_t node = 0; node < document.count("nodes"); ++node) {
    std::optional<std::size_t> mesh, joints;
    document.read("nodes", node, [&](Object& object) {
      if (!object.has("skin") || !object.has("mesh")) return;
      mesh = document.index(object, "mesh", "meshes");
      joints = document.index(object, "skin", "skins");
    });
    if (!mesh) continue;
    const SkinJoints hung = read_joints(document, *joints);
    document.read("meshes", *mesh, [&](Object& object) {
      object.each("primitives", 1, kMostPrimitives, [&](const json& value, const std::string& path) {
        GltfDocument::read_part(value, path,
                                [&](Object& primitive) { add_vertices(document, primitive, hung, skin); });
      });
    });
  }
  return skin;
}

}  // namespace weft::scene
