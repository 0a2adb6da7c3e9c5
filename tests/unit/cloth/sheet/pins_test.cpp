// Pins that follow a path: held nodes are where the path says at every step's end, at any level, under every
// integrator; the cloth follows.
#include <gtest/gtest.h>

#include "cloth/sheet/pins.h"
#include "cloth/world/simulation.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::get;

/// A sheet of 2 m hung by its upper corners; the left one goes 0.5 m towards +z in half a second and back.
SimulationDescription led_by_a_corner(const IntegratorDescription& integrator, int level) {
  SimulationDescription description;
  ClothDescription cloth;
  cloth.min_level = 3;
  cloth.max_level = 5;
  cloth.initial_level = level;
  cloth.pins = {{0, 0, 0, 0, {{0, {0, 0, 0}}, {0.5, {0, 0, 0.5}}, {1, {0, 0, 0}}}}, {1, 1, 0, 0}};
  description.cloths = {cloth};
  description.effects = {GravityEffect{}, DampingEffect{}};
  description.integrator = integrator;
  return description;
}

class MovingPins : public ::testing::TestWithParam<IntegratorDescription> {};
INSTANTIATE_TEST_SUITE_P(Integrators, MovingPins,
                         ::testing::Values(SymplecticEulerDescription{}, BackwardEulerDescription{},
                                           Bdf2Description{}, XpbdDescription{}),
                         [](const auto& test) {
                           return std::visit([](const auto& d) { return std::string(d.kName); }, test.param);
                         });

TEST_P(MovingPins, AreWhereTheirPathSaysAndTheClothFollows) {
  Simulation<double> simulation(led_by_a_corner(GetParam(), 4));
  const Vec3 corner(-1, 1, 0), other(1, 1, 0);
  for (int step = 1; step <= 30; ++step) {
    simulation.step();
    const auto& position = simulation.cloths()[0].particles().position;
    // Rounding of the sums only: 0.5 m in 30 steps.
    EXPECT_LT((get(position, 0, 0) - corner - Vec3(0, 0, step / 60.0)).norm(), 1e-14);
    EXPECT_EQ(get(position, 0, 16), other);
  }
  // The left edge hangs from the corner: half a second after it set off the sheet's left half is on its way.
  EXPECT_GT(get(simulation.cloths()[0].particles().position, 8, 0).z(), 0.05);
  // The corners are sqrt(4.25) m apart, 3.1 % more than the sheet is wide; its weight hangs from them as
  // well.
  EXPECT_LT(simulation.report(0).strain.max, 0.1);
}

TEST_P(MovingPins, StayOnTheirPathThroughLevelChanges) {
  Simulation<double> simulation(led_by_a_corner(GetParam(), 4));
  const int levels[] = {5, 4, 3, 4, 5};
  for (int step = 1; step <= 60; ++step) {
    if (step % 10 == 0 && step < 60) simulation.request_level(0, levels[step / 10 - 1]);
    simulation.step();
    const double out = step <= 30 ? step / 60.0 : 1 - step / 60.0;
    const auto& position = simulation.cloths()[0].particles().position;
    EXPECT_LT((get(position, 0, 0) - Vec3(-1, 1, out)).norm(), 1e-13) << "step " << step;
  }
}

TEST(Pins, HoldARegionOrTheNearestNode) {
  Particles<double> sheet = test::flat_sheet<double>(9, 9, {2, 2});
  const Pins<double> pins({{0.25, 0.5, 0, 0}, {0.99, 0.99, 0.99, 0.99}}, 0, sheet);
  EXPECT_FALSE(pins.moving());
  std::vector<std::pair<int, int>> held;
  test::each_node(sheet.grid(), [&](int r, int c) {
    if (sheet.inverse_mass.at(r, c) == 0) held.emplace_back(r, c);
  });
  EXPECT_EQ(held, (std::vector<std::pair<int, int>>{{0, 2}, {0, 3}, {0, 4}, {8, 8}}));
}

TEST(Pins, CarryFromWhereTheyAreAtTheTime) {
  // Made in the path's middle, at offset (1, 0, 0): at its end, (2, 0, 0), they are 1 m further.
  Particles<double> sheet = test::flat_sheet<double>(9, 9, {2, 2});
  Pins<double> pins({{0, 0, 0, 0, {{1, {0, 0, 0}}, {3, {2, 0, 0}}}}}, 2, sheet);
  EXPECT_TRUE(pins.moving());
  EXPECT_FALSE(pins.begin_step(sheet, {}, 3, 1));
  EXPECT_TRUE(pins.begin_step(sheet, {}, 2, 1));
  pins.carry(sheet, 3);
  EXPECT_EQ(get(sheet.position, 0, 0), Vec3(0, 1, 0));
  EXPECT_EQ(get(sheet.position, 0, 1), Vec3(-0.75, 1, 0));
}

TEST(Pins, FixedToAnObstacleGoAndTurnWithIt) {
  // A quarter turn about y, half a metre up: from (-1, 1, 0), seen from (0, 1, 0) at (-1, 0, 0), to (0, 0,
  // 1).
  Particles<double> sheet = test::flat_sheet<double>(9, 9, {2, 2});
  PinRegion corner{0, 0, 0, 0};
  corner.obstacle = 1;
  Pins<double> pins({corner}, 0, sheet);
  EXPECT_TRUE(pins.moving());
  Solid other, body;
  other.id = kFirstObstacle;
  body.id = kFirstObstacle + 1;
  body.shape = Capsule{1, 0.2};
  body.start = {0, 1, 0};
  body.position = {0, 1.5, 0};
  body.velocity = {0, 1, 0};
  body.turn = {0, std::acos(-1.0) / 2, 0};
  body.rotation = Eigen::AngleAxisd(body.turn.y(), Vec3::UnitY()).toRotationMatrix();
  EXPECT_TRUE(pins.begin_step(sheet, {other, body}, 3, 0.5));
  pins.carry(sheet, 3);
  EXPECT_LT((get(sheet.position, 0, 0) - Vec3(-1, 1, 0)).norm(), 1e-14);
  pins.carry(sheet, 3.5);
  EXPECT_LT((get(sheet.position, 0, 0) - Vec3(0, 1.5, 1)).norm(), 1e-14);
  // Where it stands now it stays.
  body.start = body.position;
  body.velocity = body.turn = Vec3::Zero();
  EXPECT_FALSE(pins.begin_step(sheet, {other, body}, 3.5, 0.5));
  pins.carry(sheet, 4);
  EXPECT_LT((get(sheet.position, 0, 0) - Vec3(0, 1.5, 1)).norm(), 1e-14);
}

}  // namespace
}  // namespace weft
