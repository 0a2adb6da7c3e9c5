// Pins with a stiffness: what hangs on them, how it swings, at every level, by every method; and pins in
// time.
#include "cloth/forces/soft_pins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bodies.h"
#include "cloth/contact/constraints/body_spring.h"
#include "cloth/world/simulation.h"
#include "cloth/world/state.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;

/// A sheet of 1 m x 1 m and 0.1 kg.
SimulationDescription softly_pinned(const IntegratorDescription& integrator, const PinRegion& pin) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {1, 1};
  cloth.min_level = 3;
  cloth.max_level = 5;
  cloth.initial_level = 4;
  cloth.pins = {pin};
  scene.cloths = {cloth};
  scene.integrator = integrator;
  scene.sleep_speed = 0;
  return scene;
}

/// Of all nodes, by mass, m.
template <class Real>
Vec3 mass_centre(const Particles<Real>& particles) {
  Vec3 sum(0, 0, 0);
  double mass = 0;
  each_node(particles.grid(), [&](int r, int c) {
    sum += double(particles.mass.at(r, c)) * particles.position_at(r, c);
    mass += double(particles.mass.at(r, c));
  });
  return sum / mass;
}

/// Of the nodes of the top edge, by mass, m.
template <class Real>
Vec3 top_centre(const Particles<Real>& particles) {
  Vec3 sum(0, 0, 0);
  double mass = 0;
  for (int c = 0; c < particles.grid().cols; ++c) {
    sum += double(particles.mass.at(0, c)) * particles.position_at(0, c);
    mass += double(particles.mass.at(0, c));
  }
  return sum / mass;
}

class SoftPinsOf : public ::testing::TestWithParam<IntegratorDescription> {};
INSTANTIATE_TEST_SUITE_P(Integrators, SoftPinsOf,
                         ::testing::Values(SymplecticEulerDescription{}, BackwardEulerDescription{},
                                           Bdf2Description{}, XpbdDescription{}),
                         [](const auto& test) {
                           return std::visit([](const auto& d) { return std::string(d.kName); }, test.param);
                         });

// In all it is the region's, and each node has what its force changes by along its way.
TEST(SoftPinsStiffness, IsWhatTheirForceChangesByAlongAWay) {
  SimulationDescription scene = softly_pinned(Bdf2Description{}, {.u_max = 1, .stiffness = 20});
  Simulation<double> simulation(scene);
  Particles<double> particles = simulation.cloths()[0].particles();
  const SoftPins<double> pins(scene.cloths[0].pins, 0, particles, nullptr);
  VectorField<double> before(particles.grid()), after(particles.grid());
  pins.add_forces(particles, {}, before);
  Field<double> stiffness(particles.grid());
  pins.add_stiffness(particles, {}, stiffness.row(0));
  each_node(particles.grid(), [&](int r, int c) { particles.position.y.at(r, c) += 0.1; });
  pins.add_forces(particles, {}, after);
  double sum = 0;
  each_node(particles.grid(), [&](int r, int c) {
    EXPECT_NEAR(before.y.at(r, c) - after.y.at(r, c), 0.1 * stiffness.at(r, c), 1e-12);
    sum += stiffness.at(r, c);
  });
  EXPECT_NEAR(sum, 20, 1e-12);
}

// 0.1 kg hang on 20 N/m: 0.1 * 9.81 / 20 = 49.05 mm below where the edge began. A change of level keeps it.
TEST_P(SoftPinsOf, HoldAWeightAtForceOverStiffness) {
  SimulationDescription scene = softly_pinned(GetParam(), {.u_max = 1, .stiffness = 20});
  scene.cloths[0].material.damping = 1;
  scene.effects = {GravityEffect{}, DampingEffect{}};
  Simulation<double> simulation(scene);
  const auto sag = [&] { return 0.5 - top_centre(simulation.cloths()[0].particles()).y(); };
  for (int step = 0; step < 300; ++step) simulation.step();
  EXPECT_NEAR(sag(), 0.04905, 1e-4);
  for (const int level : {5, 3, 4}) {
    simulation.request_level(0, level);
    for (int step = 0; step < 120; ++step) simulation.step();
    EXPECT_NEAR(sag(), 0.04905, 2e-4) << level;
  }
}

// All nodes are drawn, in proportion to their masses, and begin with the same velocity: the sheet swings as
// one body, with the period 2 pi sqrt(0.1 kg / 4 N/m) = 0.99346 s, and is back at its place after half of it.
TEST_P(SoftPinsOf, SwingWithTheirPeriod) {
  SimulationDescription scene = softly_pinned(GetParam(), {.u_max = 1, .v_max = 1, .stiffness = 4});
  scene.cloths[0].velocity = {0, 0, 0.5};
  scene.time_step = 1e-3;
  Simulation<double> simulation(scene);
  double crossing = 0, before = 0;
  for (int step = 1; step <= 700 && crossing == 0; ++step) {
    simulation.step();
    const double z = mass_centre(simulation.cloths()[0].particles()).z();
    if (before > 0 && z <= 0) crossing = 1e-3 * (step - 1 + before / (before - z));
    before = z;
  }
  EXPECT_NEAR(crossing, std::numbers::pi * std::sqrt(0.1 / 4), 2e-3);
}

// The place moves by 0.3 m in the first half second; the sheet comes to rest there.
TEST_P(SoftPinsOf, FollowTheirPath) {
  SimulationDescription scene = softly_pinned(
      GetParam(), {.u_max = 1, .v_max = 1, .path = {{0, {0, 0, 0}}, {0.5, {0.3, 0, 0}}}, .stiffness = 10});
  scene.cloths[0].material.damping = 2;
  scene.effects = {DampingEffect{}};
  Simulation<double> simulation(scene);
  for (int step = 0; step < 240; ++step) simulation.step();
  EXPECT_LT((mass_centre(simulation.cloths()[0].particles()) - Vec3(0.3, 0, 0)).norm(), 1e-3);
}

// Held by the upper left corner from 0.5 s on, and let go of at 1 s: it falls from the start, is where it was
// at 0.5 s until 1 s, and falls again.
TEST_P(SoftPinsOf, PinsHoldFromOneTimeUntilAnother) {
  SimulationDescription scene = softly_pinned(GetParam(), {.u_max = 1, .from = 0.5, .until = 1});
  scene.effects = {GravityEffect{}};
  Simulation<double> simulation(scene);
  const auto corner = [&] { return simulation.cloths()[0].particles().position_at(0, 0); };
  for (int step = 0; step < 30; ++step) simulation.step();
  const Vec3 held = corner();
  EXPECT_NEAR(held.y(), 0.5 - 9.81 * 0.25 / 2, 0.05);  // g t^2 / 2, and what steps of 1/60 s add
  for (int step = 0; step < 30; ++step) {
    simulation.step();
    EXPECT_EQ(corner(), held) << step;
  }
  for (int step = 0; step < 30; ++step) simulation.step();
  EXPECT_LT(corner().y(), held.y() - 0.5);
}

// A state that is saved while soft pins hold, and before one begins to, goes on to the bit.
TEST_P(SoftPinsOf, GoOnFromASavedState) {
  SimulationDescription scene = softly_pinned(GetParam(), {.u_max = 1, .stiffness = 20});
  scene.cloths[0].pins.push_back({.u_max = 1, .v_min = 1, .v_max = 1, .from = 0.4, .until = 0.6});
  scene.effects = {GravityEffect{}};
  Simulation<float> simulation(scene), other(scene);
  for (int step = 0; step < 20; ++step) simulation.step();
  load_state(other, save_state(simulation));
  for (int step = 0; step < 30; ++step) {
    simulation.step();
    other.step();
  }
  EXPECT_EQ(save_state(simulation), save_state(other));
}

// 0.2 kg hang on 20 N/m from the lower edge of a sheet that is held by the upper one: on the mean of many
// swings the pin is stretched by 0.2 * 9.81 / 20 = 98.1 mm, but for 0.2 kg * 1 m/s over the time, 0.01 N or
// 0.5 mm, at either end.
TEST_P(SoftPinsOf, HoldABall) {
  SimulationDescription scene = softly_pinned(GetParam(), {.u_max = 1});
  scene.cloths[0].pins.push_back(
      {.u_min = 0.5, .u_max = 0.5, .v_min = 1, .v_max = 1, .ball = 0, .stiffness = 20});
  scene.cloths[0].initial_level = 3;
  scene.balls = {test::flying_ball({0, -0.6, 0}, 0.05)};
  scene.balls[0].mass = 0.2;
  scene.effects = {GravityEffect{}, DampingEffect{}};
  Simulation<double> simulation(scene);
  double sum = 0;
  constexpr int kSteps = 1200;
  for (int step = 0; step < kSteps; ++step) {
    simulation.step();
    const double node = simulation.cloths()[0].particles().position_at(8, 4).y();
    sum += node - (simulation.colliders().balls()[0].position.y() + 0.1);
  }
  EXPECT_NEAR(sum / kSteps, 0.0981, 1e-3);
}

// A ball of 1 kg on 200 N/m hangs 49 mm below its pin's places, which are what they are: however often the
// level changes, it hangs at the end where it hangs without a change, but for some mm that it still swings.
TEST_P(SoftPinsOf, KeepTheirPlacesThroughChangesOfLevel) {
  SimulationDescription scene = softly_pinned(GetParam(), {.v_max = 1});
  ClothDescription& cloth = scene.cloths[0];
  cloth.orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  cloth.material.damping = 1;
  cloth.pins.push_back({.u_min = 1, .u_max = 1, .v_max = 1});
  cloth.pins.push_back({.u_min = 0.4, .u_max = 0.6, .v_min = 0.4, .v_max = 0.6, .ball = 0, .stiffness = 200});
  scene.balls = {test::flying_ball({0, -0.5, 0}, 0.05)};
  scene.balls[0].mass = 1;
  scene.effects = {GravityEffect{}, DampingEffect{}};
  const auto height = [&](bool changing) {
    Simulation<double> simulation(scene);
    for (int step = 0; step < 600; ++step) {
      if (changing && step % 15 == 0) simulation.request_level(0, step % 30 == 0 ? 3 : 5);
      if (step == 450) simulation.request_level(0, 4);
      simulation.step();
      if (step >= 450) changing = false;
    }
    double sum = 0;
    for (int step = 0; step < 600; ++step) {
      simulation.step();
      sum += simulation.colliders().balls()[0].position.y();
    }
    return sum / 600;
  };
  EXPECT_NEAR(height(true), height(false), 0.01);
}

// In free space a body of 0.5 kg is drawn to a sheet of 0.1 kg by a point beside its centre: their momentum,
// 0.5 kg at 1 m/s, and their angular momentum about the origin, (0.1, 0, 0.3) x (0, 0, 0.5), stay, but for
// the force of a step at either end, which the two get a step apart. A cube of 0.2 m has the inertia 0.5
// (0.2^2 + 0.2^2) / 12.
TEST_P(SoftPinsOf, KeepTheMomentumOfBodyAndCloth) {
  SimulationDescription scene = softly_pinned(
      GetParam(), {.u_min = 0.5, .u_max = 0.5, .v_min = 0.5, .v_max = 0.5, .obstacle = 0, .stiffness = 5});
  ObstacleDescription box;
  box.shape = BoxDescription{{0.2, 0.2, 0.2}};
  box.position = {0.1, 0, 0.3};
  box.body = BodyDescription{.mass = 0.5, .velocity = {0, 0, 1}};
  scene.obstacles = {box};
  Simulation<double> simulation(scene);
  double most = 0;  // N
  for (int step = 0; step < 300; ++step) {
    const Vec3 before = simulation.colliders().obstacles()[0].body->velocity();
    simulation.step();
    const Obstacle& body = simulation.colliders().obstacles()[0];
    const Vec3 velocity = body.body->velocity(), place = body.pose.position;
    most = std::max(most, 0.5 * 60 * (velocity - before).norm());
    const Particles<double>& particles = simulation.cloths()[0].particles();
    Vec3 momentum = 0.5 * velocity;
    Vec3 angular = place.cross(momentum) + 0.5 * 0.08 / 12 * body.body->spin(body.pose.orientation);
    each_node(particles.grid(), [&](int r, int c) {
      const Vec3 of_node = particles.mass.at(r, c) * particles.velocity_at(r, c);
      momentum += of_node;
      angular += particles.position_at(r, c).cross(of_node);
    });
    const double impulse = 2 * most / 60 + 1e-9;
    EXPECT_LT((momentum - Vec3(0, 0, 0.5)).norm(), impulse) << step;
    EXPECT_LT((angular - Vec3(0, -0.05, 0)).norm(), impulse * (place.norm() + 1)) << step;
  }
  EXPECT_GT(most, 0.1);
}

// XPBD takes them implicitly. 0.1 kg hang on an edge or on one node, which has 0.2 g of them at level 4:
// however stiff, at 60 Hz, what it draws at rest is the weight, 0.1 * 9.81 / k.
TEST(SoftPins, OfAnyStiffnessHoldAWeightWithXpbd) {
  for (const PinRegion& region : {PinRegion{.u_max = 1}, PinRegion{.u_min = 0.5, .u_max = 0.5}}) {
    for (const double stiffness : {1e2, 1e4, 1e6}) {
      PinRegion pin = region;
      pin.stiffness = stiffness;
      SimulationDescription scene = softly_pinned(XpbdDescription{}, pin);
      scene.cloths[0].material.damping = 3;
      scene.effects = {GravityEffect{}, DampingEffect{}};
      Simulation<double> simulation(scene);
      for (int step = 0; step < 900; ++step) simulation.step();
      const Particles<double>& particles = simulation.cloths()[0].particles();
      const double sag = 0.5 - (pin.u_min > 0 ? particles.position_at(0, 8) : top_centre(particles)).y();
      EXPECT_NEAR(sag * stiffness, 0.981, 0.00981) << stiffness << " N/m from u = " << pin.u_min;
    }
  }
}

// One node in two regions with stiffnesses of 300 and 100 N/m hangs 0.981 / 400 m below.
TEST(SoftPins, OfTwoRegionsShareANodeWithXpbd) {
  SimulationDescription scene =
      softly_pinned(XpbdDescription{}, {.u_min = 0.5, .u_max = 0.5, .stiffness = 300});
  scene.cloths[0].pins.push_back({.u_min = 0.5, .u_max = 0.5, .stiffness = 100});
  scene.cloths[0].material.damping = 3;
  scene.effects = {GravityEffect{}, DampingEffect{}};
  Simulation<double> simulation(scene);
  for (int step = 0; step < 900; ++step) simulation.step();
  const Vec3 node = simulation.cloths()[0].particles().position_at(0, 8);
  EXPECT_NEAR(0.5 - node.y(), 0.981 / 400, 0.01 * 0.981 / 400);
}

// A patch that is shaken by 0.2 m five times a second: no stiffness makes it gain energy.
TEST(SoftPins, OfAnyStiffnessFollowAShakenPlaceWithXpbd) {
  for (const double stiffness : {1e2, 1e4, 1e6}) {
    PinRegion pin{.u_max = 1, .stiffness = stiffness};
    for (int i = 0; i <= 20; ++i) pin.path.push_back({0.1 * i, {0, 0, i % 2 == 0 ? 0 : 0.2}});
    SimulationDescription scene = softly_pinned(XpbdDescription{}, pin);
    scene.effects = {GravityEffect{}, DampingEffect{}};
    Simulation<float> simulation(scene);
    double fastest = 0;
    for (int step = 0; step < 240; ++step) {
      simulation.step();
      const Particles<float>& particles = simulation.cloths()[0].particles();
      each_node(particles.grid(),
                [&](int r, int c) { fastest = std::max(fastest, particles.velocity_at(r, c).norm()); });
    }
    // The place goes at 2 m/s, and turns round by twice that; a whip's free end gains some of it.
    EXPECT_GT(fastest, 2) << stiffness;
    EXPECT_LT(fastest, 20) << stiffness;
  }
}

// The force on each node is its share by mass, k m_i / m of the way, whatever the level.
TEST(SoftPins, ShareTheirStiffnessByMass) {
  for (const int level : {3, 4, 5}) {
    SimulationDescription scene = softly_pinned(Bdf2Description{}, {});
    scene.cloths[0].initial_level = level;
    const Simulation<double> simulation(scene);
    Particles<double> particles = simulation.cloths()[0].particles();
    const PinRegion region{.u_max = 1, .stiffness = 30};
    const SoftPins<double> pins({region}, 0, particles);
    particles.place.y() -= 0.1;
    VectorField<double> force(particles.grid());
    const EffectContext context{&simulation.cloths()[0].description(), nullptr, 0};
    pins.add_forces(particles, context, force);
    Vec3 sum(0, 0, 0);
    each_node(particles.grid(), [&](int r, int c) { sum += test::get(force, r, c); });
    EXPECT_LT((sum - Vec3(0, 3, 0)).norm(), 1e-12);
    // A corner has half the mass of its neighbour.
    EXPECT_NEAR(2 * test::get(force, 0, 0).y(), test::get(force, 0, 1).y(), 1e-12);
  }
}

// Of an edge on a solid that goes 2 cm up in the step: at half of it each node is 1 cm from its place, which
// is as far from the solid's centre as it was.
TEST(SoftPins, OnABodyAreSpringsBetweenNodesAndThat) {
  const SimulationDescription scene = softly_pinned(Bdf2Description{}, {});
  const Simulation<double> simulation(scene);
  const Particles<double>& particles = simulation.cloths()[0].particles();
  const PinRegion region{.u_max = 1, .obstacle = 0, .stiffness = 30};
  Solid body;
  body.id = kFirstObstacle;
  body.shape = Sphere{0.1};
  body.start = {0, 1, 0.2};
  body.position = body.start + Vec3(0, 0.02, 0);
  body.velocity = (body.position - body.start) / 0.1;
  for (const bool yields : {true, false}) {
    for (const bool turns : {true, false}) {
      body.inverse_mass = yields ? 2 : 0;
      body.inverse_inertia = (turns ? 50 : 0) * Eigen::Matrix3d::Identity();
      SoftPins<double> pins({region}, 0, particles);
      ASSERT_TRUE(pins.begin_step({body}, 0, 0.1));
      const std::vector<BodySpring> springs = pins.on_bodies(particles, {body}, 0, 0.1, {0, 0.5, 0.05});
      ASSERT_EQ(springs.size(), yields ? 17U : 0U);
      double stiffness = 0;
      for (const BodySpring& spring : springs) {
        const Vec3 node = particles.position_at(0, static_cast<int>(spring.node));
        EXPECT_EQ(spring.solid, 0U);
        EXPECT_LT((spring.apart - Vec3(0, 0.01, 0)).norm(), 1e-12);
        EXPECT_LT((spring.arm - (turns ? Vec3(node - body.start) : Vec3(0, 0, 0))).norm(), 1e-12);
        stiffness += spring.stiffness;
      }
      EXPECT_NEAR(stiffness, yields ? 30 : 0, 1e-12);
    }
  }
}

}  // namespace
}  // namespace weft
