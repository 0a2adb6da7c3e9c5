#include <algorithm>
#include <numbers>

#include "scene/material_parameters.h"
#include "scene/readers.h"

namespace weft::scene {
namespace {

using nlohmann::json;

/// The fabric that `value` names; nullptr and a problem otherwise.
const Fabric* read_fabric(const json& value, const std::string& path, Report& report) {
  const Fabric* fabric = value.is_string() ? find_fabric(value.get_ref<const std::string&>()) : nullptr;
  if (!fabric) {
    std::vector<std::string_view> names;
    for (const Fabric& each : fabrics()) names.push_back(each.name);
    report.refuse_name(value, path, "a fabric, one of " + quoted_list(names), names);
  }
  return fabric;
}

/// One number for both, or [warp, weft].
void read_structural(Object& material, Stiffness& structural) {
  const json* value = material.find("structural");
  Vec2 read(structural.warp, structural.weft);
  if (value && value->is_array()) {
    material.vector("structural", read, kStiffness);
  } else if (double both = 0; material.number("structural", both, kStiffness)) {
    read.setConstant(both);
  }
  structural = {read[0], read[1]};
}

/// One number for all three, or [u, v, twist].
void read_rigidity(Object& material, Rigidity& rigidity) {
  const json* value = material.find("rigidity");
  Vec3 read(rigidity.u, rigidity.v, rigidity.twist);
  if (value && value->is_array()) {
    material.vector("rigidity", read, kRigidity);
  } else if (double all = 0; material.number("rigidity", all, kRigidity)) {
    read.setConstant(all);
  }
  rigidity = {read[0], read[1], read[2]};
}

void read_limit(const json& value, const std::string& path, Report& report, StrainLimit& limit) {
  Object object(value, path, report);
  object.number("warp", limit.warp, kElongation);
  object.number("weft", limit.weft, kElongation);
  object.number("shear", limit.shear, kLockingAngle);
  object.number("stiffening", limit.stiffening, kStiffening);
}

/// A fabric's name, or raw values; with "fabric" they change that fabric's.
Material read_material(const json& value, const std::string& path, Report& report) {
  constexpr Range kDensity{1e-4, 1e4, "kg/m2"};
  Material material;
  if (value.is_string()) {
    if (const Fabric* fabric = read_fabric(value, path, report)) material = fabric->material;
    return material;
  }
  Object object(value, path, report);
  if (const json* name = object.find("fabric")) {
    if (const Fabric* fabric = read_fabric(*name, object.path("fabric"), report)) material = fabric->material;
  }
  object.number("density", material.density, kDensity);
  read_structural(object, material.structural);
  object.number("shear", material.shear, kStiffness);
  object.number("bending", material.bending, kStiffness);
  object.number("damping", material.damping, kDamping);
  read_rigidity(object, material.rigidity);
  if (const json* limit = object.find("limit"))
    read_limit(*limit, object.path("limit"), report, material.limit);
  return material;
}

}  // namespace

Quaternion read_orientation(const json& value, const std::string& path, Report& report) {
  constexpr Range kDegrees{-360, 360, "degrees"};
  Object object(value, path, report);
  if (object.has("quaternion")) {
    if (object.has("axis") || object.has("degrees")) {
      report.add(path, "has both quaternion and axis, degrees; must have one of the two");
    }
    Eigen::Vector4d quaternion{1, 0, 0, 0};
    object.direction("quaternion", quaternion, kComponent);
    return {quaternion[0], quaternion[1], quaternion[2], quaternion[3]};
  }
  Vec3 axis = Vec3::UnitY();
  double degrees = 0;
  object.require("axis", "an array of 3 numbers");
  object.direction("axis", axis, kComponent);
  object.require("degrees", kDegrees);
  object.number("degrees", degrees, kDegrees);
  return Quaternion(Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, axis));
}

namespace {

/// One side of a pin's region: a number, or [from, to].
void read_span(Object& pin, const char* key, double& min, double& max) {
  constexpr Range kShare{0, 1};
  const json* value = pin.find(key);
  if (value && value->is_array()) {
    Vec2 span{0, 0};
    if (!pin.vector(key, span, kShare)) return;
    if (span[0] > span[1]) pin.problem(key, "goes from a larger to a smaller number; must ascend");
    min = span[0];
    max = span[1];
  } else if (pin.require(key, "a number from 0 to 1 or an array of two") && pin.number(key, min, kShare)) {
    max = min;
  }
}

/// What a region goes with: at most one of path, obstacle and motion.
void read_way(Object& object, MotionFiles& motions, PinRegion& region) {
  const bool has_path = object.has("path");
  WaypointPath way = read_path(object, "offset");
  region.path = std::move(way.points);
  region.loop = way.loop;
  int obstacle = 0;
  if (object.integer("obstacle", obstacle, {0, double(kMaxColliders - 1)})) {
    region.obstacle = obstacle;
    if (has_path) object.problem("obstacle", "is given beside path; what it is fixed to says where it goes");
  }
  int ball = 0;
  if (object.integer("ball", ball, {0, double(kMaxColliders - 1)})) {
    region.ball = ball;
    for (const char* key : {"path", "obstacle"}) {
      if (object.has(key)) object.problem(key, "is given beside ball, which says where it goes");
    }
  }
  const json* motion = object.find("motion");
  if (motion == nullptr) return;
  for (const char* key : {"path", "loop", "obstacle", "ball"}) {
    if (object.has(key)) object.problem(key, "is given beside motion, which says where it goes");
  }
  PosePath node = read_motion(*motion, object.path("motion"), object.report(), motions);
  region.motion = std::move(node.points);
  region.loop = node.loop;
}

/// A corner's or an edge's name, or {"u", "v", "path"}.
PinRegion read_pin(const json& value, const std::string& path, Report& report, MotionFiles& motions) {
  struct Named {
    const char* name;
    PinRegion region;
  };
  static const Named named[] = {
      {"top_left", {0, 0, 0, 0}},     {"top_right", {1, 1, 0, 0}}, {"bottom_left", {0, 0, 1, 1}},
      {"bottom_right", {1, 1, 1, 1}}, {"top", {0, 1, 0, 0}},       {"bottom", {0, 1, 1, 1}},
      {"left", {0, 0, 0, 1}},         {"right", {1, 1, 0, 1}},
  };
  PinRegion region;
  if (value.is_object()) {
    Object object(value, path, report);
    read_span(object, "u", region.u_min, region.u_max);
    read_span(object, "v", region.v_min, region.v_max);
    read_way(object, motions, region);
    constexpr Range kTime{0, 1e6, "s"}, kPinStiffness{1e-3, 1e6, "N/m"};
    object.number("from", region.from, kTime);
    if (object.number("until", region.until, kTime) && region.until <= region.from)
      object.report().refuse(value["until"], object.path("until"),
                             "later than from, " + json(region.from).dump() + " s");
    double stiffness = 0;
    if (object.number("stiffness", stiffness, kPinStiffness)) region.stiffness = stiffness;
    return region;
  }
  std::vector<std::string_view> names;
  for (const Named& each : named) {
    if (value == each.name) return each.region;
    names.emplace_back(each.name);
  }
  report.refuse_name(value, path, "one of " + quoted_list(names) + " or an object with u and v", names);
  return region;
}

void read_levels(const json& value, const std::string& path, Report& report, ClothDescription& cloth) {
  Object object(value, path, report);
  const bool min = object.integer("min", cloth.min_level, kLevel);
  const bool max = object.integer("max", cloth.max_level, kLevel);
  if (!min) cloth.min_level = std::min(cloth.min_level, cloth.max_level);
  if (!max) cloth.max_level = std::max(cloth.min_level, cloth.max_level);
  if (cloth.min_level > cloth.max_level) {
    report.add(path, "min is " + std::to_string(cloth.min_level) + "; must be at most max, " +
                         std::to_string(cloth.max_level));
    return;
  }
  cloth.initial_level = cloth.max_level;
  object.integer("initial", cloth.initial_level, {double(cloth.min_level), double(cloth.max_level)});
}

int nodes_at(const ClothDescription& cloth, int level) {
  return ((cloth.base_cells.cols << level) + 1) * ((cloth.base_cells.rows << level) + 1);
}

/// The start positions, for a cloth whose cells and levels have been read.
void read_nodes(Object& object, const SceneFolder& folder, ClothDescription& cloth) {
  for (const char* key : {"position", "orientation"}) {
    if (object.has(key)) object.problem(key, "is given beside nodes; nodes are where the cloth starts");
  }
  const json& value = *object.find("nodes");
  if (value.is_object()) {
    cloth.nodes = read_start(value, object.path("nodes"), object.report(), folder, cloth);
    return;
  }
  const auto expected = static_cast<std::size_t>(nodes_at(cloth, cloth.initial_level));
  if (!value.is_array() || value.size() != expected) {
    object.report().refuse(value, object.path("nodes"),
                           "an array of " + std::to_string(expected) + ": the nodes at level " +
                               std::to_string(cloth.initial_level) + ", row by row");
    return;
  }
  object.each("nodes", expected, expected, [&](const json& node, const std::string& path) {
    Vec3 position{0, 0, 0};
    read_numbers(node, path, kPosition, position.data(), 3, object.report());
    cloth.nodes.push_back(position);
  });
}

void read_relevance(const json& value, const std::string& path, Report& report, Relevance& relevance) {
  constexpr Range kFar{1e-3, 1e6, "m"};
  Object object(value, path, report);
  object.require("unseen", "\"step\", \"coarse\" or \"sleep\"");
  switch (object.choice("unseen", {"step", "coarse", "sleep"})) {
    case 1:
      relevance.unseen = Relevance::Unseen::coarse;
      break;
    case 2:
      relevance.unseen = Relevance::Unseen::sleep;
      break;
    default:
      break;
  }
  object.number("far", relevance.far, kFar);
}

bool is_name(const std::string& text) {
  return !text.empty() &&
         text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-_") == std::string::npos;
}

}  // namespace

ClothDescription read_cloth(const json& value, const std::string& path, Report& report,
                            const SceneFolder& folder, MotionFiles& motions, Look& look) {
  constexpr Range kBaseCells{1, 32};
  constexpr Range kPerturbation{0, 100, "m"};
  ClothDescription cloth;
  Object object(value, path, report);
  if (object.string("name", cloth.name, 64) && !is_name(cloth.name)) {  // it becomes part of file names
    report.refuse(*object.find("name"), object.path("name"), "1 to 64 of a-z, 0-9, - and _");
  }
  object.vector("size", cloth.size, kLength);
  if (const json* cells = object.find("base_cells")) {
    const std::string at = object.path("base_cells");
    double counts[2] = {1, 1};
    const bool integers = cells->is_array() && cells->size() == 2 && (*cells)[0].is_number_integer() &&
                          (*cells)[1].is_number_integer();
    if (!integers) {
      report.refuse(*cells, at, "an array of 2 integers, each " + kBaseCells.text());
    } else if (read_numbers(*cells, at, kBaseCells, counts, 2, report)) {
      cloth.base_cells = {static_cast<int>(counts[0]), static_cast<int>(counts[1])};
    }
  }
  if (const json* levels = object.find("levels")) read_levels(*levels, object.path("levels"), report, cloth);
  const int nodes = nodes_at(cloth, cloth.max_level);
  if (nodes > kMaxClothNodes) {
    report.add(path, "has " + std::to_string(nodes) + " nodes at level " + std::to_string(cloth.max_level) +
                         "; at most " + std::to_string(kMaxClothNodes) + " are allowed");
  }
  object.boolean("sewn", cloth.sewn);
  if (object.has("nodes") && nodes <= kMaxClothNodes) {
    if (cloth.sewn) object.problem("nodes", "is given beside sewn; a bag begins flat");
    read_nodes(object, folder, cloth);
  }
  object.vector("position", cloth.position, kPosition);
  if (const json* orientation = object.find("orientation")) {
    cloth.orientation = read_orientation(*orientation, object.path("orientation"), report);
  }
  object.vector("velocity", cloth.velocity, kVelocity);
  object.number("perturbation", cloth.perturbation, kPerturbation);
  const json* material = object.find("material");
  if (material) cloth.material = read_material(*material, object.path("material"), report);
  look = read_look(object.find("look"), object.path("look"), report, material);
  if (object.choice("discretization", {"paper", "continuum"}) == 0)
    cloth.discretization = Discretization::paper;
  object.each("pins", 0, kMaxPins, [&](const json& pin, const std::string& at) {
    cloth.pins.push_back(read_pin(pin, at, report, motions));
  });
  if (const json* relevance = object.find("relevance"))
    read_relevance(*relevance, object.path("relevance"), report, cloth.relevance);
  return cloth;
}

}  // namespace weft::scene
