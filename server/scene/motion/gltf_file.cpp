#include "scene/motion/gltf_file.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>

#include "scene/beside_file.h"
#include "scene/motion/data_uri.h"
#include "scene/motion/motion_files.h"

namespace weft::scene {
namespace {

using nlohmann::json;

constexpr double kGltfInterval = 1.0 / 60;  // s, in which animations are sampled
constexpr Range kGltfPlace{-1e9, 1e9};
constexpr Range kGltfScale{1e-6, 1e6};
constexpr Range kGltfTurn{-1e6, 1e6};

/// Scales of less than this, relative, are none: what exporters round.
constexpr double kSameScale = 1e-3;

/// A node's matrix must be a translation, a rotation and scales (glTF 2.0, 3.5.3).
void take_apart(Object& object, Skeleton::Node& node) {
  std::array<double, 16> columns{};
  if (!object.numbers("matrix", columns.data(), columns.size(), kGltfPlace)) return;
  const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix4d>(columns.data());
  const Eigen::Matrix3d frame = matrix.topLeftCorner<3, 3>();
  const Vec3 scale = frame.colwise().norm().transpose();
  if (!(scale.minCoeff() >= kGltfScale.min && scale.maxCoeff() <= kGltfScale.max)) {
    object.problem("matrix", "has an axis whose length is not " + kGltfScale.text());
    return;
  }
  const Eigen::Matrix3d rotation = frame * scale.cwiseInverse().asDiagonal();
  constexpr double kTolerance = 1e-3;
  if (!(rotation.transpose() * rotation).isIdentity(kTolerance) || rotation.determinant() < 0) {
    object.problem("matrix", "mirrors or shears; must be a rotation with scales");
    return;
  }
  node.translation = matrix.topRightCorner<3, 1>();
  node.rotation = Quaternion(rotation).normalized();
  node.scale = scale;
}

Skeleton::Node read_node(Object& object, std::size_t index) {
  Skeleton::Node node;
  if (!object.string("name", node.name, kMaxNodeName)) node.name = "node " + std::to_string(index);
  if (object.has("matrix")) {
    take_apart(object, node);
    return node;
  }
  object.vector("translation", node.translation, kGltfPlace);
  Eigen::Vector4d turn(0, 0, 0, 1);
  object.direction("rotation", turn, kGltfTurn);
  node.rotation = Quaternion(turn);
  object.vector("scale", node.scale, kGltfScale);
  return node;
}

void read_nodes(const GltfDocument& document, Skeleton& skeleton) {
  const std::size_t count = document.count("nodes");
  if (count == 0 || count > kMaxSkeletonNodes)
    throw std::invalid_argument("has at /nodes " + std::to_string(count) + " nodes; must have 1 to " +
                                std::to_string(kMaxSkeletonNodes));
  for (std::size_t i = 0; i < count; ++i) {
    document.read("nodes", i, [&](Object& object) { skeleton.nodes.push_back(read_node(object, i)); });
  }
  for (std::size_t i = 0; i < count; ++i) {
    document.read("nodes", i, [&](Object& object) {
      object.each("children", 1, count, [&](const json& child, const std::string& at) {
        const auto number = read_number(child, at, {0, static_cast<double>(count - 1)}, object.report());
        if (!number) return;
        int& parent = skeleton.nodes[static_cast<std::size_t>(*number)].parent;
        if (parent >= 0) object.report().refuse(child, at, "no node that has a parent already");
        parent = static_cast<int>(i);
      });
    });
  }
  check_depth(skeleton);
}

/// One of an animation's samplers, and what of it its channels need.
struct Sampler {
  std::size_t input = 0, output = 0;
  Interpolation interpolation = Interpolation::linear;
};

Sampler read_sampler(const GltfDocument& document, const json& value, const std::string& path) {
  Sampler sampler;
  GltfDocument::read_part(value, path, [&](Object& object) {
    sampler.input = document.index(object, "input", "accessors");
    sampler.output = document.index(object, "output", "accessors");
    const int choice = object.choice("interpolation", {"STEP", "LINEAR", "CUBICSPLINE"});
    if (choice == 0) sampler.interpolation = Interpolation::step;
    if (choice == 2) sampler.interpolation = Interpolation::cubic;
  });
  return sampler;
}

/// Fills in the track's keys, and gives its values, of which a cubic one has three a key.
template <class Value>
GltfDocument::Numbers read_keys(const GltfDocument& document, const Sampler& sampler, const std::string& path,
                                std::string_view type, Track<Value>& track) {
  track.times = document.numbers(sampler.input, "SCALAR").values;
  if (track.times.front() < 0 ||
      std::adjacent_find(track.times.begin(), track.times.end(), std::greater_equal<>()) != track.times.end())
    throw std::invalid_argument("has at " + path + "/input times that are below 0 or do not ascend");
  GltfDocument::Numbers values = document.numbers(sampler.output, type);
  const std::size_t expected = track.times.size() * (sampler.interpolation == Interpolation::cubic ? 3 : 1);
  if (values.count != expected)
    throw std::invalid_argument("has at " + path + "/output " + std::to_string(values.count) +
                                " values; must have " + std::to_string(expected));
  track.interpolation = sampler.interpolation;
  return values;
}

void read_places(const GltfDocument& document, const Sampler& sampler, const std::string& path,
                 Track<Vec3>& track) {
  const GltfDocument::Numbers values = read_keys(document, sampler, path, "VEC3", track);
  track.values.clear();
  for (std::size_t i = 0; i < values.count; ++i) track.values.emplace_back(values.at(i));
}

void read_turns(const GltfDocument& document, const Sampler& sampler, const std::string& path,
                Track<Quaternion>& track) {
  const GltfDocument::Numbers values = read_keys(document, sampler, path, "VEC4", track);
  track.values.clear();
  for (std::size_t i = 0; i < values.count; ++i) {
    Eigen::Vector4d turn(values.at(i));
    const bool tangent = sampler.interpolation == Interpolation::cubic && i % 3 != 1;
    if (!tangent && !(turn.norm() > 1e-6))
      throw std::invalid_argument("has at " + path + "/output a rotation of length 0");
    if (!tangent) turn.normalize();
    track.values.emplace_back(turn);
  }
}

/// Whether the keys are anything but the node's own scale.
bool changes_scale(const GltfDocument& document, const Sampler& sampler, const std::string& path,
                   const Vec3& own) {
  Track<Vec3> track;
  read_places(document, sampler, path, track);
  const std::size_t step = sampler.interpolation == Interpolation::cubic ? 3 : 1;
  for (std::size_t i = step / 2; i < track.values.size(); i += step) {
    if (!((track.values[i] - own).cwiseAbs().array() <= kSameScale * own.array()).all()) return true;
  }
  return false;
}

void read_channel(const GltfDocument& document, const json& value, const std::string& path,
                  const json& samplers, const std::string& samplers_path, const Skeleton& skeleton,
                  Skeleton::Clip& clip) {
  std::uint64_t index = 0;
  std::optional<std::size_t> node;
  std::string target_path;
  GltfDocument::read_part(value, path, [&](Object& object) {
    object.require("sampler", "an index");
    object.integer("sampler", index, {0, static_cast<double>(samplers.size()) - 1});
    if (!object.require("target", "an object")) return;
    GltfDocument::read_part(*object.find("target"), object.path("target"), [&](Object& target) {
      if (target.has("node")) node = document.index(target, "node", "nodes");
      target.require("path", "a string");
      target.string("path", target_path, 64);
    });
  });
  if (!node) return;  // an extension's
  const std::string sampler_path = element_path(samplers_path, index);
  const auto sampler = [&] { return read_sampler(document, samplers[index], sampler_path); };
  Skeleton::Motion& motion = clip.nodes[*node];
  if (target_path == "translation") read_places(document, sampler(), sampler_path, motion.translation);
  if (target_path == "rotation") read_turns(document, sampler(), sampler_path, motion.rotation);
  if (target_path == "scale")
    motion.scales = changes_scale(document, sampler(), sampler_path, skeleton.nodes[*node].scale);
}

void set_times(Skeleton::Clip& clip) {
  double first = std::numeric_limits<double>::infinity(), last = -first;
  const auto take = [&](const std::vector<double>& times) {
    if (times.empty()) return;
    first = std::min(first, times.front());
    last = std::max(last, times.back());
  };
  for (const Skeleton::Motion& motion : clip.nodes) {
    take(motion.translation.times);
    take(motion.rotation.times);
  }
  clip.interval = kGltfInterval;
  if (last < first) return;
  clip.begin = first;
  clip.duration = last - first;
}

}  // namespace

GltfDocument open_gltf(const std::filesystem::path& folder, const std::string& file) {
  const std::string bytes = read_beside(folder, file, kMaxMotionBytes);
  return {bytes, [&](const std::string& uri) {
            const std::string name =
                (std::filesystem::path(file).parent_path() / percent_decoded(uri)).string();
            try {
              return read_beside(folder, name, kMaxGltfBytes);
            } catch (const std::invalid_argument& error) {
              throw std::invalid_argument("has a buffer in \"" + name + "\", which " + error.what());
            }
          }};
}

Skeleton read_gltf(const GltfDocument& document) {
  constexpr std::size_t kMostMotions = 1'000'000, kMostChannels = 100'000;
  Skeleton skeleton;
  read_nodes(document, skeleton);
  const std::size_t clips = document.count("animations");
  if (clips * skeleton.nodes.size() > kMostMotions)
    throw std::invalid_argument("has " + std::to_string(clips) + " animations of " +
                                std::to_string(skeleton.nodes.size()) + " nodes; at most " +
                                std::to_string(kMostMotions) + " motions of nodes are allowed");
  for (std::size_t i = 0; i < clips; ++i) {
    Skeleton::Clip& clip = skeleton.clips.emplace_back();
    document.read("animations", i, [&](Object& object) {
      object.string("name", clip.name, kMaxNodeName);
      clip.nodes.resize(skeleton.nodes.size());
      object.require("samplers", "an array");
      object.each("samplers", 1, kMostChannels, [](const json&, const std::string&) {});
      if (object.report().count() > 0) return;
      const json& samplers = *object.find("samplers");
      object.each("channels", 1, kMostChannels, [&](const json& value, const std::string& path) {
        read_channel(document, value, path, samplers, object.path("samplers"), skeleton, clip);
      });
    });
    set_times(clip);
  }
  return skeleton;
}

}  // namespace weft::scene
