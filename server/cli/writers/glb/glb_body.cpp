#include "cli/writers/glb/glb_body.h"

#include <algorithm>
#include <array>
#include <utility>

namespace weft::cli {
namespace {

using nlohmann::ordered_json;
using Target = GlbDocument::Target;

}  // namespace

void GlbWay::add(std::span<const float> vector) {
  if (count_++ == 0) first_.assign(vector.begin(), vector.end());
  std::string bytes;
  if (!aside_) {
    if (std::equal(vector.begin(), vector.end(), first_.begin())) return;
    aside_ = std::make_unique<SpillFile>(path_);
    for (std::uint64_t i = 1; i < count_; ++i) append_bytes(bytes, std::span<const float>(first_));
  }
  append_bytes(bytes, vector);
  aside_->write(bytes);
}

void GlbBody::write(const Pose& pose) {
  const Eigen::Vector3f position = pose.position.cast<float>();
  const Eigen::Quaternionf turned = pose.orientation.cast<float>().normalized();
  positions_.add(std::array{position.x(), position.y(), position.z()});
  quaternions_.add(std::array{turned.x(), turned.y(), turned.z(), turned.w()});
}

void GlbBody::describe(GlbDocument& document, std::uint64_t begin, const BodyMesh& mesh, int times,
                       int material) const {
  ordered_json attributes{{"POSITION", document.add_floats(mesh.positions, "VEC3", Target::vertices, true)},
                          {"NORMAL", document.add_floats(mesh.normals, "VEC3", Target::vertices)}};
  const int indices = document.add_indices(mesh.triangles);
  const int node = document.add_node({{"name", mesh.name},
                                      {"mesh", document.add_mesh(mesh.name, std::move(attributes), indices,
                                                                 material, ordered_json::array())},
                                      {"translation", positions_.first()},
                                      {"rotation", quaternions_.first()}});
  const auto animate = [&](const char* path, const GlbWay& way, std::uint64_t at, const char* type) {
    if (way.constant()) return;
    const int view = document.add_view(at, way.bytes(), Target::none);
    document.animate(node, path, times,
                     document.add_accessor(view, 0, type, static_cast<std::size_t>(way.count())), "LINEAR");
  };
  animate("translation", positions_, begin, "VEC3");
  animate("rotation", quaternions_, begin + positions_.bytes(), "VEC4");
}

void GlbBody::copy_to(OutputFile& file) {
  positions_.copy_to(file);
  quaternions_.copy_to(file);
}

}  // namespace weft::cli
