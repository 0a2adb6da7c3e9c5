// Bodies at rest sleep with the cloth, the balls and the bodies that they touch, and wake with them.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numbers>

#include "bodies.h"
#include "busy_scene.h"
#include "cloth/sleep/islands.h"
#include "cloth/world/state_hash.h"
#include "faults.h"

namespace weft {
namespace {

using test::flying;
using test::flying_ball;
using test::ground;
using test::run;
using test::standing;

// --- Islands ---

Sleeper at(double x, bool quiet) { return {{Vec3(x, 0, 0), Vec3(x + 1, 1, 1)}, quiet}; }

TEST(Islands, AreJoinedByBoxesThatOverlapAndKeptAwakeByOne) {
  // 0 - 2 - 4 in a row, whatever their order; 1 beside them; 3 is over them, not next to them.
  std::vector<Sleeper> sleepers{at(0, true), at(9, true), at(0.9, true), at(0.9, false), at(1.8, false)};
  sleepers[3].box.translate(Vec3(0, 1.5, 0));
  EXPECT_EQ(islands_at_rest(sleepers), (std::vector<bool>{false, true, false, false, false}));
  sleepers[4].quiet = true;
  EXPECT_EQ(islands_at_rest(sleepers), (std::vector<bool>{true, true, true, false, true}));
}

TEST(Islands, AHalfSpaceThatMovesKeepsAllAwakeAndWhatIsNowhereNobody) {
  const double infinite = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Sleeper> sleepers{at(0, true), {{Vec3(nan, 0, 0), Vec3(nan, 1, 1)}, false}, at(5, true)};
  EXPECT_EQ(islands_at_rest(sleepers), (std::vector<bool>{true, false, true}));
  sleepers.push_back({{Vec3::Constant(-infinite), Vec3::Constant(infinite)}, false});
  EXPECT_EQ(islands_at_rest(sleepers), (std::vector<bool>{false, false, false, false}));
}

/// After kQuietSteps steps in each of which it goes, m, and turns, rad, so far.
bool quiet_after(const Vec3& going, double turning) {
  BodyRest rest;
  for (int step = 0; step < kQuietSteps; ++step) {
    const Quaternion turned(Eigen::AngleAxisd(turning * step, Vec3::UnitZ()));
    rest.stepped({going * step, turned}, 0.5, 1e-4);
  }
  return rest.quiet();
}

TEST(BodyRest, IsHowFarItsPointsGet) {
  // 59 steps from the first to the last: within 1e-4 m at 1.6e-6 m a step, 0.5 m from the centre at twice
  // that in rad.
  EXPECT_TRUE(quiet_after({0, 0, 0}, 0));
  EXPECT_TRUE(quiet_after({1.6e-6, 0, 0}, 0));
  EXPECT_FALSE(quiet_after({1.8e-6, 0, 0}, 0));
  EXPECT_TRUE(quiet_after({0, 0, 0}, 3.2e-6));
  EXPECT_FALSE(quiet_after({0, 0, 0}, 3.6e-6));
}

// --- In a simulation ---

/// A sheet on the floor, on it a box, on the box a ball's worth of another; far off a box by itself.
SimulationDescription lying_scene() {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {1, 1};
  cloth.position = {0, 0.002, 0};
  cloth.orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  cloth.min_level = cloth.initial_level = 3;
  cloth.max_level = 4;
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{}, DampingEffect{}, AerodynamicsEffect{}};
  BallDescription prop;  // held, against the box's side
  prop.position = {0.25, 0.1, 0};
  prop.radius = 0.1;
  scene.balls = {prop};
  scene.obstacles = {ground(0.5), flying(BoxDescription{{0.3, 0.2, 0.3}}, {0, 0.105, 0}, {0, 0, 0}, 0.5),
                     flying(BoxDescription{{0.2, 0.2, 0.2}}, {0, 0.306, 0}, {0, 0, 0}, 0.5),
                     flying(BoxDescription{{0.2, 0.2, 0.2}}, {5, 0.1, 0}, {0, 0, 0}, 0.5),
                     standing(BoxDescription{{0.2, 0.2, 0.2}}, {0, 3, 0})};
  return scene;
}
constexpr std::size_t kLower = 1, kUpper = 2, kFar = 3, kWall = 4;  // obstacles

bool asleep(const Simulation<float>& simulation, std::size_t obstacle) {
  return simulation.colliders().obstacles()[obstacle].rest.asleep();
}

Simulation<float> sleeping(const SimulationDescription& scene) {
  Simulation<float> simulation(scene);
  const auto all_sleep = [&] {
    return simulation.cloths()[0].asleep() && asleep(simulation, kLower) && asleep(simulation, kUpper) &&
           asleep(simulation, kFar);
  };
  for (int step = 0; step < 1200 && !all_sleep(); ++step) simulation.step();
  EXPECT_TRUE(all_sleep()) << "after 20 s";
  return simulation;
}

TEST(BodySleepSlow, BeginsTogetherAndKeepsAllBits) {
  for (const IntegratorDescription& integrator : test::default_integrators()) {
    SCOPED_TRACE(test::name_of(integrator));
    SimulationDescription scene = lying_scene();
    scene.integrator = integrator;
    Simulation<float> simulation = sleeping(scene);
    const auto sheet = simulation.cloths()[0].particles();
    std::vector<Pose> poses;
    for (const Obstacle& obstacle : simulation.colliders().obstacles()) poses.push_back(obstacle.pose);
    run(simulation, 1000);
    EXPECT_TRUE(test::same_state(simulation.cloths()[0].particles(), sheet));
    for (const std::size_t i : {kLower, kUpper, kFar}) {
      const Obstacle& body = simulation.colliders().obstacles()[i];
      EXPECT_TRUE(body.rest.asleep()) << i;
      EXPECT_EQ(body.pose.position, poses[i].position) << i;
      EXPECT_EQ(body.pose.orientation.coeffs(), poses[i].orientation.coeffs()) << i;
      EXPECT_EQ(body.body->velocity(), Vec3(0, 0, 0)) << i;
      EXPECT_EQ(body.body->angular_momentum(), Vec3(0, 0, 0)) << i;
    }
    EXPECT_EQ(simulation.last_advance(0).substeps, 0);
    EXPECT_FALSE(simulation.colliders().may_meet());
  }
}

TEST(BodySleepSlow, NoneWhereTheClothUnderTheBodyMovesOrTheSpeedIsZero) {
  SimulationDescription scene = lying_scene();
  scene.sleep_speed = 0;
  Simulation<float> awake(scene);
  run(awake, 300);
  EXPECT_FALSE(asleep(awake, kFar));
  scene = lying_scene();
  scene.wind = {{1, 0, 0}, 1};
  scene.wind.gusts = {0.3, 1.0};  // in which no cloth sleeps
  Simulation<float> gusty(scene);
  run(gusty, 600);
  EXPECT_TRUE(asleep(gusty, kFar));
  EXPECT_FALSE(asleep(gusty, kLower));
  EXPECT_FALSE(asleep(gusty, kUpper));
}

TEST(BodySleep, TwoSimulationsAndAResetFallAsleepAndWakeWithTheSameBits) {
  const auto hash_after = [](Simulation<float>& simulation) {
    run(simulation, 400);
    EXPECT_TRUE(simulation.throw_obstacle(kUpper, {1, 2, 0}, {0, 0, 3}));
    run(simulation, 60);
    return state_hash(simulation);
  };
  Simulation<float> first(lying_scene()), second(lying_scene());
  const std::uint64_t hash = hash_after(first);
  EXPECT_EQ(hash_after(second), hash);
  first.reset();
  EXPECT_FALSE(asleep(first, kFar));
  EXPECT_EQ(hash_after(first), hash);
}

struct Cause {
  const char* name;
  std::function<void(Simulation<float>&)> happens;
  bool near = true;  ///< the pile wakes by it
  bool far = false;  ///< the box far off does
};
std::ostream& operator<<(std::ostream& out, const Cause& cause) { return out << cause.name; }
class BodyWakes : public ::testing::TestWithParam<Cause> {};

TEST_P(BodyWakes, WithAllItTouchesAndNobodyElse) {
  Simulation<float> simulation = sleeping(lying_scene());
  GetParam().happens(simulation);
  // The wind wakes the cloth in the step, which wakes the bodies in the next one.
  bool near = false, far = false;
  for (int step = 0; step < 3; ++step) {
    simulation.step();
    near = near || !asleep(simulation, kLower);
    far = far || !asleep(simulation, kFar);
    EXPECT_EQ(asleep(simulation, kLower), asleep(simulation, kUpper)) << "step " << step;
  }
  EXPECT_EQ(near, GetParam().near);
  EXPECT_EQ(far, GetParam().far);
  EXPECT_EQ(simulation.cloths()[0].asleep(), !near);
}

const Cause kCauses[] = {
    {"nothing", [](auto&) {}, false},
    {"it_is_thrown",
     [](auto& s) {
       s.throw_obstacle(kUpper, {0, 1, 0}, {0, 0, 0});
     }},
    {"what_lies_under_it_is_moved",
     [](auto& s) {
       s.move_obstacle(kLower, {{0.4, 0.1, 0}, Quaternion::Identity()});
     },
     true},
    {"a_ball_is_put_next_to_it",
     [](auto& s) {
       BallDescription ball;
       ball.radius = 0.05;
       ball.position = {-0.2, 0.1, 0};
       s.add_ball(ball);
     }},
    {"a_ball_falls_on_it",
     [](auto& s) {
       s.add_ball(flying_ball({0, 0.458, 0}, 0.05));
     }},
    {"what_it_leans_on_is_removed", [](auto& s) { s.remove_ball(1); }},
    {"what_it_leans_on_is_moved",
     [](auto& s) {
       s.move_ball(1, {0.5, 0.1, 0});
     }},
    {"what_it_leans_on_is_thrown",
     [](auto& s) {
       s.throw_ball(1, {0, 0, 1});
     }},
    {"an_obstacle_comes",
     [](auto& s) {
       s.move_obstacle(kWall, {{0, 0.49, 0}, Quaternion::Identity()});
     }},
    {"an_obstacle_moves_far_from_it",
     [](auto& s) {
       s.move_obstacle(kWall, {{0, 4, 0}, Quaternion::Identity()});
     },
     false},
    {"another_body_wakes_far_from_it",
     [](auto& s) {
       s.throw_obstacle(kFar, {1, 1, 0}, {0, 0, 0});
     },
     false, true},
    {"the_floor_moves",
     [](auto& s) {
       s.move_obstacle(0, {{0, -0.01, 0}, Quaternion::Identity()});
     },
     true, true},
    {"the_cloth_is_grabbed",
     [](auto& s) {
       s.grab(0, {0, 0}, Vec3(-0.5, 0.5, 0.5), 5);
     }},
    {"the_cloth_is_pinned",
     [](auto& s) {
       s.pin(0, {0, 0});
     }},
    {"the_wind_changes",
     [](auto& s) {
       s.set_wind({{1, 0, 0}, 3});
     }},
    {"the_level_changes", [](auto& s) { s.request_level(0, 4); }},
    {"the_integrator_changes", [](auto& s) { s.set_integrator(XpbdDescription{}); }},
    {"gravity_goes", [](auto& s) { s.set_effects({DampingEffect{}}); }, true, true},
};
INSTANTIATE_TEST_SUITE_P(By, BodyWakes, ::testing::ValuesIn(kCauses),
                         [](const auto& cause) { return std::string(cause.param.name); });

TEST(BodySleep, AWokenPileGainsNothingByHavingSlept) {
  // The prop is taken away: nothing leaned on it, so that all lies where it lay.
  Simulation<float> simulation = sleeping(lying_scene());
  const Vec3 before = simulation.colliders().obstacles()[kUpper].pose.position;
  ASSERT_TRUE(simulation.remove_ball(1));
  double fastest = 0;
  for (int step = 0; step < 120; ++step) {
    simulation.step();
    fastest = std::max(fastest, simulation.colliders().obstacles()[kUpper].body->velocity().norm());
  }
  EXPECT_LT(fastest, 1e-3);
  EXPECT_LT((simulation.colliders().obstacles()[kUpper].pose.position - before).norm(), 1e-4);
}

}  // namespace
}  // namespace weft
