// The library's cloths, balls, obstacles and hands.
#include <cmath>

#include "fixtures.h"

namespace weft {
namespace {

double distance(const Vector& a, const Vector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST(WorldCloth, HandsOutItsNodesRowByRow) {
  World world = World::parse(kFalling);
  World::Cloth sheet = world.cloth("sheet");
  sheet.set_level(3);
  world.step();
  ASSERT_EQ(sheet.level(), 3);
  ASSERT_EQ(sheet.rows(), 9);
  ASSERT_EQ(sheet.columns(), 9);
  const std::vector<float> positions(sheet.positions().begin(), sheet.positions().end());
  ASSERT_EQ(positions.size(), 3U * 81U);
  // u along +x, v along -y: the first node is the upper left corner, the last the lower right one.
  EXPECT_NEAR(positions[0], -0.5, 1e-5);
  EXPECT_GT(positions[1], 0.4);
  EXPECT_NEAR(positions[3U * 80U], 0.5, 1e-5);
  EXPECT_LT(positions[3U * 80U + 1], -0.4);
  // Free fall, hardly damped: g h after a step.
  EXPECT_NEAR(sheet.velocities()[1], -9.81 * world.time_step(), 0.02);
  EXPECT_NEAR(sheet.mass(), 0.2, 1e-9);
}

TEST(WorldCloth, ItsTrianglesFaceForward) {
  World world = World::parse(kFalling);
  const World::Cloth sheet = world.cloth("sheet");
  const std::vector<std::uint32_t> corners = sheet.triangles();
  const auto cells = static_cast<std::size_t>((sheet.rows() - 1) * (sheet.columns() - 1));
  ASSERT_EQ(corners.size(), 6 * cells);
  const std::span<const float> at = sheet.positions();
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const float* a = &at[3 * corners[i]];
    const float* b = &at[3 * corners[i + 1]];
    const float* c = &at[3 * corners[i + 2]];
    // The flat sheet's normal is +z.
    EXPECT_GT((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]), 0);
  }
}

TEST(WorldCloth, APinHoldsUntilItIsTaken) {
  World world = World::parse(kFalling);
  World::Cloth sheet = world.cloth("sheet");
  sheet.pin(0, 0);
  sheet.pin(1, 0);
  const float height = sheet.positions()[1];
  world.step(30);
  EXPECT_EQ(sheet.positions()[1], height);
  EXPECT_TRUE(sheet.unpin(0, 0));
  EXPECT_TRUE(sheet.unpin(1, 0));
  EXPECT_FALSE(sheet.unpin(1, 0));
  world.step(30);
  EXPECT_LT(sheet.positions()[1], height - 0.5F);
}

TEST(WorldCloth, AHandHoldsUntilItIsReleased) {
  World world = World::parse(kFalling);
  World::Cloth sheet = world.cloth("sheet");
  World::Hand hand = sheet.grab(0.5, 0.5);
  world.step(60);
  EXPECT_GT(sheet.centre()[1], -0.5) << "free fall would be at -4.9 m";
  hand.move_to({0, 1, 0});
  world.step(120);
  EXPECT_GT(sheet.centre()[1], 0.3);
  hand.release();
  EXPECT_EQ(error_of([&] { hand.move_to({0, 0, 0}); }).substr(0, 4), "hand");
  world.step(60);
  EXPECT_LT(sheet.centre()[1], -2);
}

TEST(WorldCloth, ItsMaterialCanBeChanged) {
  World soft = World::parse(kFalling), stiff = World::parse(kFalling);
  stiff.cloth("sheet").set_parameter("structural", {50000});
  for (World* world : {&soft, &stiff}) {
    world->cloth("sheet").pin(0, 0);
    world->cloth("sheet").pin(1, 0);
    world->step(120);
  }
  EXPECT_LT(stiff.cloth("sheet").state().max_stretch, soft.cloth("sheet").state().max_stretch / 3);
  EXPECT_EQ(error_of([&] { soft.cloth("sheet").set_parameter("structural", {-1}); }),
            "structural is -1; must be from 0 to 1000000000 N/m");
}

TEST(WorldCloth, RefusesLevelsThatItHasNot) {
  World world = World::parse(kFalling);
  EXPECT_EQ(error_of([&] { world.cloth("sheet").set_level(6); }), "level is 6; must be from 3 to 5");
  EXPECT_EQ(error_of([&] { world.cloth("sheet").pin(2, 0); }), "u is 2; must be from 0 to 1");
  EXPECT_EQ(error_of([&] { world.cloth("sheet").grab(0, 0, 0); }),
            "max_force is 0; must be from 0.001 to 10000 N");
}

TEST(WorldBall, ComesGoesAndFlies) {
  World world = World::parse(kFalling);
  ASSERT_EQ(world.balls().size(), 1U);
  World::Ball falls = world.add_ball({.position = {20, 0, 0}, .radius = 0.1, .mass = 1});
  World::Ball stays = world.add_ball({.position = {21, 0, 0}, .radius = 0.1});
  world.step(60);
  EXPECT_NEAR(falls.position()[1], -9.81 / 2, 0.1);
  EXPECT_EQ(stays.position(), (Vector{21, 0, 0}));
  stays.move_to({22, 1, 0});
  world.step();
  EXPECT_LT(distance(stays.position(), {22, 1, 0}), 1e-12);
  stays.throw_off({3, 0, 0});
  world.step(60);
  EXPECT_NEAR(stays.position()[0], 25, 0.1);
  stays.remove();
  EXPECT_EQ(world.balls().size(), 2U);
  EXPECT_NE(error_of([&] { stays.position(); }).find("no longer there"), std::string::npos);
  EXPECT_EQ(error_of([&] { world.add_ball({.radius = -1}); }), "radius is -1; must be from 0.01 to 10 m");
}

TEST(WorldObstacle, IsMovedAndThrown) {
  World world = World::parse(kFalling);
  std::vector<World::Obstacle> obstacles = world.obstacles();
  ASSERT_EQ(obstacles.size(), 2U);
  World::Obstacle box = obstacles[0], floor = obstacles[1];
  EXPECT_TRUE(box.is_body());
  EXPECT_FALSE(floor.is_body());
  box.move_to({-6, 2, 0}, Turn{0, 0, 2, 0});
  world.step();
  EXPECT_LT(distance(box.position(), {-6, 2, 0}), 1e-12);
  EXPECT_NEAR(std::abs(box.turn()[2]), 1, 1e-12) << "half a turn about y, whatever the quaternion's length";
  box.throw_off({0, 5, 0});
  world.step(30);
  // 5 t - g t^2 / 2 after half a second.
  EXPECT_NEAR(box.position()[1], 2 + 2.5 - 9.81 / 8, 0.1);
  EXPECT_EQ(error_of([&] { floor.throw_off({0, 1, 0}); }), "obstacle 1 has no mass: it cannot be thrown");
  EXPECT_EQ(error_of([&] { floor.grab(); }), "obstacle 1 has no mass: it cannot be grabbed");
  EXPECT_EQ(error_of([&] {
              box.move_to({0, 0, 0}, Turn{0, 0, 0, 0});
            }),
            "turn is 0; must be of another length");
  World::Hand hand = box.grab();
  hand.move_to({-6, 3, 0});
  world.step(300);
  EXPECT_NEAR(box.position()[1], 3, 0.5) << "it hangs from the hand";
}

}  // namespace
}  // namespace weft
