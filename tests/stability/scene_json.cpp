#include "scene_json.h"

#include "cloth/shapes/triangle_mesh.h"

namespace weft::stability {
namespace {

using nlohmann::json;

json json_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

json json_of(const ClothDescription& cloth) {
  const Material& material = cloth.material;
  const Quaternion& turn = cloth.orientation;
  json made = {
      {"name", cloth.name},
      {"size", {cloth.size.x(), cloth.size.y()}},
      {"base_cells", {cloth.base_cells.cols, cloth.base_cells.rows}},
      {"velocity", json_of(cloth.velocity)},
      {"perturbation", cloth.perturbation},
      {"levels", {{"min", cloth.min_level}, {"max", cloth.max_level}, {"initial", cloth.initial_level}}},
      {"material",
       {{"density", material.density},
        {"structural", {material.structural.warp, material.structural.weft}},
        {"shear", material.shear},
        {"bending", material.bending},
        {"damping", material.damping},
        {"rigidity", {material.rigidity.u, material.rigidity.v, material.rigidity.twist}},
        {"limit",
         {{"warp", material.limit.warp},
          {"weft", material.limit.weft},
          {"shear", material.limit.shear},
          {"stiffening", material.limit.stiffening}}}}},
      {"discretization", cloth.discretization == Discretization::paper ? "paper" : "continuum"},
      {"pins", json::array()}};
  if (cloth.sewn) made["sewn"] = true;
  if (cloth.nodes.empty()) {
    made["position"] = json_of(cloth.position);
    made["orientation"] = {{"quaternion", {turn.w(), turn.x(), turn.y(), turn.z()}}};
  } else {
    for (const Vec3& node : cloth.nodes) made["nodes"].push_back(json_of(node));
  }
  for (const PinRegion& pin : cloth.pins) {
    json region = {{"u", {pin.u_min, pin.u_max}}, {"v", {pin.v_min, pin.v_max}}};
    for (const Waypoint& point : pin.path) {
      region["path"].push_back({{"time", point.time}, {"offset", json_of(point.position)}});
    }
    made["pins"].push_back(std::move(region));
  }
  return made;
}

json json_of(const BallDescription& ball) {
  json made = {{"type", "ball"}, {"radius", ball.radius}, {"friction", ball.friction}, {"mass", ball.mass}};
  made["motion"] = ball.motion == BallDescription::Motion::dynamic ? "dynamic" : "kinematic";
  for (const Waypoint& point : ball.path) {
    made["path"].push_back({{"time", point.time}, {"position", json_of(point.position)}});
  }
  if (ball.path.empty()) {
    made["position"] = json_of(ball.position);
    made["velocity"] = json_of(ball.velocity);
  }
  return made;
}

struct ShapeWriter {
  json operator()(const PlaneDescription& s) const { return {{"normal", json_of(s.normal)}}; }
  json operator()(const BoxDescription& s) const {
    const Quaternion& turn = s.orientation;
    return {{"size", json_of(s.size)},
            {"orientation", {{"quaternion", {turn.w(), turn.x(), turn.y(), turn.z()}}}}};
  }
  json operator()(const CapsuleDescription& s) const {
    const Quaternion& turn = s.orientation;
    return {{"radius", s.radius},
            {"length", s.length},
            {"orientation", {{"quaternion", {turn.w(), turn.x(), turn.y(), turn.z()}}}}};
  }
  json operator()(const MeshDescription& s) const {
    const Quaternion& turn = s.orientation;
    json made = {{"triangles", s.surface->list().triangles},
                 {"orientation", {{"quaternion", {turn.w(), turn.x(), turn.y(), turn.z()}}}}};
    for (const Vec3& vertex : s.surface->list().vertices) made["vertices"].push_back(json_of(vertex));
    return made;
  }
};

struct EffectWriter {
  json operator()(const GravityEffect& e) const { return {{"acceleration", json_of(e.acceleration)}}; }
  json operator()(const DampingEffect&) const { return json::object(); }
  json operator()(const PaperWindEffect& e) const {
    return {{"factor", e.factor}, {"along_normal", e.along_normal}};
  }
  json operator()(const AerodynamicsEffect& e) const {
    return {{"air_density", e.air_density}, {"drag", e.drag}, {"lift", e.lift_or_drag()}};
  }
  json operator()(const StrainDampingEffect& e) const { return {{"time", e.time}}; }
  json operator()(const PlateBendingEffect&) const { return json::object(); }
  json operator()(const StrainLimitEffect&) const { return json::object(); }
  json operator()(const ClothContactEffect& e) const {
    return {{"thickness", e.thickness}, {"friction", e.friction}};
  }
  json operator()(const TearingEffect& e) const { return {{"strength", {e.warp, e.weft}}}; }
  json operator()(const InflationEffect& e) const {
    json made = {{"pressure", e.pressure}};
    if (e.volume) made.update({{"volume", *e.volume}, {"fill_time", e.fill_time}});
    return made;
  }
};

struct IntegratorWriter {
  json operator()(const SymplecticEulerDescription& i) const {
    json made = {{"safety", i.safety}};
    if (i.substeps > 0) made["substeps"] = i.substeps;
    return made;
  }
  json operator()(const ImplicitParameters& i) const {
    return {{"substeps", i.substeps},
            {"tolerance", i.tolerance},
            {"newton_iterations", i.newton_iterations},
            {"linear_iterations", i.linear_iterations},
            {"liveliness", i.liveliness}};
  }
  json operator()(const XpbdDescription& i) const {
    if (i.substeps > 0) return {{"substeps", i.substeps}};
    return {{"longest_substep", i.longest_substep}};
  }
};

/// A variant's value with its name as "type".
template <class Writer, class Variant>
json typed(const Variant& variant) {
  json made = std::visit(Writer{}, variant);
  made["type"] = std::visit([](const auto& value) { return value.kName; }, variant);
  return made;
}

struct ZoneWriter {
  json operator()(const BoxZone& z) const {
    const Quaternion& turn = z.orientation;
    return {{"size", json_of(z.size)},
            {"orientation", {{"quaternion", {turn.w(), turn.x(), turn.y(), turn.z()}}}}};
  }
  json operator()(const SphereZone& z) const { return {{"radius", z.radius}}; }
};

json json_of(const WindZone& zone) {
  json made = typed<ZoneWriter>(zone.shape);
  made.update(
      {{"position", json_of(zone.position)}, {"velocity", json_of(zone.velocity)}, {"edge", zone.edge}});
  return made;
}

bool reads_wind(const EffectDescription& effect) {
  return std::holds_alternative<PaperWindEffect>(effect) ||
         std::holds_alternative<AerodynamicsEffect>(effect);
}

}  // namespace

json scene_json(const SimulationDescription& scene) {
  json made = {{"cloths", json::array()},
               {"effects", json::array()},
               {"integrator", typed<IntegratorWriter>(scene.integrator)},
               {"time_step", scene.time_step},
               {"sleep_speed", scene.sleep_speed},
               {"seed", scene.seed}};
  for (const ClothDescription& cloth : scene.cloths) made["cloths"].push_back(json_of(cloth));
  for (const BallDescription& ball : scene.balls) made["colliders"].push_back(json_of(ball));
  for (const ObstacleDescription& each : scene.obstacles) {
    json obstacle = typed<ShapeWriter>(each.shape);
    obstacle["friction"] = each.friction;
    if (each.path.empty()) obstacle["position"] = json_of(each.position);
    for (const PoseWaypoint& point : each.path) {
      const Quaternion& turn = point.pose.orientation;
      obstacle["path"].push_back(
          {{"time", point.time},
           {"position", json_of(point.pose.position)},
           {"orientation", {{"quaternion", {turn.w(), turn.x(), turn.y(), turn.z()}}}}});
    }
    if (each.body) {
      obstacle["mass"] = each.body->mass;
      if (each.body->dynamic) {
        obstacle["motion"] = "dynamic";
        obstacle["velocity"] = json_of(each.body->velocity);
        obstacle["spin"] = json_of(each.body->spin);
      }
    }
    made["colliders"].push_back(std::move(obstacle));
  }
  for (const EffectDescription& effect : scene.effects) {
    made["effects"].push_back(typed<EffectWriter>(effect));
    if (reads_wind(effect)) {
      const Wind& wind = scene.wind;
      made["wind"] = {
          {"direction", json_of(wind.direction)},
          {"speed", wind.speed},
          {"gusts", {{"intensity", wind.gusts.intensity}, {"time_scale", wind.gusts.time_scale}}},
          {"turbulence",
           {{"intensity", wind.turbulence.intensity}, {"length_scale", wind.turbulence.length_scale}}}};
      for (const WindZone& zone : wind.zones) made["wind"]["zones"].push_back(json_of(zone));
    }
  }
  return made;
}

}  // namespace weft::stability
