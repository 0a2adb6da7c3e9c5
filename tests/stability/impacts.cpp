#include "impacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cloth/sheet/material.h"
#include "draw.h"
#include "passages.h"

namespace weft::stability {
namespace {

Quaternion any_turn(Draw& draw) {
  const double angle = draw.between(0, 2 * std::numbers::pi);
  return Quaternion(Eigen::AngleAxisd(angle, draw.direction()));
}

ClothDescription any_sheet(Draw& draw) {
  constexpr std::array kFabrics{"cotton", "silk", "denim", "wool"};
  ClothDescription cloth;
  const double width = draw.decades(0.4, 2);
  cloth.size = {width, width * draw.between(0.5, 1)};
  cloth.min_level = cloth.max_level = cloth.initial_level = draw.integer(3, 5);
  cloth.material = find_fabric(kFabrics[static_cast<std::size_t>(draw.integer(0, 3))])->material;
  cloth.material.damping = 0;
  cloth.orientation = any_turn(draw);
  return cloth;
}

}  // namespace

Impact random_impact(std::uint64_t seed) {
  Draw draw(seed);
  Impact impact;
  SimulationDescription& scene = impact.scene;
  ClothDescription cloth = any_sheet(draw);
  const double width = cloth.size.x();
  const double radius = draw.decades(0.03, 0.3), speed = draw.decades(1, 30);
  const double friction = draw.chance(0.3) ? 0 : draw.between(0, 0.8);
  const Vec3 aim = draw.in_box(0.3 * width), way = draw.direction();
  const bool thrown = draw.chance(0.6);
  impact.seconds = thrown ? 1.5 : 1;
  // Half a sheet and the aim reach 1.3 widths at most, half a box sqrt(19) radii.
  constexpr double kApart = 0.2;  // m
  const double distance = 1.3 * width + 5 * radius + kApart;
  const Vec3 from = thrown ? aim : Vec3(aim - distance * way), to = from + speed * impact.seconds * way;
  cloth.position = thrown ? Vec3(-distance * way) : Vec3(0, 0, 0);
  if (thrown) cloth.velocity = speed * way;
  if (!thrown && draw.chance(0.5)) cloth.pins = {PinRegion{0, 1, 0, 0}};
  const int kind = draw.integer(0, 2);
  if (kind == 0) {
    BallDescription ball;
    ball.position = from;
    ball.radius = radius;
    ball.friction = friction;
    if (!thrown) ball.velocity = speed * way;
    scene.balls = {ball};
  } else {
    ObstacleDescription solid;
    const Quaternion turned = any_turn(draw);
    const double wide = draw.between(1, 3), deep = draw.between(1, 3);
    if (kind == 1) {
      solid.shape = BoxDescription{{2 * radius, 2 * wide * radius, 2 * deep * radius}, turned};
    } else {
      solid.shape = CapsuleDescription{radius, wide * 2 * radius, turned};
    }
    solid.position = from;
    solid.friction = friction;
    if (!thrown) solid.path = {{0, {from, turned}}, {impact.seconds, {to, turned}}};
    scene.obstacles = {solid};
  }
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{}};
  scene.sleep_speed = 0;
  constexpr std::array kRates{15, 30, 60};
  scene.time_step = 1.0 / kRates[static_cast<std::size_t>(draw.integer(0, 2))];
  if (draw.chance(0.6)) {
    scene.integrator = Bdf2Description{};
  } else {
    scene.integrator = BackwardEulerDescription{};
  }
  impact.energy = cloth.material.density * cloth.size.x() * cloth.size.y() * (speed * speed / 2 + kGravity);
  return impact;
}

Blow strike(const Impact& impact) {
  Simulation<float> simulation(impact.scene);
  const Watch watch = nothing_passes({});
  Blow blow;
  watch(simulation, 0);
  const long steps = std::lround(impact.seconds / impact.scene.time_step);
  for (long step = 0; step < steps; ++step) {
    simulation.step();
    blow.created = std::max(blow.created, -simulation.last_advance(0).energy_lost / impact.energy);
    blow.passed = watch(simulation, simulation.time()).has_value() || blow.passed;
  }
  return blow;
}

}  // namespace weft::stability
