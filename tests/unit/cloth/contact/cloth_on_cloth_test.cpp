// Cloths that lie on each other: what each feels of the other, and that they come to rest.
#include <gtest/gtest.h>

#include "cloth/contact/constraints/pair_forces.h"
#include "fixtures.h"
#include "folding_scenes.h"
#include "held.h"

namespace weft::test {
namespace {

PairForce found(std::uint32_t node, double force, bool between_cloths) {
  return {.pair = {node, node, 0, 0},
          .force = force,
          .grip = {force / 4, 0, 0},
          .between_cloths = between_cloths};
}

/// Their friction is a quarter of them.
std::vector<double> forces_of(const std::vector<PairForce>& pairs) {
  std::vector<double> forces;
  for (const PairForce& pair : pairs) {
    EXPECT_EQ(pair.grip.x(), pair.force / 4);
    forces.push_back(pair.force);
  }
  return forces;
}

/// The small cloth of caught(), so many times as heavy, in the hollow of the large one.
SimulationDescription in_a_hollow(double times, const IntegratorDescription& stepping, int hz) {
  SimulationDescription scene = caught(4, stepping);
  scene.time_step = 1.0 / hz;
  scene.cloths[1].material.density *= times;
  scene.effects.emplace_back(DampingEffect{});
  for (ClothDescription& cloth : scene.cloths) cloth.material.damping = 0.5;
  return scene;
}

double mass(const Cloth<float>& cloth) {
  return cloth.description().size.prod() * cloth.description().material.density;
}

/// Of a node, m.
double farthest_move(const Particles<float>& before, const Particles<float>& now) {
  double most = 0;
  for (int r = 0; r < now.grid().rows; ++r) {
    for (int c = 0; c < now.grid().cols; ++c) {
      most = std::max(most, (now.position_at(r, c) - before.position_at(r, c)).norm());
    }
  }
  return most;
}

const auto kImplicit = ::testing::Values(IntegratorDescription(Bdf2Description{}),
                                         IntegratorDescription(BackwardEulerDescription{}));

/// By how much heavier the upper one is than it is by itself, and the method.
class OneInTheOther : public ::testing::TestWithParam<std::tuple<double, IntegratorDescription>> {};
INSTANTIATE_TEST_SUITE_P(Slow, OneInTheOther, ::testing::Combine(::testing::Values(1.0, 4.0), kImplicit));

class OneOnTheOther : public ::testing::TestWithParam<IntegratorDescription> {};
INSTANTIATE_TEST_SUITE_P(Slow, OneOnTheOther,
                         ::testing::Values(IntegratorDescription(Bdf2Description{}),
                                           IntegratorDescription(BackwardEulerDescription{}),
                                           IntegratorDescription(XpbdDescription{})));

}  // namespace

TEST(PairForces, AreSharedByTwoClothsThatPressOnEachOther) {
  std::vector<PairForce> one{found(1, 2, true), found(3, 5, false), found(7, 4, true)},
      other{found(0, 9, true), found(1, 6, true), found(3, 1, false)};
  std::vector<PairForce>* const both[] = {&one, &other};
  share_forces(both);
  // Pair 1 by both: (2 + 6) / 2. Pair 3 lies within each; pairs 0 and 7 press in one cloth's step alone.
  EXPECT_EQ(forces_of(one), (std::vector<double>{4, 5, 4}));
  EXPECT_EQ(forces_of(other), (std::vector<double>{9, 4, 1}));
}

// Newton's third law and T1: at rest the four pins bear the weight of both cloths.
TEST_P(OneInTheOther, PinsBearTheWeightOfBoth) {
  const auto [times, stepping] = GetParam();
  const int hz = 30;
  Simulation<float> simulation(in_a_hollow(times, stepping, hz));
  for (int step = 0; step < 8 * hz; ++step) simulation.step();
  double borne = 0;  // N, the mean of a second
  for (int step = 0; step < hz; ++step) {
    simulation.step();
    for (const Vec3& force : Held::of(simulation.cloths()[0]).force) borne -= force.y() / hz;
  }
  const double weight =
      (mass(simulation.cloths()[0]) + mass(simulation.cloths()[1])) * -standard_gravity().y();
  EXPECT_NEAR(borne, weight, 0.01 * weight);
  EXPECT_GT(simulation.centre(1).y(), -1) << "it was caught";
}

// Sleep takes what moves by less than SimulationDescription::sleep_speed, and both at once: under one that
// still moved the other was woken in the next step, and had been a rock to it for one.
TEST_P(OneOnTheOther, BothComeToRestAndSleepTogether) {
  SimulationDescription description = in_a_hollow(1, GetParam(), 60);
  description.sleep_speed = SimulationDescription{}.sleep_speed;
  Simulation<float> simulation(description);
  const auto& cloths = simulation.cloths();
  for (int step = 0; step < 1200 && !cloths[0].asleep(); ++step) {
    simulation.step();
    ASSERT_EQ(cloths[0].asleep(), cloths[1].asleep()) << "step " << step;
  }
  ASSERT_TRUE(cloths[0].asleep());

  // The upper one, set in motion, wakes the other, which bears it in that very step: neither gets farther
  // than the hit takes it, at 2 cm/s. Without its load the lower one was put up by its springs, by g h^2 / 2.
  const std::vector<Particles<float>> before{cloths[0].particles(), cloths[1].particles()};
  simulation.cloths()[1].wake();
  VectorField<float>& velocity = simulation.cloths()[1].particles().velocity;
  std::fill(velocity.y.values().begin(), velocity.y.values().end(), -0.02F);
  simulation.step();
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_FALSE(cloths[i].asleep());
    EXPECT_LT(farthest_move(before[i], cloths[i].particles()), 0.02 / 60);
  }
}

// A tenth of a millimetre a second: what sticks does not creep. Each step anew, friction would have to slip
// by g sin(angle) h^2 / 50 for its force, 0.9 mm/s on this slope.
TEST_P(OneOnTheOther, WhatSticksDoesNotCreep) {
  Simulation<float> simulation(on_a_slope(15, 0.5, GetParam()));
  for (int step = 0; step < 120; ++step) simulation.step();
  const Vec3 before = simulation.centre(1);
  for (int step = 0; step < 60; ++step) simulation.step();
  EXPECT_LT((simulation.centre(1) - before).norm(), 1e-4);
}

// The same within one cloth, of every node: the fold slips by 0.4 mm/s if each step finds its friction anew.
// A heap on a floor crept by 0.2 mm/s for four minutes (S51a, backward Euler, level 5, 30 Hz).
TEST_P(OneOnTheOther, WhatSticksToItsOwnClothDoesNotCreep) {
  Simulation<float> simulation(folded_on_a_slope(15, 0.5, GetParam()));
  for (int step = 0; step < 120; ++step) simulation.step();
  const Particles<float>& now = simulation.cloths()[0].particles();
  const Particles<float> before = now;
  for (int step = 0; step < 60; ++step) simulation.step();
  EXPECT_LT(farthest_move(before, now), 1e-4);
}

// By their momenta they stop, which is all the energy they have: a hit of cloth on cloth has no bounce. Each
// thinking that the other went on unhindered, they swapped velocities in explicit steps; of BDF2's, which
// went on from their motion before the hit, they got 0.39 of it back.
TEST(OneAgainstTheOtherSlow, SheetsThatMeetHeadOnStop) {
  for (const IntegratorDescription& stepping :
       {IntegratorDescription(XpbdDescription{}), IntegratorDescription(SymplecticEulerDescription{}),
        IntegratorDescription(BackwardEulerDescription{}), IntegratorDescription(Bdf2Description{})}) {
    SimulationDescription scene = fall_together(4, stepping);
    scene.effects.erase(scene.effects.begin());  // gravity
    scene.obstacles.clear();
    scene.cloths[0].velocity = {0, 0.5, 0};
    scene.cloths[1].velocity = {0, -0.5, 0};
    Simulation<float> simulation(scene);
    for (int step = 0; step < 6; ++step) simulation.step();  // 5 mm of 10 until they touch, 10 ms
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LT(simulation.report(i).kinetic_energy, 0.01 * mass(simulation.cloths()[i]) * 0.25 / 2);
    }
  }
}

}  // namespace weft::test
