// What nothing holds keeps its momentum and its angular momentum (Newton's third law), at the tolerance that
// steps have by default: what a solve leaves of its residual is no force.
#include <gtest/gtest.h>

#include "bodies.h"
#include "cloth/world/simulation.h"
#include "fixtures.h"

namespace weft::test {
namespace {

struct Momentum {
  Vec3 linear{0, 0, 0}, angular{0, 0, 0};  ///< N s; N m s, about the origin
};

/// Of the cloth and of what flies. A ball's own turning nobody sees.
Momentum momentum(const Simulation<float>& simulation) {
  Momentum sum;
  const auto add = [&](double mass, const Vec3& place, const Vec3& velocity) {
    sum.linear += mass * velocity;
    sum.angular += place.cross(mass * velocity);
  };
  const Particles<float>& sheet = simulation.cloths()[0].particles();
  each_node(sheet.grid(), [&](int r, int c) {
    add(double(sheet.mass.at(r, c)), sheet.position_at(r, c), sheet.velocity_at(r, c));
  });
  for (const Ball& ball : simulation.colliders().balls()) add(ball.mass, ball.position, ball.velocity);
  for (const Obstacle& body : simulation.colliders().obstacles()) {
    add(body.body->mass(), body.pose.position, body.body->velocity());
    sum.angular += body.body->angular_momentum();
  }
  return sum;
}

/// A sheet of 2 m and 0.8 kg in the plane y = 0, far from everything.
SimulationDescription free_sheet(int level, const IntegratorDescription& integrator) {
  SimulationDescription scene;
  ClothDescription sheet;
  sheet.orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  sheet.min_level = sheet.initial_level = sheet.max_level = level;
  sheet.material.density = 0.2;
  scene.cloths = {sheet};
  scene.integrator = integrator;
  return scene;
}

class FreeMomentum : public ::testing::TestWithParam<IntegratorDescription> {};
INSTANTIATE_TEST_SUITE_P(Implicit, FreeMomentum,
                         ::testing::Values(BackwardEulerDescription{}, Bdf2Description{}),
                         [](const auto& test) {
                           return std::visit([](const auto& d) { return std::string(d.kName); }, test.param);
                         });

}  // namespace

// 1 kg comes with 6 m/s, 0.35 m beside the sheet's middle, and takes most of it along within a second. The
// angular momentum is told by a lever of 1 m.
TEST_P(FreeMomentum, OfASheetAndWhatHitsIt) {
  for (const int level : {4, 5}) {
    for (const bool box : {false, true}) {
      SimulationDescription scene = free_sheet(level, GetParam());
      const Vec3 place(0.35, 0.23, 0), velocity(0, -6, 0);
      if (box) {
        scene.obstacles = {flying(BoxDescription{{0.4, 0.4, 0.4}}, place, velocity)};
      } else {
        scene.balls = {flying_ball(place, 0.2, velocity)};
      }
      Simulation<float> simulation(scene);
      const Momentum before = momentum(simulation);
      for (int step = 0; step < 60; ++step) {
        simulation.step();
        const Momentum now = momentum(simulation);
        ASSERT_LT((now.linear - before.linear).norm(), 1e-4 * 6) << level << " " << box << " step " << step;
        ASSERT_LT((now.angular - before.angular).norm(), 0.01 * 6) << level << " " << box << " step " << step;
      }
    }
  }
}

// A sheet that shears easily folds round a ball of five times its mass, and its layers meet behind it.
TEST_P(FreeMomentum, OfASheetThatFoldsRoundABall) {
  for (const int level : {4, 5}) {
    SimulationDescription scene = free_sheet(level, GetParam());
    scene.time_step = level == 4 ? 1.0 / 60 : 1.0 / 30;
    scene.sleep_speed = 0;
    scene.cloths[0].size = {1, 1};
    scene.cloths[0].material.structural = 2000;
    scene.cloths[0].material.shear = 5;
    scene.cloths[0].material.bending = 0;
    scene.effects = {StrainLimitEffect{}, ClothContactEffect{}};
    scene.balls = {flying_ball({0.04, 0.3, 0.05}, 0.12, {0, -8, 0})};
    Simulation<float> simulation(scene);
    const Momentum before = momentum(simulation);
    for (double time = 0; time < 0.8; time += scene.time_step) simulation.step();
    ASSERT_LT((momentum(simulation).linear - before.linear).norm(), 1e-4 * 8) << level;
  }
}

// Folded by its own motion, it goes on turning.
TEST_P(FreeMomentum, OfASheetThatTumbles) {
  Simulation<float> simulation(free_sheet(4, GetParam()));
  Particles<float>& sheet = simulation.cloths()[0].particles();
  each_node(sheet.grid(), [&](int r, int c) {
    const Vec3 at = sheet.position_at(r, c);
    const Vec3 velocity = Vec3(1, 0, 0) + Vec3(2, 1, 0.5).cross(at) + Vec3(0, std::sin(4 * at.x()), 0);
    set(sheet.velocity, r, c, velocity);
  });
  const Momentum before = momentum(simulation);
  for (int step = 0; step < 600; ++step) simulation.step();
  const Momentum after = momentum(simulation);
  EXPECT_LT((after.linear - before.linear).norm(), 1e-4 * before.linear.norm());
  EXPECT_LT((after.angular - before.angular).norm(), 1e-2 * before.angular.norm());
}

}  // namespace weft::test
