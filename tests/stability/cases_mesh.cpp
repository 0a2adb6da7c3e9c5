// Solids within triangles, and with edges: S41, S55.
#include <cmath>
#include <memory>
#include <numbers>

#include "cloth/shapes/triangle_mesh.h"
#include "criteria.h"
#include "passages.h"

namespace weft::stability {
namespace {

constexpr double kRadius = 0.35;

/// A ball of 5,000 triangles, with bumps and hollows of that height, m, 20 cm apart.
std::shared_ptr<const TriangleMesh> ball_of_triangles(double bumps) {
  constexpr int kRings = 50, kSectors = 51;
  TriangleList list;
  const auto place = [=](double down, double round) -> Vec3 {
    const Vec3 out(std::sin(down) * std::cos(round), std::cos(down), std::sin(down) * std::sin(round));
    return (kRadius + bumps / 2 * std::cos(11 * out.x()) * std::cos(11 * out.z()) * std::cos(11 * out.y())) *
           out;
  };
  list.vertices = {place(0, 0), place(std::numbers::pi, 0)};
  const auto vertex = [](int ring, int sector) {
    if (ring == 0 || ring == kRings) return ring == 0 ? 0 : 1;
    return 2 + (ring - 1) * kSectors + sector % kSectors;
  };
  for (int ring = 1; ring < kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      list.vertices.push_back(
          place(std::numbers::pi * ring / kRings, 2 * std::numbers::pi * sector / kSectors));
    }
  }
  for (int ring = 0; ring < kRings; ++ring) {
    for (int sector = 0; sector < kSectors; ++sector) {
      const int a = vertex(ring, sector), b = vertex(ring, sector + 1), c = vertex(ring + 1, sector + 1),
                d = vertex(ring + 1, sector);
      if (a != b) list.triangles.push_back({a, b, c});
      if (c != d) list.triangles.push_back({a, c, d});
    }
  }
  return std::make_shared<const TriangleMesh>(list);
}

SimulationDescription over_the_ball(const Setup& setup) {
  static const std::shared_ptr<const TriangleMesh> surface = ball_of_triangles(0.01);
  SimulationDescription scene = level_sheet(setup, {});
  scene.cloths[0].position = {0, kRadius + 0.07, 0};
  scene.obstacles = {{.shape = MeshDescription{.surface = surface}, .friction = 0.5}};
  return scene;
}

Expectation rests(const Setup& setup) {
  const SimulationDescription scene = over_the_ball(setup);
  Expectation expect;
  expect.stretch = 0.05;
  expect.excess = xpbd_excess(scene, setup, mass_of(scene.cloths[0]) * kGravity / 2);
  expect.stretch_from = 2;
  return expect;
}

Case at_rest() {
  Case made{"S41",
            "falls over a ball of 5,000 triangles with bumps of 1 cm: outside at every step, and at rest",
            {{5, over_the_ball}}};
  made.levels = {4, 5};
  made.expect = rests;
  return made;
}

/// At rest on it, and then turned: rubbed along at the ball's widest by all of its weight, and going round
/// itself, its corners spread, as fast as the ball.
Case turning_under() {
  constexpr double kLies = 3, kFirst = 0.25, kQuarter = 0.5;  // s
  constexpr int kQuarters = 4;
  const auto turning = [](const Setup& setup) {
    SimulationDescription made = over_the_ball(setup);
    for (int quarter = 0; quarter <= kQuarters; ++quarter) {
      const Eigen::AngleAxisd turned(quarter * std::numbers::pi / 2, Vec3::UnitY());
      made.obstacles[0].path.push_back({kFirst + quarter * kQuarter, {{0, 0, 0}, Quaternion(turned)}});
    }
    return made;
  };
  Case made{"S41b",
            "the same ball turns once round under the resting drape: no energy but its work, at rest after",
            {{kLies, over_the_ball}, {kFirst + kQuarters * kQuarter + 1, turning}}};
  made.levels = {4};
  made.expect = [](const Setup& setup) {
    Expectation expect = rests(setup);
    const SimulationDescription lying = over_the_ball(setup);
    const double mass = mass_of(lying.cloths[0]), rate = std::numbers::pi / 2 / kQuarter;
    const double corner = kSize / std::numbers::sqrt2;
    const double rubbed = lying.obstacles[0].friction * mass * kGravity * rate * kRadius;  // W
    expect.input = rubbed * kQuarters * kQuarter + mass * rate * rate * corner * corner / 2;
    return expect;
  };
  return made;
}

/// A table of 0.6 m under a sheet of 2 m: its edges and corners bear all of it.
Case on_a_box() {
  const auto scene = [](const Setup& setup) {
    SimulationDescription made = level_sheet(setup, {});
    made.cloths[0].position = {0, 0.05, 0};
    made.obstacles = {{.shape = BoxDescription{{0.6, 0.5, 0.6}}, .position = {0, -0.25, 0}, .friction = 0.5}};
    return made;
  };
  Case made{"S55a", "falls over a standing box: outside at every step, and at rest", {{5, scene}}};
  made.levels = {4, 5};
  made.watch = nothing_passes;
  made.expect = [scene](const Setup& setup) {
    const SimulationDescription falls = scene(setup);
    Expectation expect;
    expect.stretch = 0.05 + xpbd_excess(falls, setup, mass_of(falls.cloths[0]) * kGravity / 2);
    expect.stretch_from = 2;
    return expect;
  };
  return made;
}

/// Eight faces, six corners, the upper one of 53 degrees, known to be convex. Cells that it pierces slip off:
/// friction is less than the 0.5 at which it would hold them.
ObstacleDescription sharp_body() {
  static const auto surface = std::make_shared<const TriangleMesh>(
      TriangleList{{{0.2, 0, 0}, {-0.2, 0, 0}, {0, 0.4, 0}, {0, -0.4, 0}, {0, 0, 0.3}, {0, 0, -0.3}},
                   {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}});
  return {.shape = MeshDescription{.surface = surface, .convex = true}, .friction = 0.3};
}

/// Laid onto it at `speed` 0, or thrown.
Case on_a_sharp_body(std::string name, std::string what, double speed) {
  const auto scene = [=](const Setup& setup) {
    SimulationDescription made = level_sheet(setup, {});
    made.cloths[0].position = {0.02, 0.6, 0.03};
    made.cloths[0].velocity = {0, -speed, 0};
    made.obstacles = {sharp_body(), {.shape = PlaneDescription{}, .position = {0, -0.6, 0}, .friction = 0.5}};
    return made;
  };
  Case made{std::move(name), std::move(what), {{5, scene}}};
  made.levels = {4, 5};
  made.watch = nothing_passes;
  made.expect = [=](const Setup& setup) {
    const SimulationDescription falls = scene(setup);
    const double cell = kSize / (1 << setup.level), way = speed * setup.time_step();
    Expectation expect;
    // Those that it stops, by its shadow, for a step before their neighbours follow: eight springs each.
    expect.input = std::max(1.0, 0.4 * 0.6 / (cell * cell)) * (4 * 5000 + 4 * 500) * way * way / 2;
    expect.stretch = 0.05 + xpbd_excess(falls, setup, mass_of(falls.cloths[0]) * kGravity / 2);
    expect.stretch_from = 2;
    return expect;
  };
  return made;
}

}  // namespace

std::vector<Case> mesh_cases() {
  return {
      at_rest(),
      turning_under(),
      on_a_box(),
      on_a_sharp_body("S55b", "falls over a convex body with sharp edges onto a floor: at rest", 0),
      on_a_sharp_body("S55c", "the same thrown down at 50 m/s: no node passes, at rest", 50),
  };
}

}  // namespace weft::stability
