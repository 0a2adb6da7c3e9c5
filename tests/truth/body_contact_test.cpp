// Balls and bodies that meet the floor, obstacles and each other: Coulomb and Newton by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bodies.h"
#include "meshes.h"

namespace weft::test {
namespace {

constexpr double kGravity = 9.81;
constexpr double kPi = std::numbers::pi;

/// The same box in the three ways in which there are boxes.
std::vector<decltype(ObstacleDescription::shape)> boxes(const Vec3& size) {
  return {BoxDescription{size}, solid_of(box_mesh(size / 2), true), solid_of(box_mesh(size / 2), false)};
}

// --- Rest ---

TEST(BodyContact, ABallThatFallsOnTheFloorRestsAtItsRadius) {
  Bodies bodies({flying_ball({0, 2, 0}, 0.3)}, {ground()});
  bodies.run(0.5);
  EXPECT_GT(bodies.ball(0).position.y(), 0.3);  // it takes sqrt(2 * 1.7 / g) = 0.59 s
  bodies.run(1.5);
  EXPECT_NEAR(bodies.ball(0).position.y(), 0.3, 1e-9);
  EXPECT_LT(bodies.ball(0).velocity.norm(), 1e-9);
}

TEST(BodyContact, ABallRestsOnABoxAndOnAMesh) {
  for (const auto& shape : boxes({2, 0.5, 2})) {
    Bodies bodies({flying_ball({0.1, 1, 0.2}, 0.3)}, {standing(shape, {0, -0.25, 0})});
    bodies.run(2);
    EXPECT_NEAR(bodies.ball(0).position.y(), 0.3, 1e-9) << shape.index();
    EXPECT_LT(bodies.ball(0).velocity.norm(), 1e-9);
  }
}

TEST(BodyContact, EveryShapeComesToRestOnTheFloorOnItsFlattestSide) {
  const auto rests_at = [](const auto& shape, const Quaternion& turned, double height) {
    ObstacleDescription body = flying(shape, {0, 1, 0}, {0, 0, 0}, 0.5);
    std::visit(
        [&](auto& s) {
          if constexpr (requires { s.orientation; }) s.orientation = turned;
        },
        body.shape);
    Bodies bodies({}, {ground(0.5), body});
    bodies.run(4);
    EXPECT_NEAR(bodies.obstacle(1).pose.position.y(), height, 1e-4) << body.shape.index();
    EXPECT_LT(bodies.obstacle(1).body->velocity().norm(), 1e-4);
  };
  const Quaternion tilted(Eigen::AngleAxisd(0.6, Vec3(0.2, 0.3, 1).normalized()));
  for (const auto& shape : boxes({0.6, 0.1, 0.5})) {
    std::visit([&](const auto& s) { rests_at(s, tilted, 0.05); }, shape);
  }
  rests_at(CapsuleDescription{0.1, 0.6}, Quaternion(Eigen::AngleAxisd(1.2, Vec3::UnitZ())), 0.1);
}

TEST(BodyContact, AStackOfTwoBoxesStaysStill) {
  for (const auto& shape : boxes({0.4, 0.4, 0.4})) {
    Bodies bodies({}, {ground(0.5), flying(shape, {0, 0.2, 0}, {0, 0, 0}, 0.5),
                       flying(shape, {0, 0.6, 0}, {0, 0, 0}, 0.5)});
    bodies.run(5);
    for (const int i : {1, 2}) {
      const Obstacle& box = bodies.obstacle(static_cast<std::size_t>(i));
      EXPECT_LT((box.pose.position - Vec3(0, 0.4 * i - 0.2, 0)).norm(), 1e-5) << shape.index() << " " << i;
      EXPECT_LT(box.pose.orientation.angularDistance(Quaternion::Identity()), 1e-5);
    }
  }
}

TEST(BodyContact, APlankLiesAcrossTwoBeams) {
  // Its edges cross theirs: none of its corners is over one.
  Bodies bodies({},
                {standing(BoxDescription{{0.1, 0.2, 2}}, {-0.5, 0, 0}, 0.5),
                 standing(CapsuleDescription{0.1, 2, Quaternion(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX()))},
                          {0.5, 0, 0}, 0.5),
                 flying(BoxDescription{{2, 0.1, 0.3}}, {0.1, 0.3, 0}, {0, 0, 0}, 0.5)});
  bodies.run(3);
  EXPECT_NEAR(bodies.obstacle(2).pose.position.y(), 0.15, 1e-3);
  EXPECT_LT(bodies.obstacle(2).body->velocity().norm(), 1e-4);
}

// --- Friction ---

TEST(BodyContact, ABoxThatSlidesStopsAfterVSquaredOver2MuG) {
  // In steps of h the friction of the first counts whole, so the way is v h mu g / 2 g mu = v h / 2 shorter.
  for (const auto& shape : boxes({0.4, 0.2, 0.4})) {
    const double mu = 0.3, v = 3;
    Bodies bodies({}, {ground(mu), flying(shape, {0, 0.1, 0}, {v, 0, 0}, mu)});
    bodies.run(2);
    const double way = v * v / (2 * mu * kGravity);
    EXPECT_NEAR(bodies.obstacle(1).pose.position.x(), way - v * bodies.dt / 2, 1e-3) << shape.index();
    EXPECT_LT(bodies.obstacle(1).body->velocity().norm(), 1e-9);
  }
}

TEST(BodyContact, FrictionIsTheGeometricMeanOfTheTwo) {
  Bodies bodies({}, {ground(0.2), flying(BoxDescription{{0.4, 0.2, 0.4}}, {0, 0.1, 0}, {3, 0, 0}, 0.8)});
  bodies.run(0.5);
  EXPECT_NEAR(bodies.obstacle(1).body->velocity().x(), 3 - 0.4 * kGravity * 0.5, 1e-6);
}

TEST(BodyContact, ABoxOnASlopeOf20DegreesSticksOrSlides) {
  const double angle = kPi / 9, slope = std::tan(angle);
  const Quaternion turned(Eigen::AngleAxisd(-angle, Vec3::UnitZ()));
  for (const double mu : {0.0, 0.2, 0.9 * slope, 1.1 * slope, 0.8}) {
    ObstacleDescription box =
        flying(BoxDescription{{0.4, 0.2, 0.4}, turned}, turned * Vec3(0, 0.1, 0), {0, 0, 0}, mu);
    Bodies bodies({}, {ground(mu, turned * Vec3(0, 1, 0)), box});
    bodies.run(1);
    const double speed = mu > slope ? 0 : kGravity * (std::sin(angle) - mu * std::cos(angle));
    EXPECT_LT((bodies.obstacle(1).body->velocity() - speed * (turned * Vec3(1, 0, 0))).norm(), 1e-6) << mu;
    if (mu > slope) {
      EXPECT_LT((bodies.obstacle(1).pose.position - turned * Vec3(0, 0.1, 0)).norm(), 1e-6) << mu;
    }
  }
}

TEST(BodyContact, ABallThatSlidesRollsOnAtFiveSeventhsOfItsSpeed) {
  Bodies bodies({flying_ball({0, 0.2, 0}, 0.2, {4, 0, 0}, 0.5)}, {ground(0.5)});
  bodies.run(2);
  EXPECT_NEAR(bodies.ball(0).velocity.x(), 4 * 5.0 / 7, 1e-6);
  EXPECT_NEAR(bodies.ball(0).spin.z(), -4 * 5.0 / 7 / 0.2, 1e-5);
}

TEST(BodyContact, ACapsuleThatRollsGoesOnAsFastAtAnyRate) {
  for (const double rate : {30, 60, 240}) {
    ObstacleDescription capsule = flying(CapsuleDescription{0.1, 0.6}, {0, 0.1, 0}, {2, 0, 0}, 0.8);
    std::get<CapsuleDescription>(capsule.shape).orientation = Eigen::AngleAxisd(kPi / 2, Vec3::UnitX());
    capsule.body->spin = {0, 0, -2 / 0.1};
    Bodies bodies({}, {ground(0.8), capsule});
    bodies.dt = 1 / rate;
    bodies.run(3);
    EXPECT_LT((bodies.obstacle(1).body->velocity() - Vec3(2, 0, 0)).norm(), 1e-6) << rate;
    EXPECT_NEAR(bodies.obstacle(1).pose.position.x(), 6, 1e-5) << rate;
  }
}

TEST(BodyContact, ACapsuleRollsDownASlopeByItsWeightAndInertia) {
  // a = g sin / (1 + I / (m r^2)); of a capsule I is of its cylinder and its two halves of a ball.
  const double angle = 10 * kPi / 180, radius = 0.1, length = 0.6;
  const double ball = 4.0 / 3 * kPi * std::pow(radius, 3), cylinder = kPi * radius * radius * length;
  const double inertia = (0.4 * ball + 0.5 * cylinder) / (ball + cylinder);  // by m r^2
  const Quaternion turned(Eigen::AngleAxisd(-angle, Vec3::UnitZ()));
  for (const double rate : {30, 60, 240}) {
    ObstacleDescription capsule =
        flying(CapsuleDescription{radius, length}, turned * Vec3(0, radius, 0), {0, 0, 0}, 0.8);
    std::get<CapsuleDescription>(capsule.shape).orientation = Eigen::AngleAxisd(kPi / 2, Vec3::UnitX());
    Bodies bodies({}, {ground(0.8, turned * Vec3(0, 1, 0)), capsule});
    bodies.dt = 1 / rate;
    bodies.run(2);
    const double speed = 2 * kGravity * std::sin(angle) / (1 + inertia);
    EXPECT_NEAR(bodies.obstacle(1).body->velocity().norm(), speed, 1e-3 * speed) << rate;
  }
}

// --- Impacts ---

TEST(BodyContact, TwoEqualBallsThatMeetHeadOnShareTheirMomentum) {
  for (const double other : {0.0, -1.0, 1.0}) {
    Bodies bodies({flying_ball({-0.5, 0, 0}, 0.1, {3, 0, 0}), flying_ball({0.5, 0, 0}, 0.1, {other, 0, 0})},
                  {});
    bodies.gravity.setZero();
    bodies.run(1);
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      EXPECT_LT((bodies.ball(i).velocity - Vec3((3 + other) / 2, 0, 0)).norm(), 1e-9) << other;
    }
    EXPECT_NEAR((bodies.ball(1).position - bodies.ball(0).position).norm(), 0.2, 1e-9);
  }
}

TEST(BodyContact, AHitBesideItsCentreTurnsABoxAndKeepsBothMomenta) {
  // No friction: the ball hits along x at z = 0.3 of a box 1 m long; J = v / (1/m + 1/M + r^2 / I).
  BallDescription ball = flying_ball({-1, 0, 0.3}, 0.1, {5, 0, 0});
  ball.mass = 0.5;
  Bodies bodies({ball}, {flying(BoxDescription{{0.2, 0.2, 1}}, {0, 0, 0}, {0, 0, 0}, 0, 2)});
  bodies.gravity.setZero();
  bodies.dt = 1.0 / 2000;
  bodies.run(0.165);  // they meet after 0.8 m
  const double inertia = 2 * (0.2 * 0.2 + 1) / 12, impulse = 5 / (1 / 0.5 + 1 / 2.0 + 0.3 * 0.3 / inertia);
  EXPECT_NEAR(bodies.ball(0).velocity.x(), 5 - impulse / 0.5, 1e-2);
  EXPECT_NEAR(bodies.obstacle(0).body->velocity().x(), impulse / 2, 1e-2);
  EXPECT_NEAR(bodies.obstacle(0).body->angular_momentum().y(), 0.3 * impulse, 1e-2);
  const Vec3 momentum = 0.5 * bodies.ball(0).velocity + 2 * bodies.obstacle(0).body->velocity();
  EXPECT_LT((momentum - Vec3(2.5, 0, 0)).norm(), 1e-9);
}

TEST(BodyContact, AFastBallPassesNeitherAFloorNorAThinPlate) {
  for (const Vec3& velocity : {Vec3(0, -200, 0), Vec3(30, -200, 10), Vec3(0, -1e4, 0)}) {
    for (const bool plate : {false, true}) {
      for (int i = 0; i < 10; ++i) {
        const Vec3 start = Vec3(0, 5 + 0.3 * i, 0);
        const ObstacleDescription floor =
            plate ? standing(BoxDescription{{40, 0.02, 40}}, {0, -0.01, 0}) : ground();
        Bodies bodies({flying_ball(start, 0.1, velocity)}, {floor});
        for (int step = 0; step < 20; ++step) {
          bodies.step();
          ASSERT_GT(bodies.ball(0).position.y(), 0.1 - 1e-6) << velocity.transpose() << plate << i;
        }
        EXPECT_NEAR(bodies.ball(0).position.y(), 0.1, 1e-3);
      }
    }
  }
}

TEST(BodyContact, AFastBodyDoesNotPassAThinPlate) {
  for (const auto& shape : boxes({0.3, 0.2, 0.4})) {
    Bodies bodies({}, {standing(BoxDescription{{40, 0.02, 40}}, {0, -0.01, 0}),
                       flying(shape, {0, 5, 0}, {3, -200, 1})});
    for (int step = 0; step < 60; ++step) {
      bodies.step();
      ASSERT_GT(bodies.obstacle(1).pose.position.y(), 0.05) << shape.index();
    }
  }
}

TEST(BodyContact, AFastBallThatMissesGoesOnUntouched) {
  // It passes 1 mm beside a ball, and within its margin.
  Bodies bodies({flying_ball({-3, 0, 0}, 0.1, {200, 0, 0})},
                {standing(CapsuleDescription{0.1, 2}, {0, 0, 0.201})});
  bodies.gravity.setZero();
  bodies.run(0.1);
  EXPECT_EQ(bodies.ball(0).velocity, Vec3(200, 0, 0));
}

// --- Energy ---

TEST(BodyContact, EnergyNeverRisesInAPileThatFalls) {
  std::vector<ObstacleDescription> all{ground(0.4)};
  std::vector<BallDescription> balls;
  for (int i = 0; i < 10; ++i) {
    const Vec3 place(0.05 * (i % 3), 0.5 + 0.45 * i, 0.04 * (i % 2));
    const Quaternion turned(Eigen::AngleAxisd(0.7 * i, Vec3(1, 0.3 * i, 0.5).normalized()));
    if (i % 3 == 0) balls.push_back(flying_ball(place, 0.2, {0, 0, 0}, 0.4));
    if (i % 3 == 1) all.push_back(flying(BoxDescription{{0.3, 0.3, 0.4}, turned}, place, {0, 0, 0}, 0.4));
    if (i % 3 == 2) all.push_back(flying(CapsuleDescription{0.1, 0.4, turned}, place, {0, 0, 0}, 0.4));
  }
  Bodies bodies(balls, all);
  double last = bodies.energy(), most = 0;
  const double begin = last;
  for (int step = 0; step < 600; ++step) {
    bodies.step();
    most = std::max(most, bodies.energy() - last);
    last = bodies.energy();
  }
  EXPECT_LT(most, 1e-3);  // J: what overlaps is lifted out, 0.1 mm of a body of 1 kg
  EXPECT_LT(last, 0.2 * begin);
}

}  // namespace
}  // namespace weft::test
