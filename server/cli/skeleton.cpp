#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_codes.h"
#include "scene/motion/bone_fit.h"
#include "scene/motion/gltf_file.h"
#include "scene/motion/motion_files.h"
#include "scene/motion/node_path.h"

namespace weft::cli {
namespace {

using json = nlohmann::ordered_json;  // as people would write a collider
namespace fs = std::filesystem;

struct SkeletonOptions {
  std::string file;
  std::string animation;
  std::optional<double> scale, height;
  double friction = 0.4, start = 0;
  bool loop = false;
  std::vector<std::string> radii;  ///< NODE=M
  scene::BoneFitRule rule;
};

/// The file, or the built-in motion, that the command line names.
struct OpenedSkeleton {
  scene::Skeleton skeleton;
  scene::Skin skin;
  json source;  ///< as "motion" names it
};

OpenedSkeleton open_skeleton(const std::string& file) {
  OpenedSkeleton opened;
  const auto& builtin = scene::builtin_motions();
  if (std::any_of(builtin.begin(), builtin.end(), [&](const auto& motion) { return motion.name == file; })) {
    opened.skeleton = scene::read_builtin_motion(file);
    opened.source["builtin"] = file;
    return opened;
  }
  const fs::path path(file), folder = path.parent_path();
  const std::string name = path.filename().string();
  try {
    if (path.extension() == ".gltf" || path.extension() == ".glb") {
      const scene::GltfDocument document = scene::open_gltf(folder, name);
      opened.skeleton = scene::read_gltf(document);
      opened.skin = scene::read_skin(document);
    } else {
      opened.skeleton = scene::read_motion_file(folder, name);
    }
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(file + ": " + error.what());
  }
  opened.source["file"] = name;
  return opened;
}

const scene::Skeleton::Clip* clip_of(const SkeletonOptions& options, const scene::Skeleton& skeleton) {
  if (skeleton.clips.empty() && options.animation.empty()) return nullptr;
  return &scene::find_clip(skeleton, options.animation);
}

int list(const SkeletonOptions& options) {
  const OpenedSkeleton opened = open_skeleton(options.file);
  const scene::Skeleton& skeleton = opened.skeleton;
  for (const scene::Skeleton::Clip& clip : skeleton.clips) {
    std::printf("animation \"%s\": %g s, sampled every %g s\n", clip.name.c_str(), clip.duration,
                clip.interval);
  }
  std::printf("height: %g\n", scene::height_of(skeleton, clip_of(options, skeleton)));
  for (std::size_t i = 0; i < skeleton.nodes.size(); ++i) {
    const scene::Skeleton::Node& node = skeleton.nodes[i];
    const int parent = node.parent;
    std::printf("%s%s%s", node.name.c_str(), parent >= 0 ? " on " : "",
                parent >= 0 ? skeleton.nodes[static_cast<std::size_t>(parent)].name.c_str() : "");
    const auto skin = opened.skin.find(i);
    if (skin != opened.skin.end()) std::printf(", %zu vertices", skin->second.size());
    std::printf("\n");
  }
  return 0;
}

/// Short enough to read: a tenth of a millimetre.
double rounded(double value) { return std::round(value * 1e4) / 1e4 + 0.0; }  // no -0

double of_six_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return std::stod(text);
}

json rounded(const Vec3& vector) { return {rounded(vector.x()), rounded(vector.y()), rounded(vector.z())}; }

json collider_of(const scene::BoneCapsule& capsule, const json& motion) {
  const Quaternion& turn = capsule.orientation;
  json collider;
  collider["type"] = "capsule";
  collider["radius"] = rounded(capsule.radius);
  collider["length"] = rounded(capsule.length);
  collider["position"] = rounded(capsule.position);
  collider["orientation"]["quaternion"] = {rounded(turn.w()), rounded(turn.x()), rounded(turn.y()),
                                           rounded(turn.z())};
  collider["motion"] = motion;
  return collider;
}

void read_radii(SkeletonOptions& options) {
  for (const std::string& text : options.radii) {
    const std::size_t equals = text.rfind('=');
    double radius = 0;
    if (equals == text.npos || !CLI::detail::lexical_cast(text.substr(equals + 1), radius) ||
        !(radius >= 1e-4 && radius <= 1e4))
      throw CLI::ValidationError("--radius", text + ": must be NODE=M, M from 0.0001 to 10000 m");
    options.rule.radii[text.substr(0, equals)] = radius;
  }
}

int fit(SkeletonOptions options) {
  read_radii(options);
  const OpenedSkeleton opened = open_skeleton(options.file);
  const scene::Skeleton& skeleton = opened.skeleton;
  json motion = opened.source;
  motion["node"] = "";  // each capsule's own
  std::vector<scene::BoneCapsule> capsules;
  try {
    const scene::Skeleton::Clip* clip = clip_of(options, skeleton);
    if (clip == nullptr) throw std::invalid_argument("has no animation for colliders to go with");
    double scale = options.scale.value_or(1);
    if (options.height) {
      const double height = scene::height_of(skeleton, clip);
      if (!(height > 0)) throw std::invalid_argument("has no height for --height to scale");
      scale = of_six_digits(*options.height / height);
    }
    if (!options.animation.empty()) motion["animation"] = options.animation;
    if (scale != 1) motion["scale"] = scale;
    if (options.start > 0) motion["start"] = options.start;
    if (options.loop) motion["loop"] = true;
    capsules = scene::fit_capsules(skeleton, clip, opened.skin, scale, options.rule);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(options.file + ": " + error.what());
  }
  // A collider a line, so that people can take one out.
  std::printf("{\n  \"colliders\": [");
  const char* separator = "\n";
  for (const scene::BoneCapsule& capsule : capsules) {
    motion["node"] = skeleton.nodes[capsule.node].name;
    json collider = collider_of(capsule, motion);
    collider["friction"] = rounded(options.friction);
    std::printf("%s    %s", separator, collider.dump().c_str());
    separator = ",\n";
  }
  std::printf("\n  ]\n}\n");
  return 0;
}

}  // namespace

void add_skeleton(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SkeletonOptions>();
  CLI::App* command =
      app.add_subcommand("skeleton", "Makes colliders of a skeleton in a .bvh, .gltf or .glb file");
  command->require_subcommand(1);
  const auto add = [&](const char* name, const char* what) {
    CLI::App* sub = command->add_subcommand(name, what);
    sub->add_option("FILE", options->file, "A .bvh, .gltf or .glb file, or a built-in motion: walk")
        ->required();
    sub->add_option("--animation", options->animation, "Its animation of that name; default: the first one");
    return sub;
  };
  add("list", "Lists animations and nodes")->callback([=, &exit_code] { exit_code = list(*options); });

  CLI::App* fitting =
      add("fit",
          "Writes the part of a scene that has a capsule for each bone, which goes with it. The "
          "scene must be in the file's folder");
  auto* scale =
      fitting->add_option("--scale", options->scale, "Metres of one of the file's lengths; default 1")
          ->check(CLI::Range(1e-6, 1e6));
  fitting->add_option("--height", options->height, "Makes the figure so high when it begins, m")
      ->check(CLI::Range(1e-3, 1e4))
      ->excludes(scale);
  fitting->add_option("--start", options->start, "When the scene begins the animation, s")
      ->check(CLI::Range(0.0, 1e6));
  fitting->add_flag("--loop", options->loop, "The animation begins anew when it ends");
  fitting->add_option("--friction", options->friction, "Of the capsules")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  scene::BoneFitRule& rule = options->rule;
  fitting->add_option("--radius", options->radii, "NODE=M gives that joint's bones this radius, m")
      ->allow_extra_args(false);
  fitting->add_option("--share", rule.share, "Radius of a bone without a skin, of its length")
      ->check(CLI::Range(0.001, 10.0))
      ->capture_default_str();
  fitting->add_option("--thinnest", rule.thinnest, "Least such radius, of the figure's height")
      ->check(CLI::Range(0.0001, 1.0))
      ->capture_default_str();
  fitting->add_option("--thickest", rule.thickest, "Largest such radius, of the figure's height")
      ->check(CLI::Range(0.0001, 1.0))
      ->capture_default_str();
  fitting->add_option("--shortest", rule.shortest, "Bones shorter than this get none, of the figure's height")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  fitting->add_option("--quantile", rule.quantile, "Of a bone's vertices this share is within the radius")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  fitting->callback([=, &exit_code] {
    if (options->rule.thinnest > options->rule.thickest)
      throw CLI::ValidationError("--thinnest", "must be at most --thickest");
    exit_code = fit(*options);
  });
}

}  // namespace weft::cli
