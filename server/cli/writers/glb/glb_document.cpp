#include "cli/writers/glb/glb_document.h"

#include <algorithm>
#include <utility>

#include "cli/writers/output_file.h"

namespace weft::cli {
namespace {

using nlohmann::ordered_json;

// glTF's componentType.
constexpr int kUnsignedInt = 5125, kFloat = 5126;
constexpr int kTriangles = 4;

std::size_t width_of(std::string_view type) {
  return type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
}

}  // namespace

Bounds Bounds::of(std::span<const float> values, std::size_t width) {
  Bounds bounds;
  bounds.min.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width));
  bounds.max = bounds.min;
  for (std::size_t i = width; i < values.size(); ++i) {
    bounds.min[i % width] = std::min(bounds.min[i % width], values[i]);
    bounds.max[i % width] = std::max(bounds.max[i % width], values[i]);
  }
  return bounds;
}

GlbDocument::GlbDocument(const std::string& scene) {
  document_["asset"] = {{"version", "2.0"}, {"generator", "weft"}};
  document_["scene"] = 0;
  document_["scenes"] = ordered_json::array({{{"name", scene}}});
}

int GlbDocument::add(const char* array, ordered_json element) {
  document_[array].push_back(std::move(element));
  return static_cast<int>(document_[array].size()) - 1;
}

int GlbDocument::add_view(std::uint64_t offset, std::uint64_t bytes, Target target, int stride) {
  ordered_json view{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}};
  if (stride > 0) view["byteStride"] = stride;
  if (target != Target::none) view["target"] = static_cast<int>(target);
  return add("bufferViews", std::move(view));
}

int GlbDocument::add_accessor(int view, std::uint64_t offset, const char* type, std::size_t count,
                              const std::optional<Bounds>& bounds) {
  ordered_json accessor{{"bufferView", view},
                        {"byteOffset", offset},
                        {"componentType", kFloat},
                        {"count", count},
                        {"type", type}};
  if (bounds) {
    accessor["min"] = bounds->min;
    accessor["max"] = bounds->max;
  }
  return add("accessors", std::move(accessor));
}

int GlbDocument::add_floats(const std::vector<float>& values, const char* type, Target target,
                            bool with_bounds) {
  const std::size_t width = width_of(type);
  const int view = add_view(data_begin_ + data_.size(), values.size() * sizeof(float), target);
  append_bytes(data_, std::span(values));
  return add_accessor(view, 0, type, values.size() / width,
                      with_bounds ? std::optional(Bounds::of(values, width)) : std::nullopt);
}

int GlbDocument::add_indices(const std::vector<std::uint32_t>& indices) {
  const int view =
      add_view(data_begin_ + data_.size(), indices.size() * sizeof(std::uint32_t), Target::indices);
  append_bytes(data_, std::span(indices));
  return add(
      "accessors",
      {{"bufferView", view}, {"componentType", kUnsignedInt}, {"count", indices.size()}, {"type", "SCALAR"}});
}

int GlbDocument::add_mesh(const std::string& name, ordered_json attributes, int indices, int material,
                          ordered_json targets) {
  const std::size_t count = targets.size();
  ordered_json primitive{{"attributes", std::move(attributes)},
                         {"indices", indices},
                         {"material", material},
                         {"mode", kTriangles}};
  if (count > 0) primitive["targets"] = std::move(targets);
  ordered_json mesh{{"name", name}, {"primitives", ordered_json::array({std::move(primitive)})}};
  if (count > 0) mesh["weights"] = std::vector<int>(count, 0);
  return add("meshes", std::move(mesh));
}

int GlbDocument::add_material(const std::string& name, const std::vector<double>& colour, bool double_sided) {
  return add("materials", {{"name", name},
                           {"doubleSided", double_sided},
                           {"pbrMetallicRoughness", {{"baseColorFactor", colour}, {"metallicFactor", 0}}}});
}

int GlbDocument::add_node(ordered_json node) {
  const int index = add("nodes", std::move(node));
  document_["scenes"][0]["nodes"].push_back(index);
  return index;
}

void GlbDocument::animate(int node, const char* path, int input, int output, const char* interpolation) {
  ordered_json& animation = document_["animations"][0];
  animation["samplers"].push_back({{"input", input}, {"interpolation", interpolation}, {"output", output}});
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
}

std::string GlbDocument::json(std::uint64_t before) {
  if (before + data_.size() > 0)
    document_["buffers"] = ordered_json::array({{{"byteLength", before + data_.size()}}});
  return document_.dump();
}

}  // namespace weft::cli
