// Hands on a cloth, and pins set and taken away in motion.
#include <gtest/gtest.h>

#include "cloth/forces/grab.h"
#include "cloth/world/simulation.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;
using test::get;

const IntegratorDescription kIntegrators[] = {Bdf2Description{}, BackwardEulerDescription{},
                                              XpbdDescription{}, SymplecticEulerDescription{}};

/// A sheet of 1 m x 1 m that hangs in air.
SimulationDescription sheet(const IntegratorDescription& integrator, int level = 4) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {1, 1};
  cloth.min_level = 4;
  cloth.max_level = 6;
  cloth.initial_level = level;
  cloth.material.damping = 0.5;
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{}, DampingEffect{}, AerodynamicsEffect{}};
  scene.integrator = integrator;
  return scene;
}

template <class Real>
Vec3 held_place(const Simulation<Real>& simulation, const Vec2& at) {
  const Cloth<Real>& cloth = simulation.cloths()[0];
  return Grabs<Real>::place(cloth.particles(), cloth.description(), at);
}

TEST(Grabs, PullThePatchByTheSpringAndNoMoreThanTheyMay) {
  for (const int level : {4, 5, 6}) {
    Simulation<double> simulation(sheet(Bdf2Description{}, level));
    const Particles<double>& particles = simulation.cloths()[0].particles();
    const ClothDescription& cloth = simulation.cloths()[0].description();
    Grabs<double> grabs;
    // 0.1 kg/m2 on 1 m2 at 20 rad/s: 40 N/m; 0.3 m off the point: 12 N.
    grabs.add({1, {0.5, 0.5}, {0, 0, 0.3}, 100});
    const EffectContext context{&cloth, nullptr, 0};
    const auto total = [&] {
      VectorField<double> force(particles.grid());
      grabs.add_forces(particles, context, force);
      Vec3 sum(0, 0, 0);
      int nodes = 0;
      each_node(particles.grid(), [&](int r, int c) {
        const Vec3 each = get(force, r, c);
        sum += each;
        if (each.isZero(0)) return;
        ++nodes;
        EXPECT_LE(particles.position_at(r, c).norm(), std::sqrt(2.0) / 16);  // within the patch
      });
      EXPECT_GE(nodes, 1);
      return sum;
    };
    EXPECT_LT((total() - Vec3(0, 0, 12)).norm(), 1e-12);
    VectorField<double> stiffness(particles.grid());
    grabs.add_stiffness(particles, context, stiffness.x.row(0));
    double sum = 0;
    each_node(particles.grid(), [&](int r, int c) { sum += stiffness.x.at(r, c); });
    EXPECT_NEAR(sum, 40, 1e-12);
    EXPECT_TRUE(grabs.move(1, {0, 5, 0}));  // 200 N, but it may pull with 100
    EXPECT_LT((total() - Vec3(0, 100, 0)).norm(), 1e-12);
    EXPECT_FALSE(grabs.move(2, {0, 0, 0}));
    EXPECT_TRUE(grabs.release(1));
    EXPECT_FALSE(grabs.release(1));
    EXPECT_TRUE(grabs.empty());
  }
}

TEST(GrabsSlow, HoldAClothThatHangsFromThemAtEveryLevelWithEveryMethod) {
  // Hung from one point the cloth's whole weight is on the spring: g / (20 rad/s)^2 = 24.5 mm of it.
  for (const IntegratorDescription& integrator : kIntegrators) {
    for (const int level : {4, 5}) {
      SimulationDescription scene = sheet(integrator, level);
      scene.cloths[0].max_level = level;
      Simulation<float> simulation(scene);
      const Vec3 hand = held_place(simulation, {0.3, 0});
      simulation.grab(0, {0.3, 0}, std::nullopt, 100);
      for (int step = 0; step < 600; ++step) simulation.step();
      const Vec3 place = held_place(simulation, {0.3, 0});
      EXPECT_NEAR(hand.y() - place.y(), 9.81 / 400, 5e-4) << integrator.index() << " level " << level;
      EXPECT_LT((hand - place).cwiseProduct(Vec3(1, 0, 1)).norm(), 2e-3)
          << integrator.index() << " level " << level;
      EXPECT_FALSE(simulation.cloths()[0].frozen());
      EXPECT_EQ(simulation.cloths()[0].guard_counters().all_redone(), 0u);
    }
  }
}

TEST(Grabs, SlipWhenTheClothIsTooHeavy) {
  // Its weight is 0.98 N, the hand holds 0.5 N: it falls with what is left of gravity, about half.
  SimulationDescription scene = sheet(Bdf2Description{});
  scene.effects = {GravityEffect{}};
  Simulation<double> simulation(scene);
  simulation.grab(0, {0.5, 0.5}, Vec3(0, 50, 0), 0.5);
  const Particles<double>& particles = simulation.cloths()[0].particles();
  const auto centre_of_mass = [&] {
    double sum = 0;
    each_node(particles.grid(),
              [&](int r, int c) { sum += particles.mass.at(r, c) * particles.position_at(r, c).y(); });
    return sum / 0.1;
  };
  const double before = centre_of_mass();
  for (int step = 0; step < 30; ++step) simulation.step();
  const double acceleration = 9.81 - 0.5 / 0.1, time = 0.5;
  // BDF2 begins with a step of backward Euler, which falls g h^2 / 2 too far, and h g t / 2 by the end.
  EXPECT_NEAR(before - centre_of_mass(), acceleration * time * time / 2, acceleration * time / 60 / 2 + 1e-6);
}

TEST(Grabs, LeaveTheRestOfTheClothToGravity) {
  // A hand that all but slips holds one corner: the rest falls freely, with every method.
  for (const IntegratorDescription& integrator : kIntegrators) {
    SimulationDescription scene = sheet(integrator);
    scene.effects = {GravityEffect{}};
    Simulation<double> simulation(scene);
    for (int hand = 0; hand < 4; ++hand) simulation.grab(0, {0, 0}, Vec3(-0.5, 0.6, 0), 1e-3);
    for (int step = 0; step < 30; ++step) simulation.step();
    // Of 0.98 N, and the first order's g h t / 2.
    const double fall = 9.81 / 8, first_order = 9.81 / 60 / 4;
    EXPECT_NEAR(-simulation.centre(0).y(), fall, 0.01 * fall + first_order) << integrator.index();
  }
}

TEST(Grabs, KeepTheirHoldThroughLevels) {
  Simulation<float> simulation(sheet(Bdf2Description{}));
  const GrabId grab = simulation.grab(0, {0, 0}, std::nullopt, 100);
  const Vec3 hand = held_place(simulation, {0, 0});
  for (int step = 0; step < 600; ++step) {
    if (step % 60 == 0) simulation.request_level(0, 4 + step / 60 % 3);
    simulation.step();
  }
  EXPECT_LT((held_place(simulation, {0, 0}) - hand).norm(), 0.05);
  EXPECT_TRUE(simulation.release(grab));
  EXPECT_TRUE(simulation.cloths()[0].grabs().empty());
}

TEST(Grabs, WakeASleepingClothAndAreGoneAfterAReset) {
  SimulationDescription scene = sheet(Bdf2Description{});
  scene.cloths[0].pins = {{0, 1, 0, 0}};
  Simulation<float> simulation(scene);
  for (int step = 0; step < 1200 && !simulation.cloths()[0].asleep(); ++step) simulation.step();
  ASSERT_TRUE(simulation.cloths()[0].asleep());
  const GrabId grab = simulation.grab(0, {0.5, 1}, std::nullopt, 100);
  EXPECT_FALSE(simulation.cloths()[0].asleep());
  EXPECT_TRUE(simulation.move_grab(grab, {0, 0, 1}));
  for (int step = 0; step < 60; ++step) simulation.step();
  EXPECT_GT(held_place(simulation, {0.5, 1}).z(), 0.3);
  simulation.reset();
  EXPECT_TRUE(simulation.cloths()[0].grabs().empty());
  EXPECT_FALSE(simulation.release(grab));
}

TEST(PinCommands, HoldWhereTheClothIsAndLetGo) {
  for (const IntegratorDescription& integrator : kIntegrators) {
    SimulationDescription scene = sheet(integrator);
    scene.cloths[0].pins = {{0, 0, 0, 0}};
    Simulation<float> simulation(scene);
    for (int step = 0; step < 20; ++step) simulation.step();
    const Particles<float>& particles = simulation.cloths()[0].particles();
    const Vec3 place = get(particles.position, 0, 16);
    EXPECT_LT(place.y(), 0.5);  // it has begun to fall
    simulation.pin(0, {1, 0});
    for (int step = 0; step < 60; ++step) simulation.step();
    EXPECT_EQ(get(particles.position, 0, 16), place);
    EXPECT_EQ(get(particles.position, 0, 0), Vec3(-0.5, 0.5, 0));
    EXPECT_TRUE(simulation.unpin(0, {0.1, 0.1}));  // the nearest: the first one
    EXPECT_EQ(simulation.cloths()[0].description().pins.size(), 1u);
    for (int step = 0; step < 60; ++step) simulation.step();
    EXPECT_LT(get(particles.position, 0, 0).y(), 0);
    EXPECT_EQ(get(particles.position, 0, 16), place);
    EXPECT_TRUE(simulation.unpin(0, {0, 0}));
    EXPECT_FALSE(simulation.unpin(0, {0, 0}));
    EXPECT_FALSE(simulation.cloths()[0].frozen());
  }
}

TEST(PinCommandsSlow, ClampAPlateWhereTheyHoldIt) {
  // A stiff plate held by its left edge's two outer columns stands out; held by one line it hangs.
  for (const IntegratorDescription& integrator : kIntegrators) {
    SimulationDescription scene = sheet(integrator);
    scene.effects.push_back(PlateBendingEffect{});
    scene.cloths[0].orientation = Quaternion(Eigen::AngleAxisd(-std::acos(-1.0) / 2, Vec3::UnitX()));
    scene.cloths[0].material.bending = 0;
    scene.cloths[0].material.rigidity = Rigidity{1, 1, 1};
    scene.cloths[0].pins = {{0, 0, 0, 1}};
    Simulation<double> simulation(scene);
    for (int row = 0; row <= 16; ++row) simulation.pin(0, {1.0 / 16, row / 16.0});
    for (int step = 0; step < 600; ++step) simulation.step();
    // A cantilever of 15/16 m under 0.98 N/m2: q L^4 / (8 B) = 95 mm at its tip, a little less as it is bent
    // far.
    const double tip = get(simulation.cloths()[0].particles().position, 8, 16).y();
    EXPECT_LT(tip, -0.07) << integrator.index();
    // XPBD's plate is softer than asked for (xpbd.h), by a quarter here; hinged it hangs half a metre lower.
    EXPECT_GT(tip, std::holds_alternative<XpbdDescription>(integrator) ? -0.15 : -0.1) << integrator.index();
    for (int row = 0; row <= 16; ++row) simulation.unpin(0, {1.0 / 16, row / 16.0});
    for (int step = 0; step < 600; ++step) simulation.step();
    EXPECT_LT(get(simulation.cloths()[0].particles().position, 8, 16).y(), -0.5) << integrator.index();
  }
}

}  // namespace
}  // namespace weft
