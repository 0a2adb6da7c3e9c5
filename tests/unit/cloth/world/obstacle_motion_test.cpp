// Obstacles that follow paths, turn, or are moved.
#include <gtest/gtest.h>

#include <numbers>

#include "cloth/contact/recovery/contact.h"
#include "cloth/core/path.h"
#include "cloth/world/simulation.h"
#include "fixtures.h"
#include "loose_contact.h"
#include "swept_sheet.h"

namespace weft {
namespace {

using std::numbers::pi;
using test::each_node;
using test::kFrame;
using test::set;

Quaternion about(const Vec3& axis, double angle) { return Quaternion(Eigen::AngleAxisd(angle, axis)); }

TEST(Path, OneThatLoopsBeginsAnewAtItsEnd) {
  const std::vector<Waypoint> path{{1, {0, 0, 0}}, {2, {4, 0, 0}}, {3, {0, 0, 0}}};
  EXPECT_EQ(along_path(path, 0.5, true), Vec3(0, 0, 0));  // at rest before the first point, as ever
  EXPECT_EQ(along_path(path, 1.5, true), Vec3(2, 0, 0));
  EXPECT_EQ(along_path(path, 3.0, true), Vec3(0, 0, 0));
  EXPECT_EQ(along_path(path, 3.25, true), Vec3(1, 0, 0));
  EXPECT_EQ(along_path(path, 2e6 + 1.75, true), Vec3(3, 0, 0));  // a million rounds later
  EXPECT_EQ(along_path(path, 3.25), Vec3(0, 0, 0));
  EXPECT_EQ(along_path(std::vector<Waypoint>{{1, {5, 0, 0}}}, 9, true), Vec3(5, 0, 0));
}

TEST(Path, PosesTurnEvenlyTheShorterWayRound) {
  const Quaternion quarter = about(Vec3::UnitY(), pi / 2);
  const std::vector<PoseWaypoint> path{{0, {{0, 0, 0}, Quaternion::Identity()}},
                                       {3, {{0, 3, 0}, Quaternion(-quarter.coeffs())}}};  // the same turn
  const Pose pose = along_path(path, 1);
  EXPECT_LT((pose.position - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT(pose.orientation.angularDistance(about(Vec3::UnitY(), pi / 6)), 1e-12);
}

ObstacleDescription bar() {
  ObstacleDescription bar;
  bar.shape = CapsuleDescription{.radius = 0.02, .length = 2, .orientation = about(Vec3::UnitZ(), pi / 2)};
  return bar;
}

TEST(Obstacles, FollowTheirPathWithItsVelocityAndSpin) {
  ObstacleDescription description = bar();
  description.position = {9, 9, 9};  // overridden
  description.path = {{0, {{0, 0, 0}, Quaternion::Identity()}},
                      {2, {{4, 0, 0}, about(Vec3::UnitY(), pi / 2)}}};
  Colliders colliders({}, {description});
  colliders.begin_step(1.0, 0.5, {0, -9.81, 0});
  const Solid& solid = colliders.solids()[0];
  EXPECT_LT((solid.start - Vec3(2, 0, 0)).norm(), 1e-15);
  EXPECT_LT((solid.position - Vec3(3, 0, 0)).norm(), 1e-15);
  EXPECT_LT((solid.velocity - Vec3(2, 0, 0)).norm(), 1e-14);
  EXPECT_LT((solid.spin - Vec3(0, pi / 4, 0)).norm(), 1e-12);
  // What was at its +z end at the start, 1 m from its centre, after 3/8 of a right angle about y.
  const Vec3 end = solid.placed(1).rotation * Vec3::UnitZ();
  EXPECT_LT((end - Vec3(std::sin(3 * pi / 8), 0, std::cos(3 * pi / 8))).norm(), 1e-12);
  const Vec3 begin = solid.placed(0).rotation * Vec3::UnitZ();
  EXPECT_LT((begin - Vec3(std::sin(pi / 4), 0, std::cos(pi / 4))).norm(), 1e-12);
  EXPECT_LT((solid.move_of(solid.start + begin, 0, 1) - (solid.position + end - solid.start - begin)).norm(),
            1e-12);
  colliders.end_step();
  colliders.begin_step(2.5, 0.5, {0, -9.81, 0});  // past its end
  EXPECT_EQ(colliders.solids()[0].velocity, Vec3(0, 0, 0));
  EXPECT_FALSE(colliders.solids()[0].turns());
}

TEST(Obstacles, MovedGoThereInAStepAndStay) {
  Colliders colliders({}, {bar()});
  EXPECT_FALSE(colliders.obstacles()[0].mobile);
  EXPECT_FALSE(colliders.move_obstacle(1, {}));
  EXPECT_TRUE(colliders.move_obstacle(0, {{0, 1, 0}, Quaternion(2, 0, 0, 0)}));  // from a quarter about z
  colliders.begin_step(0, 0.5, {0, 0, 0});
  EXPECT_EQ(colliders.solids()[0].velocity, Vec3(0, 2, 0));
  EXPECT_LT((colliders.solids()[0].spin - Vec3(0, 0, -pi)).norm(), 1e-12);
  colliders.end_step();
  for (int step = 1; step < 3; ++step) {
    colliders.begin_step(0.5 * step, 0.5, {0, 0, 0});
    EXPECT_EQ(colliders.solids()[0].start, Vec3(0, 1, 0));
    EXPECT_EQ(colliders.solids()[0].position, Vec3(0, 1, 0));
    EXPECT_EQ(colliders.solids()[0].velocity, Vec3(0, 0, 0));
    EXPECT_FALSE(colliders.solids()[0].turns());
    EXPECT_TRUE(colliders.solids()[0].rotation.isIdentity(1e-15));
  }
  EXPECT_TRUE(colliders.obstacles()[0].mobile);
}

// In a step that is made in parts, at one speed and spin: as in a step of one part.
TEST(Obstacles, MovedGetThereWithTheStepsLastPart) {
  Colliders colliders({}, {bar()});
  EXPECT_TRUE(colliders.move_obstacle(0, {{0, 1, 0}, Quaternion(2, 0, 0, 0)}));  // from a quarter about z
  for (int part = 0; part < 4; ++part) {
    colliders.begin_step(0.125 * part, 0.125, {0, 0, 0}, {}, 4 - part);
    EXPECT_LT((colliders.solids()[0].position - Vec3(0, 0.25 * (part + 1), 0)).norm(), 1e-12);
    EXPECT_LT((colliders.solids()[0].velocity - Vec3(0, 2, 0)).norm(), 1e-12);
    EXPECT_LT((colliders.solids()[0].spin - Vec3(0, 0, -pi)).norm(), 1e-12);
    colliders.end_step();
  }
  EXPECT_TRUE(colliders.solids()[0].rotation.isIdentity(1e-12));
  colliders.begin_step(0.5, 0.125, {0, 0, 0}, {}, 4);
  EXPECT_EQ(colliders.solids()[0].position, Vec3(0, 1, 0));
  EXPECT_FALSE(colliders.solids()[0].turns());
}

TEST(Obstacles, PlanesMoveButKeepTheirNormal) {
  ObstacleDescription wall;
  wall.shape = PlaneDescription{.normal = {1, 0, 0}};
  wall.path = {{0, {{0, 0, 0}, about(Vec3::UnitZ(), 1)}}, {1, {{-2, 0, 0}, about(Vec3::UnitZ(), 2)}}};
  Colliders colliders({}, {wall});
  colliders.begin_step(0.5, 0.25, {0, 0, 0});
  const Solid& solid = colliders.solids()[0];
  EXPECT_EQ(solid.velocity, Vec3(-2, 0, 0));
  EXPECT_FALSE(solid.turns());
  EXPECT_LT((solid.rotation.col(1) - Vec3(1, 0, 0)).norm(), 1e-15);
}

template <class Real>
class TurningSolid : public ::testing::Test {
 public:
  static constexpr double kRounding = 32 * double(std::numeric_limits<Real>::epsilon());
};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(TurningSolid, Scalars);

TYPED_TEST(TurningSolid, FrictionGivesNodesTheVelocityOfWhatTheyTouch) {
  // A table turns under a node 1 mm deep in it, 0.6 m from its axis, that falls at 1 m/s: with friction
  // enough to stop all sliding the node goes with the table.
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(9, 9, {8, 8});
  set(sheet.position, 4, 4, {0.6, 0.049, 0});
  set(sheet.velocity, 4, 4, {0, -1, 0});
  Solid table;
  table.id = kFirstObstacle;
  table.shape = Box{{1, 0.05, 1}};
  table.friction = 1e6;
  table.spin = {0, 3, 0};
  table.turn = kFrame * table.spin;
  std::vector<Solid> solids{table};
  test::LooseContact<TypeParam> contact(sheet.grid());
  EXPECT_EQ(contact.resolve(sheet, solids, {0, 1, kFrame}), 1);
  EXPECT_LT((sheet.velocity_at(4, 4) - Vec3(0, 0, -0.6 * 3)).norm(), 4 * this->kRounding);  // spin x arm
}

TYPED_TEST(TurningSolid, ABarSweepsEveryNodeInItsWay) {
  constexpr double kHalf = 1, kRadius = 0.02;
  const int swept = test::expect_swept<TypeParam>({Capsule{kHalf, kRadius}, kRadius, kHalf, kHalf + kRadius},
                                                  this->kRounding);
  EXPECT_GT(swept, 300);  // of 80/180 pi / (1.9 / 32)^2 = 396, less the thickness and the middle
}

SimulationDescription on_a_turntable(const IntegratorDescription& integrator) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {0.8, 0.8};
  cloth.position = {0, 0.001, 0};
  cloth.orientation = about(Vec3::UnitX(), -pi / 2);
  cloth.min_level = cloth.max_level = cloth.initial_level = 4;
  scene.cloths = {cloth};
  ObstacleDescription table;
  table.shape = BoxDescription{.size = {2, 0.2, 2}};
  table.friction = 0.5;
  for (int third = 0; third <= 3; ++third) {  // 2 rad/s
    table.path.push_back({third * pi / 3, {{0, -0.1, 0}, about(Vec3::UnitY(), third * 2 * pi / 3)}});
  }
  table.loop = true;
  scene.obstacles = {table};
  scene.effects = {GravityEffect{}};
  scene.integrator = integrator;
  return scene;
}

TEST(TurningTableSlow, TakesTheClothAlong) {
  // At its corners, 0.57 m out, w^2 r = 2.3 m/s2 needs less than friction's 4.9: it does not slide in the
  // end.
  for (const IntegratorDescription& integrator :
       {IntegratorDescription(Bdf2Description{}), IntegratorDescription(BackwardEulerDescription{}),
        IntegratorDescription(XpbdDescription{}), IntegratorDescription(SymplecticEulerDescription{})}) {
    Simulation<float> simulation(on_a_turntable(integrator));
    for (int step = 0; step < 240; ++step) simulation.step();
    const Particles<float>& particles = simulation.cloths()[0].particles();
    each_node(particles.grid(), [&](int r, int c) {
      const Vec3 place = particles.position_at(r, c), expected = Vec3(0, 2, 0).cross(place);
      EXPECT_LT((particles.velocity_at(r, c) - expected).norm(), 0.05 * 0.57 * 2)
          << integrator.index() << ": " << place.transpose();
    });
    EXPECT_FALSE(simulation.cloths()[0].asleep());
  }
}

TEST(SpinningBarSlow, StrikesAHungSheetWithoutHarm) {
  // Two turns a second through a sheet that hangs within its reach.
  for (const IntegratorDescription& integrator :
       {IntegratorDescription(Bdf2Description{}), IntegratorDescription(BackwardEulerDescription{}),
        IntegratorDescription(XpbdDescription{}), IntegratorDescription(SymplecticEulerDescription{})}) {
    SimulationDescription scene;
    ClothDescription cloth;
    cloth.min_level = cloth.max_level = cloth.initial_level = 4;
    cloth.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}};
    scene.cloths = {cloth};
    ObstacleDescription bar;
    bar.shape = CapsuleDescription{.radius = 0.05, .length = 1};
    for (int quarter = 0; quarter <= 4; ++quarter) {
      bar.path.push_back({quarter / 8.0, {{0, 0, 0.4}, about(Vec3::UnitX(), quarter * pi / 2)}});
    }
    bar.loop = true;
    scene.obstacles = {bar};
    scene.effects = {GravityEffect{}, AerodynamicsEffect{}};
    scene.integrator = integrator;
    Simulation<float> simulation(scene);
    int touched = 0;
    for (int step = 0; step < 240; ++step) {
      simulation.step();
      ASSERT_TRUE(simulation.healthy());
      touched += simulation.last_advance(0).nodes_in_contact;
      const PlacedShape shape = simulation.colliders().solids()[0].placed(1);
      const Particles<float>& particles = simulation.cloths()[0].particles();
      each_node(particles.grid(), [&](int r, int c) {
        ASSERT_GE(shape.surface(particles.position_at(r, c)).distance, -1e-5) << "step " << step;
      });
    }
    EXPECT_GT(touched, 0);
    EXPECT_FALSE(simulation.cloths()[0].frozen());
  }
}

}  // namespace
}  // namespace weft
