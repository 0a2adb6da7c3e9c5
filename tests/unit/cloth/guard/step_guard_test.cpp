// The step guard (design D11): whatever is put into a step, what comes out of it is a good state.
#include <gtest/gtest.h>

#include "busy_scene.h"
#include "cloth/sheet/diagnostics.h"

#include "cloth/guard/guard_event.h"
#include "cloth/guard/step_guard.h"
#include "faults.h"

namespace weft {
namespace {

using test::add_fault;
using test::default_integrators;
using test::hung_scene;
using test::kNaN;
using test::run;
using Action = GuardEvent::Action;

template <class Real>
class StepGuardOf : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(StepGuardOf, Reals);

/// The first rung: four times the substeps.
IntegratorDescription four_times(IntegratorDescription integrator) {
  if (auto* euler = std::get_if<SymplecticEulerDescription>(&integrator)) {
    euler->safety /= 4;  // it chooses its substeps itself
  } else if (auto* xpbd = std::get_if<XpbdDescription>(&integrator); xpbd && xpbd->substeps == 0) {
    xpbd->longest_substep /= 4;  // so does it
  } else {
    std::visit([](auto& each) { each.substeps *= 4; }, integrator);
  }
  return integrator;
}

bool implicit(const IntegratorDescription& integrator) {
  return std::holds_alternative<BackwardEulerDescription>(integrator) ||
         std::holds_alternative<Bdf2Description>(integrator);
}

// --- Faults put into a simulation ---

/// Runs `steps`, spoils the state, steps once more: what comes out must be, to the bit, what the first rung
/// makes of the last good state.
template <class Real>
void expect_redone(const IntegratorDescription& integrator,
                   const std::function<void(Particles<Real>&)>& spoil, Fault fault) {
  SimulationDescription scene = hung_scene();
  scene.integrator = integrator;
  Simulation<Real> spoilt(scene), plain(scene);
  run(spoilt, 5);
  run(plain, 5);
  plain.set_integrator(four_times(integrator));
  plain.step();
  spoil(spoilt.cloths()[0].particles());
  spoilt.step();
  EXPECT_TRUE(test::same_state(spoilt.cloths()[0].particles(), plain.cloths()[0].particles()));
  EXPECT_TRUE(spoilt.healthy());
  ASSERT_EQ(spoilt.guard_events().size(), 1U);
  const GuardEvent& event = spoilt.guard_events()[0];
  EXPECT_EQ(event.action, Action::redone);
  EXPECT_EQ(event.fault, fault);
  EXPECT_EQ(event.rung, Rung::substeps_4);
  EXPECT_EQ(event.cloth, 0U);
  EXPECT_EQ(event.step, 6U);
  const GuardCounters& counters = spoilt.cloths()[0].guard_counters();
  EXPECT_EQ(counters.redone[static_cast<std::size_t>(Rung::substeps_4)], 1U);
  EXPECT_EQ(counters.all_redone(), 1U);
  EXPECT_EQ(counters.frozen, 0U);
  spoilt.step();
  EXPECT_TRUE(spoilt.guard_events().empty());
}

TYPED_TEST(StepGuardOf, ABadPositionIsTakenBack) {
  using Real = TypeParam;
  for (const IntegratorDescription& integrator : default_integrators()) {
    // Inside, on a border, a pinned corner, the last node of all.
    for (const auto& node : {std::pair{7, 9}, {0, 3}, {0, 0}, {16, 16}}) {
      const int r = node.first, c = node.second;
      for (const Real bad : {kNaN<Real>, std::numeric_limits<Real>::infinity()}) {
        SCOPED_TRACE(::testing::Message()
                     << test::name_of(integrator) << " " << r << ", " << c << ": " << bad);
        expect_redone<Real>(
            integrator, [&](Particles<Real>& particles) { particles.position.y.at(r, c) = bad; },
            Fault::not_finite);
      }
    }
  }
}

TYPED_TEST(StepGuardOf, ABadVelocityIsTakenBack) {
  using Real = TypeParam;
  for (const IntegratorDescription& integrator : default_integrators()) {
    SCOPED_TRACE(test::name_of(integrator));
    // An implicit step that finds no move leaves finite numbers: it has to say itself that it found none.
    expect_redone<Real>(
        integrator, [](Particles<Real>& particles) { particles.velocity.x.at(7, 9) = kNaN<Real>; },
        implicit(integrator) ? Fault::unsolved : Fault::not_finite);
  }
}

TYPED_TEST(StepGuardOf, ABadBufferInMidStepLeavesAGoodState) {
  using Real = TypeParam;
  SimulationDescription scene = hung_scene();
  for (const IntegratorDescription& integrator : default_integrators()) {
    SCOPED_TRACE(test::name_of(integrator));
    scene.integrator = integrator;
    Simulation<Real> spoilt(scene), plain(scene);
    run(plain, 10);
    run(spoilt, 5);
    int calls = 0;
    add_fault<Real>(spoilt.cloths()[0], [&calls](double, VectorField<Real>& force) {
      if (++calls == 2) force.z.at(8, 8) = kNaN<Real>;
    });
    for (int step = 0; step < 5; ++step) {
      spoilt.step();
      ASSERT_TRUE(is_finite(spoilt.cloths()[0].particles()));
    }
    EXPECT_FALSE(spoilt.cloths()[0].frozen());
    // The implicit methods may begin their step anew by themselves; the others are made to.
    if (!implicit(integrator)) {
      EXPECT_EQ(spoilt.cloths()[0].guard_counters().all_redone(), 1U);
    }
    // A tenth of a second of falling is 0.05 m; smaller steps have another error, a tenth of that at most.
    // BDF2 goes on with backward Euler, whose error is that of its own run.
    scene.integrator = BackwardEulerDescription{};
    Simulation<Real> first_order(scene);
    run(first_order, 10);
    const VectorField<Real>& expected = plain.cloths()[0].particles().position;
    const bool bdf2 = std::holds_alternative<Bdf2Description>(integrator);
    EXPECT_LT(test::largest_difference(spoilt.cloths()[0].particles().position, expected),
              bdf2 ? test::largest_difference(first_order.cloths()[0].particles().position, expected) : 5e-3);
  }
}

TYPED_TEST(StepGuardOf, AnAbsurdForceForOneStepFreezesForTwo) {
  using Real = TypeParam;
  SimulationDescription scene = hung_scene();
  for (const IntegratorDescription& integrator : default_integrators()) {
    SCOPED_TRACE(test::name_of(integrator));
    scene.integrator = integrator;
    Simulation<Real> simulation(scene);
    run(simulation, 5);
    const Particles<Real> good = simulation.cloths()[0].particles();
    bool absurd = true;
    add_fault<Real>(simulation.cloths()[0], [&](double, VectorField<Real>& force) {
      if (absurd) force.x.at(8, 8) += Real(1e30);
    });
    simulation.step();  // no method makes anything of it
    ASSERT_EQ(simulation.guard_events().size(), 1U);
    EXPECT_EQ(simulation.guard_events()[0].action, Action::frozen);
    EXPECT_NE(simulation.guard_events()[0].fault, Fault::none);
    const Cloth<Real>& cloth = simulation.cloths()[0];
    EXPECT_TRUE(cloth.frozen());
    EXPECT_TRUE(test::same_bits(cloth.particles().position, good.position));
    EXPECT_EQ(kinetic_energy(cloth.particles()), 0);
    EXPECT_EQ(simulation.last_advance(0).substeps, 0);
    absurd = false;
    simulation.step();  // waits
    EXPECT_TRUE(cloth.frozen());
    EXPECT_TRUE(simulation.guard_events().empty());
    EXPECT_TRUE(test::same_bits(cloth.particles().position, good.position));
    simulation.step();
    ASSERT_EQ(simulation.guard_events().size(), 1U);
    EXPECT_EQ(simulation.guard_events()[0].action, Action::thawed);
    EXPECT_EQ(simulation.guard_events()[0].rung, Rung::own);
    EXPECT_FALSE(cloth.frozen());
    EXPECT_EQ(cloth.guard_counters().frozen, 1U);
    EXPECT_FALSE(test::same_bits(cloth.particles().position, good.position));
    EXPECT_TRUE(simulation.healthy());
  }
}

TYPED_TEST(StepGuardOf, APermanentFaultFreezesOneClothAndNothingElseSlow) {
  using Real = TypeParam;
  SimulationDescription scene = hung_scene();
  scene.cloths.push_back(scene.cloths[0]);
  scene.cloths[1].name = "other";
  scene.cloths[1].position = {5, 0, 0};
  BallDescription ball = test::ball_at({5, 0, 0.3}, 0.2, {0, 0, -1});
  ball.motion = BallDescription::Motion::dynamic;
  scene.balls = {ball};
  for (const IntegratorDescription& integrator : default_integrators()) {
    SCOPED_TRACE(test::name_of(integrator));
    scene.integrator = integrator;
    Simulation<Real> spoilt(scene), plain(scene);
    add_fault<Real>(spoilt.cloths()[0], [](double, VectorField<Real>& force) {
      force.x.at(0, 0) = force.x.at(8, 8) = kNaN<Real>;
    });
    const Particles<Real> start = spoilt.cloths()[0].particles();
    int frozen = 0;
    for (int step = 0; step < 40; ++step) {
      spoilt.step();
      plain.step();
      for (const GuardEvent& event : spoilt.guard_events()) frozen += event.action == Action::frozen ? 1 : 0;
      ASSERT_TRUE(test::same_state(spoilt.cloths()[1].particles(), plain.cloths()[1].particles())) << step;
      ASSERT_EQ(spoilt.colliders().balls()[0].position, plain.colliders().balls()[0].position);
      ASSERT_TRUE(test::same_bits(spoilt.cloths()[0].particles().position, start.position));
    }
    EXPECT_EQ(frozen, 1);  // told once, however often it is tried again
    EXPECT_TRUE(spoilt.cloths()[0].frozen());
    EXPECT_EQ(spoilt.cloths()[0].guard_counters().frozen, 1U);
    EXPECT_EQ(spoilt.cloths()[1].guard_counters().all_redone(), 0U);
    spoilt.reset();
    plain.reset();
    EXPECT_FALSE(spoilt.cloths()[0].frozen());
    run(spoilt, 10);
    run(plain, 10);
    EXPECT_TRUE(test::same_state(spoilt.cloths()[0].particles(), plain.cloths()[0].particles()));
  }
}

TEST(StepGuard, TriesAFrozenClothMoreAndMoreSeldom) {
  SimulationDescription scene = hung_scene();
  scene.cloths[0].initial_level = 3;
  Simulation<float> simulation(scene);
  int calls = 0;
  add_fault<float>(simulation.cloths()[0], [&](double, VectorField<float>& force) {
    ++calls;
    force.x.at(4, 4) = kNaN<float>;
  });
  std::vector<int> tried;
  for (int step = 1; step <= 40; ++step) {
    const int before = calls;
    simulation.step();
    if (calls > before) tried.push_back(step);
  }
  // After 1, 2, 4, 8, 16 steps left out.
  EXPECT_EQ(tried, (std::vector<int>{1, 3, 6, 11, 20, 37}));
}

TEST(StepGuard, KeepsWhatWorkedForSixtySteps) {
  SimulationDescription scene = hung_scene();
  Simulation<float> simulation(scene);  // BDF2, one substep
  const auto spoil = [&] { simulation.cloths()[0].particles().position.x.at(5, 5) = kNaN<float>; };
  const auto steps_with_four = [&] {
    int count = 0;
    do {
      simulation.step();
      ++count;
    } while (simulation.last_advance(0).substeps == 4);
    EXPECT_EQ(simulation.last_advance(0).substeps, 1);
    return count - 1;
  };
  run(simulation, 3);
  spoil();
  EXPECT_EQ(steps_with_four(), 1 + 60);
  spoil();  // soon after it came back to its own way: twice as long
  EXPECT_EQ(steps_with_four(), 1 + 120);
  run(simulation, 60);
  spoil();
  EXPECT_EQ(steps_with_four(), 1 + 60);
}

TEST(StepGuardSlow, AFailedStepGivesBallsNothing) {
  // A ball that falls onto a cloth which cannot be stepped falls on as if there were none.
  SimulationDescription scene = hung_scene();
  scene.cloths[0].orientation = Quaternion(Eigen::AngleAxisd(-1.5707963, Vec3::UnitX()));
  BallDescription ball = test::ball_at({0, 0.15, 0}, 0.2, {0, -1, 0});
  ball.motion = BallDescription::Motion::dynamic;
  scene.balls = {ball};
  for (const IntegratorDescription& integrator : default_integrators()) {
    scene.integrator = integrator;
    Simulation<double> simulation(scene);
    add_fault<double>(simulation.cloths()[0],
                      [](double, VectorField<double>& force) { force.y.at(0, 8) = kNaN<double>; });
    simulation.step();
    EXPECT_TRUE(simulation.cloths()[0].frozen());
    EXPECT_NEAR(simulation.colliders().balls()[0].velocity.y(), -1 - 9.81 / 60, 1e-12);
    run(simulation, 10);
    EXPECT_NEAR(simulation.colliders().balls()[0].velocity.y(), -1 - 11 * 9.81 / 60, 1e-12);
  }
}

TEST(StepGuard, ALevelChangeBeginsFromAGoodState) {
  Simulation<float> spoilt(hung_scene()), plain(hung_scene());
  run(spoilt, 5);
  run(plain, 5);
  spoilt.cloths()[0].particles().position.x.at(3, 3) = kNaN<float>;
  for (auto* simulation : {&spoilt, &plain}) {
    simulation->request_level(0, 5);
    simulation->step();
  }
  ASSERT_EQ(spoilt.guard_events().size(), 1U);
  EXPECT_EQ(spoilt.guard_events()[0].fault, Fault::not_finite);
  EXPECT_TRUE(
      test::same_bits(spoilt.cloths()[0].particles().position, plain.cloths()[0].particles().position));
}

TEST(StepGuard, WhatContactPutsInAfterAStepIsPutBackAndTold) {
  Simulation<float> spoilt(hung_scene()), plain(hung_scene());
  run(spoilt, 5);
  run(plain, 5);
  Cloth<float>& cloth = spoilt.cloths()[0];
  cloth.particles().velocity.x.at(7, 9) = kNaN<float>;
  cloth.moved_from_outside();
  const Particles<float>&back = cloth.particles(), &good = plain.cloths()[0].particles();
  EXPECT_TRUE(test::same_bits(back.position, good.position));
  EXPECT_TRUE(test::same_bits(back.velocity, good.velocity));
  spoilt.step();
  ASSERT_EQ(spoilt.guard_events().size(), 1U);
  EXPECT_EQ(spoilt.guard_events()[0].action, Action::redone);
  EXPECT_EQ(spoilt.guard_events()[0].fault, Fault::not_finite);
  EXPECT_EQ(spoilt.guard_events()[0].rung, Rung::own);
}

TEST(StepGuard, AFrozenClothIsTriedAtOnceAtAnotherLevel) {
  Simulation<float> simulation(hung_scene());
  bool faulty = true;
  add_fault<float>(simulation.cloths()[0], [&](double, VectorField<float>& force) {
    if (faulty) force.x.at(4, 4) = kNaN<float>;
  });
  run(simulation, 12);  // the next try is at step 20
  EXPECT_TRUE(simulation.cloths()[0].frozen());
  faulty = false;
  simulation.request_level(0, 3);
  simulation.step();
  EXPECT_FALSE(simulation.cloths()[0].frozen());
  EXPECT_GT(simulation.last_advance(0).substeps, 0);
}

// --- Methods that are not stable ---

TYPED_TEST(StepGuardOf, TooFewSubstepsAreMadeUpForSlow) {
  // The stiffest mode needs 33 (level 4).
  for (const int substeps : {1, 2, 4, 8}) {
    SCOPED_TRACE(substeps);
    SimulationDescription scene = hung_scene();
    scene.integrator = SymplecticEulerDescription{substeps, 0.9};
    Simulation<TypeParam> simulation(scene);
    bool bad = false;
    for (int step = 0; step < 600; ++step) {
      simulation.step();
      bad = bad || !is_finite(simulation.cloths()[0].particles());
    }
    EXPECT_FALSE(bad);
    const Cloth<TypeParam>& cloth = simulation.cloths()[0];
    EXPECT_GT(cloth.guard_counters().all_redone(), 0U);
    EXPECT_EQ(cloth.guard_counters().frozen, 0U);
    EXPECT_LT(simulation.report(0).strain.max, 0.1) << "held by a safer method, it hangs as it should";
  }
}

TEST(StepGuard, MoreSubstepsThanThereMayBeAreLeftToBackwardEuler) {
  SimulationDescription scene = hung_scene();
  scene.cloths[0].material.structural = 1e9;  // an explicit step of 1/60 s would take 15,000 substeps
  scene.cloths[0].initial_level = 4;
  scene.integrator = SymplecticEulerDescription{};
  Simulation<double> simulation(scene);
  simulation.step();
  ASSERT_EQ(simulation.guard_events().size(), 1U);
  EXPECT_EQ(simulation.guard_events()[0].fault, Fault::unsolved);
  EXPECT_EQ(simulation.guard_events()[0].rung, Rung::backward_euler_4);
}

// --- What must not be taken for a fault ---

TYPED_TEST(StepGuardOf, ANodeAt1000MetresASecondIsNone) {
  for (const IntegratorDescription& integrator : default_integrators()) {
    SCOPED_TRACE(test::name_of(integrator));
    SimulationDescription scene = hung_scene();
    scene.integrator = integrator;
    Simulation<TypeParam> simulation(scene);
    simulation.cloths()[0].particles().velocity.z.at(8, 8) = TypeParam(1000);
    for (int step = 0; step < 60; ++step) {
      simulation.step();
      for (const GuardEvent& event : simulation.guard_events()) ADD_FAILURE() << describe(event, "cloth");
    }
  }
}

TYPED_TEST(StepGuardOf, ASheetDraggedAwayByAFastBallIsNoneSlow) {
  // Held all round and carried off by 200 m in a second, then let go.
  for (const IntegratorDescription& integrator : default_integrators()) {
    SCOPED_TRACE(test::name_of(integrator));
    SimulationDescription scene = hung_scene();
    scene.cloths[0].pins = {{0, 1, 0, 0}, {0, 1, 1, 1}, {0, 0, 0, 1}, {1, 1, 0, 1}};
    BallDescription ball = test::ball_at({0, 0, 0.6}, 0.5);
    ball.path = {{0, {0, 0, 0.6}}, {1, {0, 0, -200}}};
    scene.balls = {ball};
    scene.integrator = integrator;
    Simulation<TypeParam> simulation(scene);
    for (int step = 0; step < 90; ++step) {
      if (step == 60) simulation.remove_ball(1);
      simulation.step();
      for (const GuardEvent& event : simulation.guard_events()) ADD_FAILURE() << describe(event, "cloth");
    }
  }
}

// --- Balls ---

TEST(StepGuard, ABallThatLeavesTheNumbersIsPutBack) {
  SimulationDescription scene = hung_scene();
  scene.balls = {test::ball_at({3, 4, 5}, 0.2)};
  Simulation<float> simulation(scene);
  run(simulation, 3);
  for (const Vec3& velocity : {Vec3(1e308, 0, 0), Vec3(0, kNaN<double>, 0)}) {
    ASSERT_TRUE(simulation.throw_ball(1, velocity));
    simulation.step();
    ASSERT_EQ(simulation.guard_events().size(), 1U);
    EXPECT_EQ(simulation.guard_events()[0].action, Action::ball_stopped);
    EXPECT_EQ(simulation.guard_events()[0].ball, 1U);
    EXPECT_EQ(simulation.colliders().balls()[0].position, Vec3(3, 4, 5));
    EXPECT_TRUE(simulation.colliders().balls()[0].velocity.isZero(0));
    EXPECT_TRUE(simulation.healthy());
    simulation.move_ball(1, {3, 4, 5});  // kinematic again, or it would fall
    run(simulation, 2);
    EXPECT_TRUE(simulation.guard_events().empty());
  }
}

}  // namespace
}  // namespace weft
