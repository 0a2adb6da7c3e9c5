// Solids within triangles: S41.
#include <cmath>
#include <memory>
#include <numbers>

#include "cloth/contact/triangle_mesh.h"
#include "criteria.h"

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
  expect.stretch = 0.05 + xpbd_excess(scene, setup, mass_of(scene.cloths[0]) * kGravity / 2);
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

}  // namespace

std::vector<Case> mesh_cases() { return {at_rest()}; }

}  // namespace weft::stability
