#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "scene/motion/gltf_document.h"
#include "scene/readers.h"
#include "scene/start/start_files.h"

namespace weft::scene {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxMeshName = 1000;

/// The node of a cloth, or of a stretch of its frames.
struct StretchNode {
  std::size_t node = 0, mesh = 0;
  Vec3 place{0, 0, 0};
  std::vector<double> times = {0};  ///< of the mesh itself and of each of its targets, s
};

/// A name is the cloth's, or that with the number of the frame at which the stretch begins.
bool is_stretch(const std::string& name, const std::string& cloth) {
  if (name == cloth) return true;
  return name.starts_with(cloth + ".") && name.size() > cloth.size() + 1 &&
         name.find_first_not_of("0123456789", cloth.size() + 1) == std::string::npos;
}

std::vector<StretchNode> find_stretches(const GltfDocument& document, const StartChoice& choice) {
  std::vector<StretchNode> found;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < document.count("nodes"); ++i) {
    document.read("nodes", i, [&](Object& object) {
      std::string name;
      if (!object.has("mesh") || !object.string("name", name, kMaxMeshName)) return;
      names.push_back(name);
      if (!is_stretch(name, choice.cloth)) return;
      StretchNode& stretch = found.emplace_back();
      stretch.node = i;
      stretch.mesh = document.index(object, "mesh", "meshes");
      object.vector("translation", stretch.place, {-1e9, 1e9});
      for (const char* key : {"matrix", "rotation"}) {
        if (object.has(key)) object.problem(key, "is given; the node of a cloth that is read has none");
      }
    });
  }
  if (found.empty()) refuse_mesh_name(choice, {names.begin(), names.end()});
  return found;
}

/// The times of each node's weights in the first animation.
std::map<std::size_t, std::vector<double>> times_of_weights(const GltfDocument& document) {
  constexpr std::size_t kMostChannels = 100'000;
  std::map<std::size_t, std::vector<double>> times;
  if (document.count("animations") == 0) return times;
  document.read("animations", 0, [&](Object& animation) {
    animation.require("samplers", "an array");
    animation.each("samplers", 1, kMostChannels, [](const json&, const std::string&) {});
    if (animation.report().count() > 0) return;
    const json& samplers = *animation.find("samplers");
    animation.each("channels", 1, kMostChannels, [&](const json& value, const std::string& path) {
      GltfDocument::read_part(value, path, [&](Object& channel) {
        std::uint64_t sampler = 0;
        channel.require("sampler", "an index");
        channel.integer("sampler", sampler, {0, static_cast<double>(samplers.size()) - 1});
        if (!channel.require("target", "an object") || channel.report().count() > 0) return;
        GltfDocument::read_part(*channel.find("target"), channel.path("target"), [&](Object& target) {
          std::string property;
          if (!target.has("node") || !target.string("path", property, 64) || property != "weights") return;
          const std::size_t node = document.index(target, "node", "nodes");
          GltfDocument::read_part(samplers[sampler], animation.path("samplers"), [&](Object& keys) {
            times[node] = document.numbers(document.index(keys, "input", "accessors"), "SCALAR").values;
          });
        });
      });
    });
  });
  return times;
}

std::vector<double> values_of(const GltfDocument& document, Object& attributes, const char* name,
                              std::string_view type) {
  return document.numbers(document.index(attributes, name, "accessors"), type).values;
}

/// The mesh's nodes, and `target` counted from 1 of its targets added; 0: none.
StartMesh read_mesh_at(const GltfDocument& document, const StretchNode& stretch, std::size_t target) {
  StartMesh mesh;
  document.read("meshes", stretch.mesh, [&](Object& object) {
    object.require("primitives", "an array");
    object.each("primitives", 1, 1, [&](const json& value, const std::string& path) {
      GltfDocument::read_part(value, path, [&](Object& primitive) {
        if (!primitive.require("attributes", "an object")) return;
        std::vector<double> positions, uv;
        GltfDocument::read_part(*primitive.find("attributes"), primitive.path("attributes"),
                                [&](Object& own) {
                                  positions = values_of(document, own, "POSITION", "VEC3");
                                  uv = values_of(document, own, "TEXCOORD_0", "VEC2");
                                });
        if (target > 0) {
          primitive.require("targets", "an array");
          std::size_t number = 0;
          primitive.each(
              "targets", target, kMaxGltfElements, [&](const json& offsets, const std::string& at) {
                if (++number != target) return;
                GltfDocument::read_part(offsets, at, [&](Object& own) {
                  const std::vector<double> added = values_of(document, own, "POSITION", "VEC3");
                  if (added.size() != positions.size())
                    throw std::invalid_argument("has at " + at + " another number of vertices than its mesh");
                  for (std::size_t i = 0; i < added.size(); ++i) positions[i] += added[i];
                });
              });
        }
        if (positions.size() > 3 * static_cast<std::size_t>(kMaxClothNodes))
          throw std::invalid_argument("has a mesh of more than " + std::to_string(kMaxClothNodes) +
                                      " vertices");
        std::vector<double> u;
        for (std::size_t i = 0; i < uv.size(); i += 2) u.push_back(uv[i]);
        for (std::size_t i = 0; i < positions.size(); i += 3)
          mesh.nodes.emplace_back(stretch.place + Vec3(&positions[i]));
        set_grid(mesh, u);
      });
    });
  });
  return mesh;
}

}  // namespace

StartMesh read_glb_start(std::string_view bytes, const StartChoice& choice) {
  const GltfDocument document(bytes, [](const std::string&) -> std::string {
    throw std::invalid_argument("has a buffer in another file; must have it in itself, as a .glb file has");
  });
  std::vector<StretchNode> stretches = find_stretches(document, choice);
  const auto weights = times_of_weights(document);
  std::vector<double> times;
  std::vector<std::pair<const StretchNode*, std::size_t>> frames;  // and the target that it is
  for (StretchNode& stretch : stretches) {
    if (const auto at = weights.find(stretch.node); at != weights.end()) stretch.times = at->second;
    // A stretch begins with the last frame of the one before it.
    for (std::size_t i = frames.empty() ? 0 : 1; i < stretch.times.size(); ++i) {
      times.push_back(stretch.times[i]);
      frames.emplace_back(&stretch, i);
    }
  }
  const auto [stretch, target] = frames[chosen_frame(choice, times)];
  return read_mesh_at(document, *stretch, target);
}

}  // namespace weft::scene
