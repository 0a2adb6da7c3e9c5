#pragma once
/// Scenes in which cloth meets cloth.
#include <cmath>
#include <numbers>

#include "cloth/world/simulation.h"

namespace weft::test {

inline PoseWaypoint turned(double time, const Vec3& position, double turns) {
  return {time, {position, Quaternion(Eigen::AngleAxisd(2 * std::numbers::pi * turns, Vec3::UnitY()))}};
}

inline SimulationDescription cloth_scene(const Vec2& size, int level, const IntegratorDescription& stepping) {
  SimulationDescription scene;
  scene.integrator = stepping;
  scene.effects = {GravityEffect{}, ClothContactEffect{}};
  scene.sleep_speed = 0;
  ClothDescription cloth;
  cloth.size = size;
  cloth.min_level = cloth.max_level = cloth.initial_level = level;
  scene.cloths = {cloth};
  return scene;
}

inline ObstacleDescription floor_at(double height) {
  ObstacleDescription plane{PlaneDescription{}, {0, height, 0}};
  plane.friction = 0.5;
  return plane;
}

/// A square of 1 m that stands on its edge and falls in a heap.
inline SimulationDescription dropped_on_edge(int level, const IntegratorDescription& stepping) {
  SimulationDescription scene = cloth_scene({1, 1}, level, stepping);
  scene.cloths[0].position = {0, 0.55, 0};
  scene.cloths[0].perturbation = 0.002;
  scene.obstacles = {floor_at(0)};
  return scene;
}

/// A strip held above and below, wrung by four turns in 2 s while its ends approach.
inline SimulationDescription wrung(int level, const IntegratorDescription& stepping) {
  SimulationDescription scene = cloth_scene({0.3, 1}, level, stepping);
  ObstacleDescription hand{BoxDescription{{0.01, 0.01, 0.01}}, {0, -2, 0}};
  for (int quarter = 0; quarter <= 16; ++quarter) {
    hand.path.push_back(turned(0.125 * quarter, {0, -2 + 0.5 * quarter / 16, 0}, quarter / 4.0));
  }
  scene.obstacles = {hand};
  scene.cloths[0].pins = {PinRegion{0, 1, 0, 0}, PinRegion{0, 1, 1, 1}};
  scene.cloths[0].pins[1].obstacle = 0;
  return scene;
}

/// A cloth that falls over a ball on the floor and is pulled off it by its hem.
inline SimulationDescription pulled_off(int level, const IntegratorDescription& stepping) {
  SimulationDescription scene = cloth_scene({1.2, 1.2}, level, stepping);
  scene.cloths[0].position = {0, 0.62, 0};
  scene.cloths[0].orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  PinRegion hem{1, 1, 0.4, 0.6};
  hem.path = {{0, {0, 0, 0}}, {0.5, {-0.2, -0.55, 0}}, {0.8, {-0.2, -0.55, 0}}, {2, {1.4, -0.55, 0}}};
  scene.cloths[0].pins = {hem};
  scene.obstacles = {floor_at(0)};
  BallDescription ball;
  ball.position = {0, 0.3, 0};
  ball.radius = 0.3;
  ball.friction = 0.3;
  scene.balls = {ball};
  return scene;
}

/// A square of 1 m over a line, its halves spread by 40 degrees either way: they swing together and clap.
/// Nothing but gravity and the pins acts on it.
inline SimulationDescription clapping(int level, const IntegratorDescription& stepping) {
  SimulationDescription scene = cloth_scene({1, 1}, level, stepping);
  const Grid grid = scene.cloths[0].base_cells.at(level);
  const double angle = 40 * std::numbers::pi / 180;
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      const double u = double(c) / (grid.cols - 1) - 0.5, v = double(r) / (grid.rows - 1) - 0.5;
      scene.cloths[0].nodes.push_back({u * std::sin(angle), -std::abs(u) * std::cos(angle), v});
    }
  }
  scene.cloths[0].pins = {PinRegion{0.5, 0.5, 0, 1}};
  return scene;
}

/// A small cloth that falls flat onto a larger one, which hangs by its four corners.
inline SimulationDescription caught(int level, const IntegratorDescription& stepping) {
  SimulationDescription scene = cloth_scene({1, 1}, level, stepping);
  const Quaternion flat(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  scene.cloths[0].orientation = flat;
  scene.cloths[0].pins = {PinRegion{0, 0, 0, 0}, PinRegion{1, 1, 0, 0}, PinRegion{0, 0, 1, 1},
                          PinRegion{1, 1, 1, 1}};
  ClothDescription small = scene.cloths[0];
  small.size = {0.5, 0.5};
  small.pins.clear();
  small.position = {0.03, 0.3, 0.05};
  small.orientation = Quaternion(Eigen::AngleAxisd(0.3, Vec3::UnitY())) * flat;
  scene.cloths.push_back(small);
  return scene;
}

/// Two sheets, 1 cm above each other, that fall flat onto a floor half a metre below.
inline SimulationDescription fall_together(int level, const IntegratorDescription& stepping) {
  SimulationDescription scene = cloth_scene({1, 1}, level, stepping);
  scene.cloths[0].orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  scene.cloths[0].position = {0, 0.5, 0};
  scene.cloths.push_back(scene.cloths[0]);
  scene.cloths[1].position.y() += 0.01;
  scene.obstacles = {floor_at(0)};
  return scene;
}

/// A small cloth on a large one that is held everywhere, on a slope that falls along +x.
inline SimulationDescription on_a_slope(double degrees, double friction,
                                        const IntegratorDescription& stepping) {
  SimulationDescription scene = cloth_scene({3, 1}, 4, stepping);
  scene.effects.back() = ClothContactEffect{0.005, friction};
  const Quaternion slope = Eigen::AngleAxisd(-degrees * std::numbers::pi / 180, Vec3::UnitZ()) *
                           Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX());
  scene.cloths[0].orientation = slope;
  scene.cloths[0].pins = {PinRegion{0, 1, 0, 1}};
  ClothDescription small = scene.cloths[0];
  small.size = {0.4, 0.4};
  small.pins.clear();
  small.position = slope * Vec3(-0.9, 0.01, 0.005);
  scene.cloths.push_back(small);
  return scene;
}

/// A square whose one half is held on a slope that falls along its middle line, over which the other half is
/// folded onto it.
inline SimulationDescription folded_on_a_slope(double degrees, double friction,
                                               const IntegratorDescription& stepping) {
  SimulationDescription scene = cloth_scene({0.4, 0.4}, 4, stepping);
  scene.effects.back() = ClothContactEffect{0.005, friction};
  const Quaternion slope(Eigen::AngleAxisd(-degrees * std::numbers::pi / 180, Vec3::UnitZ()));
  const Grid grid = scene.cloths[0].base_cells.at(4);
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      const double u = double(c) / (grid.cols - 1), v = double(r) / (grid.rows - 1);
      scene.cloths[0].nodes.push_back(slope * Vec3(0.4 * v, u > 0.5 ? 0.0055 : 0, 0.4 * std::abs(u - 0.5)));
    }
  }
  scene.cloths[0].pins = {PinRegion{0, 0.5, 0, 1}};
  // What would lift it, and what would hold it but friction.
  scene.cloths[0].material.bending = scene.cloths[0].material.shear = 0;
  return scene;
}

/// A sheet folded over its middle line, which is held as its upper edge is, with a corner of the front half
/// put through the back one. Nothing pulls it out.
inline SimulationDescription poked_by_its_corner(int level, const IntegratorDescription& stepping) {
  SimulationDescription scene = cloth_scene({0.5, 1}, level, stepping);
  scene.effects.erase(scene.effects.begin());  // gravity
  const Grid grid = scene.cloths[0].base_cells.at(level);
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      const double u = double(c) / (grid.cols - 1), v = double(r) / (grid.rows - 1);
      // Beyond a line 0.14 m from the corner the sheet is bent backwards by 40 degrees.
      const double beyond = std::max(0.0, 0.2 - 0.5 * (1 - u) - (1 - v)) / std::numbers::sqrt2;
      const double bend = 40 * std::numbers::pi / 180,
                   back = beyond * (1 - std::cos(bend)) / std::numbers::sqrt2;
      const double front = std::max(0.0, v - 0.5) * std::sin(0.04),
                   rise = std::abs(v - 0.5) * (v < 0.5 ? 1 : std::cos(0.04));
      scene.cloths[0].nodes.push_back({0.5 * u - back, -0.5 + rise - back, front - beyond * std::sin(bend)});
    }
  }
  scene.cloths[0].pins = {PinRegion{0, 1, 0, 0}, PinRegion{0, 1, 0.5, 0.5}};
  return scene;
}

/// A held sheet, and a small one that sticks in it with a corner. Nothing pulls it out.
inline SimulationDescription stuck_in(int level, const IntegratorDescription& stepping) {
  SimulationDescription scene = cloth_scene({1, 1}, level, stepping);
  scene.effects.erase(scene.effects.begin());  // gravity
  scene.cloths[0].pins = {PinRegion{0, 1, 0, 0}};
  ClothDescription small = scene.cloths[0];
  small.size = {0.3, 0.3};
  small.position = {0.02, 0.01, 0.17};
  small.orientation = Quaternion(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY())) *
                      Quaternion(Eigen::AngleAxisd(0.7, Vec3::UnitZ()));
  small.pins.clear();
  scene.cloths.push_back(small);
  return scene;
}

}  // namespace weft::test
