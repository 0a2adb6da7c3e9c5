// Cloth that is held all around bears what falls on it: boxes and hulls of random corners, of 0.1 to 0.3 m,
// at least 3 cm thick and as dense as cork to stone, turned as they come. They tumble and stay on it.
#include <gtest/gtest.h>

#include <numbers>

#include "cloth/shapes/mass_properties.h"
#include "cloth/world/simulation.h"
#include "draws.h"
#include "fixtures.h"
#include "methods.h"
#include "scene/convex_hull.h"

namespace weft::test {
namespace {

constexpr double kThinnest = 0.03;  // m
constexpr double kHeight = 1;       // of the sheet, m

/// A body in its own frame, around its centre of mass.
struct Drawn {
  ObstacleShape shape;
  double volume = 0;  ///< m3
};

class Draw : public Draws {
 public:
  Drawn box() {
    BoxDescription box;
    for (int axis = 0; axis < 3; ++axis) box.size[axis] = between(kThinnest, 0.3);
    return {box, box.size.prod()};
  }
  Drawn hull() {
    for (;;) {
      std::vector<Vec3> corners(4 + static_cast<std::size_t>(below(5)));
      for (Vec3& corner : corners) corner = Vec3(between(-1, 1), between(-1, 1), between(-1, 1)) * 0.15;
      TriangleList surface = scene::convex_hull(corners);
      const Vec3 centre = mass_properties(surface).centre;
      for (Vec3& corner : surface.vertices) corner -= centre;
      const auto mesh = std::make_shared<const TriangleMesh>(surface);
      if (2 * mesh->inner_radius() < kThinnest) continue;
      return {MeshDescription{mesh, Quaternion::Identity(), true}, volume_of(surface)};
    }
  }
  Quaternion turn() {
    return Quaternion(Eigen::AngleAxisd(between(0, 2 * std::numbers::pi), Vec3::UnitX()) *
                      Eigen::AngleAxisd(between(0, 2 * std::numbers::pi), Vec3::UnitZ()));
  }

 private:
  static double volume_of(const TriangleList& surface) {
    double sixfold = 0;
    for (const auto& [a, b, c] : surface.triangles) {
      const auto corner = [&](int i) { return surface.vertices[static_cast<std::size_t>(i)]; };
      sixfold += corner(a).dot(corner(b).cross(corner(c)));
    }
    return sixfold / 6;
  }
};

/// On a sheet of 2 m.
SimulationDescription dropped(Draw& draw, const Drawn& body, const IntegratorDescription& integrator) {
  SimulationDescription scene;
  ClothDescription sheet;
  sheet.size = {2, 2};
  sheet.position = {0, kHeight, 0};
  sheet.orientation = Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX());
  sheet.material = find_fabric(draw.one_of(std::array{"cotton", "silk", "denim", "canvas"}))->material;
  sheet.min_level = sheet.initial_level = sheet.max_level = draw.one_of(std::array{3, 4, 5});
  sheet.pins = {{0, 1, 0, 0}, {0, 1, 1, 1}, {0, 0, 0, 1}, {1, 1, 0, 1}};
  scene.cloths = {sheet};
  ObstacleDescription falling;
  falling.shape = body.shape;
  std::visit(
      [&](auto& shape) {
        if constexpr (requires { shape.orientation; }) shape.orientation = draw.turn();
      },
      falling.shape);
  falling.position = {draw.between(-0.4, 0.4), kHeight + draw.between(0.3, 0.6), draw.between(-0.4, 0.4)};
  falling.friction = draw.one_of(std::array{0.0, 0.3, 0.6});
  falling.body = BodyDescription{.mass = body.volume * draw.between(100, 3000)};
  scene.obstacles = {falling};
  scene.effects = {GravityEffect{}, DampingEffect{}};
  scene.time_step = 1.0 / draw.one_of(std::array{15, 30, 60, 120});
  scene.integrator = integrator;
  return scene;
}

class BodyOnSheet : public ImplicitMethod {};

TEST_P(BodyOnSheet, StaysOnIt) {
  Draw draw;
  for (int body = 0; body < sample(16); ++body) {
    const SimulationDescription scene = dropped(draw, body % 2 == 0 ? draw.box() : draw.hull(), integrator());
    Simulation<float> simulation(scene);
    const auto height = [&] { return simulation.colliders().obstacles()[0].pose.position.y(); };
    double highest = height();
    for (double time = 0; time < 5; time += scene.time_step) {
      simulation.step();
      highest = std::max(highest, height());
    }
    const double mass = scene.obstacles[0].body->mass;
    EXPECT_GT(height(), 0) << "body " << body << " of " << mass << " kg";
    // It has what it fell from.
    EXPECT_LT(highest, scene.obstacles[0].position.y() + 0.05) << "body " << body << " of " << mass << " kg";
  }
}

INSTANTIATE_TEST_SUITE_P(Implicit, BodyOnSheet, ::testing::Values(Method::bdf2), name_of_case);
INSTANTIATE_TEST_SUITE_P(Nightly, BodyOnSheet, ::testing::ValuesIn(kImplicitMethods), name_of_case);

}  // namespace
}  // namespace weft::test
