// Bodies on nodes that pins hold: those give way to nothing, so bodies rest on them and go with them as with
// a collider that nothing moves but itself, whatever the integrator.
#include <gtest/gtest.h>

#include <numbers>

#include "bodies.h"
#include "cloth/world/simulation.h"
#include "meshes.h"

namespace weft {
namespace {

using test::flying;

constexpr double kSide = 0.3;  // of the bodies' boxes, m

/// A flat sheet of 2 m in the plane y = 0, in cells of 0.125 m.
SimulationDescription sheet_held_by(const std::vector<PinRegion>& pins,
                                    const IntegratorDescription& integrator) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  cloth.min_level = cloth.initial_level = cloth.max_level = 4;
  cloth.material = {.density = 0.2, .structural = 50000, .shear = 5000};
  cloth.pins = pins;
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{}, DampingEffect{}};
  scene.integrator = integrator;
  return scene;
}

MeshDescription mesh(const TriangleList& list, bool convex) {
  return {std::make_shared<const TriangleMesh>(list), Quaternion::Identity(), convex};
}

/// A box of kSide as a mesh, with a notch in its top: not convex.
TriangleList notched_box() {
  TriangleList box = test::box_mesh(Vec3::Constant(kSide / 2));
  const int middle = static_cast<int>(box.vertices.size());
  box.vertices.push_back({0, kSide / 4, 0});
  box.triangles.erase(box.triangles.begin() + 6, box.triangles.begin() + 8);  // its top
  for (const auto& [from, to] : {std::pair{2, 6}, {6, 7}, {7, 3}, {3, 2}}) {
    box.triangles.push_back({from, to, middle});
  }
  return box;
}

/// Fall from 2 cm.
void add_bodies(SimulationDescription& scene, double mass, double friction) {
  const Vec3 still(0, 0, 0);
  const double height = kSide / 2 + 0.02;
  BallDescription ball = test::flying_ball({0.05, height, 0.04}, kSide / 2, still, friction);
  ball.mass = mass;
  scene.balls = {ball};
  const auto add = [&](const auto& shape, const Vec3& place) {
    scene.obstacles.push_back(flying(shape, place, still, friction, mass));
  };
  add(BoxDescription{Vec3::Constant(kSide)}, {0.43, height, 0.02});
  CapsuleDescription capsule{kSide / 2, 0.2};
  capsule.orientation = Quaternion(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()));
  add(capsule, {-0.44, height, 0.03});
  add(mesh(test::box_mesh(Vec3::Constant(kSide / 2)), true), {0.04, height, 0.42});
  add(mesh(notched_box(), false), {0.01, height, -0.43});
}

std::vector<Vec3> places(const Simulation<float>& simulation) {
  std::vector<Vec3> all;
  for (const Ball& ball : simulation.colliders().balls()) all.push_back(ball.position);
  for (const Obstacle& body : simulation.colliders().obstacles()) all.push_back(body.pose.position);
  return all;
}

class OnPinnedCloth : public ::testing::TestWithParam<IntegratorDescription> {};
std::string name_of_method(const ::testing::TestParamInfo<IntegratorDescription>& test) {
  return std::visit([](const auto& d) { return std::string(d.kName); }, test.param);
}
INSTANTIATE_TEST_SUITE_P(Integrators, OnPinnedCloth,
                         ::testing::Values(BackwardEulerDescription{}, Bdf2Description{}, XpbdDescription{}),
                         name_of_method);
INSTANTIATE_TEST_SUITE_P(Slow, OnPinnedCloth, ::testing::Values(SymplecticEulerDescription{}),
                         name_of_method);

TEST_P(OnPinnedCloth, BodiesRest) {
  SimulationDescription scene = sheet_held_by({{0, 1, 0, 1}}, GetParam());
  add_bodies(scene, 0.1, 0.5);
  Simulation<float> simulation(scene);
  for (int step = 0; step < 240; ++step) simulation.step();
  const std::vector<Vec3> before = places(simulation);
  for (int step = 0; step < 60; ++step) simulation.step();
  const std::vector<Vec3> after = places(simulation);
  // A ball hangs between four nodes 0.125 m apart: it touches all of them where they are 0.088 m from its
  // axis.
  const double sag = kSide / 2 - std::sqrt(kSide * kSide / 4 - 0.125 * 0.125 / 2) + 1e-3;
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_LT(after[i].y(), kSide / 2 + 1e-3) << i;
    EXPECT_GT(after[i].y(), kSide / 2 - (i == 0 || i == 2 ? sag : 1e-3)) << i;
    EXPECT_LT((after[i] - before[i]).norm(), 1e-4) << i;
  }
}

TEST_P(OnPinnedCloth, AHeldPatchHoldsThemAsWell) {
  SimulationDescription scene = sheet_held_by({{0.15, 0.85, 0.15, 0.85}}, GetParam());
  add_bodies(scene, 5, 0.5);
  Simulation<float> simulation(scene);
  for (int step = 0; step < 240; ++step) simulation.step();
  for (const Vec3& place : places(simulation)) {
    EXPECT_LT(place.y(), kSide / 2 + 2e-3);
    EXPECT_GT(place.y(), kSide / 2 - 0.03);
  }
}

TEST_P(OnPinnedCloth, ABeamLiesOnTwoHeldEdges) {
  // Held along its rim; the beam of 2 kg reaches beyond it on both sides, and the sheet below it bears
  // little.
  SimulationDescription scene =
      sheet_held_by({{0, 1, 0, 0}, {0, 1, 1, 1}, {0, 0, 0, 1}, {1, 1, 0, 1}}, GetParam());
  scene.obstacles = {flying(BoxDescription{{2.2, 0.1, 0.3}}, {0, 0.07, 0.02}, {0, 0, 0}, 0.5, 2)};
  Simulation<float> simulation(scene);
  for (int step = 0; step < 240; ++step) simulation.step();
  EXPECT_NEAR(simulation.colliders().obstacles()[0].pose.position.y(), 0.05, 1e-3);
  EXPECT_LT(simulation.colliders().obstacles()[0].body->velocity().norm(), 1e-2);
}

TEST_P(OnPinnedCloth, WhatIsFastDoesNotPass) {
  // 1.3 m in a step of 1/15 s.
  SimulationDescription scene = sheet_held_by({{0, 1, 0, 1}}, GetParam());
  scene.time_step = 1.0 / 15;
  scene.balls = {test::flying_ball({0.05, 2, 0.04}, 0.15, {0, -20, 0}, 0.5)};
  scene.obstacles = {flying(BoxDescription{{0.3, 0.3, 0.3}}, {0.5, 2, 0}, {0, -20, 0}, 0.5)};
  Simulation<float> simulation(scene);
  for (int step = 0; step < 30; ++step) {
    simulation.step();
    for (const Vec3& place : places(simulation)) ASSERT_GT(place.y(), 0.12) << "step " << step;
  }
}

TEST(PinnedCloth, CarriesBodiesAsAColliderDoes) {
  // Up by 0.5 m and aside by 1 m in two seconds; and the same beside it by a box that goes the same way.
  const std::vector<Waypoint> path{{0, {0, 0, 0}}, {1, {0, 0, 0}}, {3, {1, 0.5, 0}}, {5, {1, 0.5, 0}}};
  SimulationDescription scene = sheet_held_by({{0, 1, 0, 1, path}}, Bdf2Description{});
  ObstacleDescription lift = test::standing(BoxDescription{{2, 0.2, 2}}, {0, -0.1, 5}, 0.5);
  for (const Waypoint& point : path) {
    lift.path.push_back({point.time, {Vec3(lift.position + point.position), Quaternion::Identity()}});
  }
  const BoxDescription box{{0.3, 0.3, 0.3}};
  scene.obstacles = {lift, flying(box, {0, 0.15, 0}, {0, 0, 0}, 0.5),
                     flying(box, {0, 0.15, 5}, {0, 0, 0}, 0.5)};
  Simulation<float> simulation(scene);
  for (int step = 1; step <= 300; ++step) {
    simulation.step();
    const Vec3 on_sheet = simulation.colliders().obstacles()[1].pose.position;
    const Vec3 on_lift = simulation.colliders().obstacles()[2].pose.position - Vec3(0, 0, 5);
    ASSERT_LT((on_sheet - on_lift).norm(), 2e-3) << "step " << step;
  }
  // It begins with 0.5 m/s at once, and slips by (0.5 m/s)^2 / (2 mu g) = 0.025 m.
  EXPECT_LT((simulation.colliders().obstacles()[1].pose.position - Vec3(1, 0.65, 0)).norm(), 0.03);
}

TEST(PinnedCloth, LetsASleepingBodyFallWhenItIsLetGo) {
  SimulationDescription scene = sheet_held_by({{0, 1, 0, 1}}, Bdf2Description{});
  scene.obstacles = {flying(BoxDescription{{0.3, 0.3, 0.3}}, {0, 0.15, 0}, {0, 0, 0}, 0.5)};
  Simulation<float> simulation(scene);
  for (int step = 0; step < 200; ++step) simulation.step();
  EXPECT_TRUE(simulation.colliders().obstacles()[0].rest.asleep());
  ASSERT_TRUE(simulation.unpin(0, {0.5, 0.5}));
  for (int step = 0; step < 60; ++step) simulation.step();
  EXPECT_LT(simulation.colliders().obstacles()[0].pose.position.y(), -1);
}

}  // namespace
}  // namespace weft
