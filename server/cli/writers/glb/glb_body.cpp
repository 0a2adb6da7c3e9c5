#include "cli/writers/glb/glb_body.h"

#include <utility>

namespace weft::cli {
namespace {

using nlohmann::ordered_json;
using Target = GlbDocument::Target;

/// All vectors of `width` components are the first.
bool constant(const std::vector<float>& values, std::size_t width) {
  for (std::size_t i = width; i < values.size(); ++i) {
    if (values[i] != values[i - width]) return false;
  }
  return true;
}

std::vector<float> first(const std::vector<float>& values, std::ptrdiff_t width) {
  return {values.begin(), values.begin() + width};
}

}  // namespace

void GlbBody::write(const Pose& pose) {
  const Eigen::Vector3f position = pose.position.cast<float>();
  const Eigen::Quaternionf turned = pose.orientation.cast<float>().normalized();
  positions_.insert(positions_.end(), {position.x(), position.y(), position.z()});
  quaternions_.insert(quaternions_.end(), {turned.x(), turned.y(), turned.z(), turned.w()});
}

void GlbBody::describe(GlbDocument& document, const BodyMesh& mesh, int times, int material) const {
  ordered_json attributes{{"POSITION", document.add_floats(mesh.positions, "VEC3", Target::vertices, true)},
                          {"NORMAL", document.add_floats(mesh.normals, "VEC3", Target::vertices)}};
  const int indices = document.add_indices(mesh.triangles);
  const int node = document.add_node({{"name", mesh.name},
                                      {"mesh", document.add_mesh(mesh.name, std::move(attributes), indices,
                                                                 material, ordered_json::array())},
                                      {"translation", first(positions_, 3)},
                                      {"rotation", first(quaternions_, 4)}});
  if (!constant(positions_, 3))
    document.animate(node, "translation", times, document.add_floats(positions_, "VEC3", Target::none),
                     "LINEAR");
  if (!constant(quaternions_, 4))
    document.animate(node, "rotation", times, document.add_floats(quaternions_, "VEC4", Target::none),
                     "LINEAR");
}

}  // namespace weft::cli
