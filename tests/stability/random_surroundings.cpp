#include "random_surroundings.h"

#include <algorithm>
#include <memory>

#include "cloth/shapes/triangle_mesh.h"

namespace weft::stability {
namespace {

Quaternion draw_turn(Draw& draw) {
  const double angle = draw.between(0, 3.1);
  return Quaternion(Eigen::AngleAxisd(angle, draw.direction()));
}

/// An octahedron pulled along its axes: corners from blunt to needle sharp.
MeshDescription draw_mesh(Draw& draw, double size) {
  TriangleList list;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {1, -1})
      list.vertices.push_back(side * size * draw.between(0.2, 1) * Vec3::Unit(axis));
  }
  list.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return {.surface = std::make_shared<const TriangleMesh>(list), .orientation = draw_turn(draw)};
}

ObstacleDescription draw_obstacle(Draw& draw, const ClothDescription& cloth) {
  const double reach = cloth.size.maxCoeff(), size = reach * draw.decades(0.05, 0.5);
  ObstacleDescription obstacle;
  obstacle.friction = draw.chance(0.3) ? 0 : draw.between(0, 2);
  const int kind = draw.integer(0, 3);
  if (kind == 0) {  // below the whole cloth
    obstacle.shape = PlaneDescription{draw.direction()};
    obstacle.position = cloth.position - 1.1 * reach * std::get<PlaneDescription>(obstacle.shape).normal;
    return obstacle;
  }
  if (kind == 1) {
    const double x = draw.between(0.1, 1), y = draw.between(0.1, 1), z = draw.between(0.1, 1);
    obstacle.shape = BoxDescription{size * Vec3(x, y, z), draw_turn(draw)};
  } else if (kind == 2) {
    const double radius = size * draw.between(0.05, 0.5);
    obstacle.shape = CapsuleDescription{radius, size, draw_turn(draw)};
  } else {
    obstacle.shape = draw_mesh(draw, size);
  }
  obstacle.position = cloth.position + draw.in_box(reach);
  if (draw.chance(0.5)) {
    for (const double time : {0.2, 0.8, 1.4}) {
      const Vec3 position = cloth.position + draw.in_box(reach);
      obstacle.path.push_back({time, {position, draw_turn(draw)}});
    }
  }
  return obstacle;
}

/// Most of what has no path and its centre of mass at its origin.
void make_body(Draw& draw, ObstacleDescription& obstacle) {
  const bool central = std::holds_alternative<BoxDescription>(obstacle.shape) ||
                       std::holds_alternative<CapsuleDescription>(obstacle.shape);
  if (!central || !obstacle.path.empty() || draw.chance(0.2)) return;
  BodyDescription body;
  body.mass = draw.decades(0.01, 100);
  body.velocity = draw.in_box(draw.decades(0.1, 50));
  body.spin = draw.in_box(draw.decades(0.1, 50));
  obstacle.body = body;
}

void add_layers(Draw& draw, SimulationDescription& scene) {
  const double size = scene.cloths[0].size.minCoeff();
  const double thickness = std::clamp(size * draw.decades(1e-3, 0.03), 1e-4, 1.0);
  scene.effects.emplace_back(ClothContactEffect{thickness, draw.between(0, 1)});
}

/// Its own draw for each purpose, so that a scene shrunk is treated as the whole one was.
Draw draw_for(const SimulationDescription& scene, std::uint64_t purpose) {
  return Draw(scene.seed + (purpose << 32));
}

/// Most of them with gas, up to more than they hold unstretched: a bag of two squares of side a about a^3
/// / 5.
void sew(Draw& draw, SimulationDescription& scene) {
  ClothDescription& cloth = scene.cloths[0];
  cloth.sewn = true;
  if (draw.chance(0.3)) return;
  InflationEffect gas{draw.between(-1e3, 1e4), std::pow(cloth.size.prod() / 2, 1.5) * draw.decades(0.01, 0.3),
                      draw.chance(0.5) ? 0 : draw.between(0, 2)};
  for (EffectDescription& effect : scene.effects) {
    if (!std::holds_alternative<InflationEffect>(effect)) continue;
    effect = gas;
    return;
  }
  scene.effects.emplace_back(gas);
}

}  // namespace

void add_surroundings(Draw& draw, SimulationDescription& scene) {
  ClothDescription& cloth = scene.cloths[0];
  Material& material = cloth.material;
  for (int obstacles = draw.integer(0, 2); obstacles > 0; --obstacles)
    scene.obstacles.push_back(draw_obstacle(draw, cloth));
  if (draw.chance(0.5)) scene.wind.gusts = {draw.between(0, 0.5), draw.decades(0.05, 10)};
  if (draw.chance(0.5)) scene.wind.turbulence = {draw.between(0, 0.5), draw.decades(0.05, 10)};
  const auto add = [&](const EffectDescription& effect) { scene.effects.push_back(effect); };
  if (draw.chance(0.3)) add(StrainDampingEffect{draw.decades(1e-5, 1e-2)});
  if (draw.chance(0.3)) {
    const double u = draw.decades(1e-7, 1e-2);
    material.rigidity = {u, u * draw.decades(0.1, 10), u * draw.decades(0.1, 1)};
    add(PlateBendingEffect{});
  }
  if (draw.chance(0.3)) {
    const double warp = draw.decades(0.01, 0.3), weft = draw.decades(0.01, 0.3);
    material.limit = {warp, weft, draw.between(0.05, 1), draw.decades(1, 50)};
    add(StrainLimitEffect{});
  }
  const bool layers = draw.chance(0.5);
  if (layers) add_layers(draw, scene);
  if (draw.chance(0.3)) {
    const double pressure = material.density * draw.decades(1, 100);  // up to ten times the weight
    add(InflationEffect{draw.chance(0.5) ? pressure : -pressure});
  }
  if (!layers && draw.chance(0.5)) {
    const double warp = draw.decades(1, 1e5);
    add(TearingEffect{warp, warp * draw.decades(0.1, 10)});
  } else if (!layers && cloth.nodes.empty()) {
    sew(draw, scene);
  }
  for (ObstacleDescription& obstacle : scene.obstacles) make_body(draw, obstacle);
}

void add_company(Draw& draw, const ClothDescription& other, SimulationDescription& scene) {
  const ClothDescription cloth = scene.cloths[0];  // a copy: another one is added below
  const double reach = cloth.size.maxCoeff();
  if (draw.chance(0.3)) {
    for (int zones = draw.integer(1, 3); zones > 0; --zones) {
      WindZone zone;
      const double size = reach * draw.decades(0.05, 2);
      zone.shape = SphereZone{size};
      if (draw.chance(0.5)) {
        const double x = draw.between(0.1, 1), y = draw.between(0.1, 1), z = draw.between(0.1, 1);
        zone.shape = BoxZone{size * Vec3(x, y, z), draw_turn(draw)};
      }
      zone.position = cloth.position + draw.in_box(reach);
      zone.velocity = draw.in_box(draw.decades(0.1, 50));
      zone.edge = std::max(1e-3, size * draw.decades(1e-3, 1));
      scene.wind.zones.push_back(zone);
    }
  }
  if (!draw.chance(0.3)) return;
  scene.cloths.push_back(other);
  scene.cloths[1].name = "other";
  scene.cloths[1].position = cloth.position + draw.in_box(reach / 2);
  // Methods of many substeps find contact in each of them, which takes minutes a scene.
  const bool is_implicit = std::holds_alternative<BackwardEulerDescription>(scene.integrator) ||
                           std::holds_alternative<Bdf2Description>(scene.integrator);
  const bool may_touch = is_implicit && !cloth.sewn &&
                         std::none_of(scene.effects.begin(), scene.effects.end(), [](const auto& effect) {
                           return std::holds_alternative<TearingEffect>(effect) ||
                                  std::holds_alternative<ClothContactEffect>(effect);
                         });
  if (may_touch && draw.chance(0.5)) add_layers(draw, scene);
}

std::optional<Hand> hand_of(const SimulationDescription& scene) {
  if ((scene.seed & 4) == 0) return {};
  Draw draw = draw_for(scene, 1);
  const ClothDescription& cloth = scene.cloths[0];
  Hand hand;
  hand.at.x() = draw.between(0, 1);
  hand.at.y() = draw.between(0, 1);
  hand.way = draw.in_box(2 * cloth.size.maxCoeff());
  hand.force = cloth.material.density * cloth.size.prod() * draw.decades(1, 1000);
  return hand;
}

std::optional<std::vector<EffectDescription>> kept_effects(const SimulationDescription& scene) {
  if ((scene.seed & 2) == 0) return {};
  Draw draw = draw_for(scene, 2);
  std::vector<EffectDescription> kept = scene.effects;
  std::erase_if(kept, [&](const EffectDescription&) { return draw.chance(0.5); });
  return kept;
}

}  // namespace weft::stability
