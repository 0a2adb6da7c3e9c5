// A cloth's material and the friction of what it meets, changed between two steps: the scene goes on from
// where it is, as if it had been described so.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cloth/world/simulation.h"
#include "cloth/world/state_hash.h"
#include "fixtures.h"

namespace weft {
namespace {

const IntegratorDescription kMethodsOfMaterials[] = {Bdf2Description{}, BackwardEulerDescription{},
                                                     XpbdDescription{}, SymplecticEulerDescription{}};

/// A sheet of 1 m held by its top edge, at rest, with every effect that reads its material.
SimulationDescription hung_sheet(const IntegratorDescription& integrator, int level = 3) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {1, 1};
  cloth.min_level = cloth.max_level = cloth.initial_level = level;
  cloth.pins = {{0, 1, 0, 0}};
  scene.cloths = {cloth};
  scene.integrator = integrator;
  scene.sleep_speed = 0;
  scene.effects = {GravityEffect{}, DampingEffect{}, PlateBendingEffect{}, StrainLimitEffect{}};
  return scene;
}

void many_steps(Simulation<float>& simulation, int count) {
  for (int step = 0; step < count; ++step) simulation.step();
}

std::vector<Material> other_materials() {
  std::vector<Material> others(7);
  others[0].structural = 300;
  others[1].shear = 5000;
  others[2].bending = 0;
  others[3].damping = 2;
  others[4].rigidity = {1e-2, 1e-3, 1e-2};
  others[5].limit.warp = others[5].limit.weft = 1e-3;
  others[6].limit = {1e-3, 1e-3, 1e-3, 100};
  return others;
}

TEST(MaterialTune, ToWhatItIsChangesNoBit) {
  for (const IntegratorDescription& integrator : kMethodsOfMaterials) {
    SCOPED_TRACE(integrator.index());
    const SimulationDescription scene = hung_sheet(integrator);
    Simulation<float> tuned(scene), untouched(scene);
    for (int step = 0; step < 20; ++step) {
      tuned.set_material(0, scene.cloths[0].material);
      tuned.step();
      untouched.step();
    }
    EXPECT_EQ(state_hash(tuned), state_hash(untouched));
  }
}

TEST(MaterialTuneSlow, IsAsIfTheClothWereMadeOfIt) {
  for (const IntegratorDescription& integrator : kMethodsOfMaterials) {
    SimulationDescription scene = hung_sheet(integrator);
    scene.cloths[0].velocity = {0.5, -1, 0.5};  // bends, shears and pulls it
    Simulation<float> untouched(scene);
    many_steps(untouched, 30);
    const std::vector<Material> others = other_materials();
    for (std::size_t i = 0; i < others.size(); ++i) {
      SCOPED_TRACE("material " + std::to_string(i) + ", method " + std::to_string(integrator.index()));
      SimulationDescription made_so = scene;
      made_so.cloths[0].material = others[i];
      Simulation<float> made(made_so), tuned(scene);
      tuned.set_material(0, others[i]);
      many_steps(made, 30);
      many_steps(tuned, 30);
      EXPECT_EQ(state_hash(tuned), state_hash(made));
      EXPECT_NE(state_hash(tuned), state_hash(untouched));
      tuned.reset();
      many_steps(tuned, 30);
      EXPECT_EQ(state_hash(tuned), state_hash(untouched));
    }
  }
}

/// How much longer the sheet hangs than it is, m.
double sag(const Simulation<float>& simulation) {
  const Particles<float>& particles = simulation.cloths()[0].particles();
  const Grid& grid = particles.grid();
  const int middle = grid.cols / 2;
  return (test::get(particles.position, 0, middle) - test::get(particles.position, grid.rows - 1, middle))
             .norm() -
         1;
}

TEST(MaterialTune, AHungSheetStretchesByItsWeightOverItsStiffness) {
  // A sheet of length L whose lengthwise springs alone bear it hangs rho g L^2 / (2 Y) longer, T2; XPBD's up
  // to g h^2 N^2 / 2 more (xpbd.h).
  for (const IntegratorDescription& integrator : kMethodsOfMaterials) {
    SCOPED_TRACE(integrator.index());
    SimulationDescription scene = hung_sheet(integrator);
    Material& material = scene.cloths[0].material;
    material.structural = 100;
    material.shear = material.bending = 0;
    material.damping = 1;
    scene.effects = {GravityEffect{}, DampingEffect{}};
    Simulation<float> simulation(scene);
    const bool is_xpbd = std::holds_alternative<XpbdDescription>(integrator);
    const double more = is_xpbd ? 9.81 / (2400.0 * 2400.0) * 8 * 8 / 2 : 0;
    for (const double stiffness : {100.0, 400.0, 50.0}) {
      Material other = material;
      other.structural = stiffness;
      simulation.set_material(0, other);
      many_steps(simulation, 600);
      const double expected = material.density * 9.81 / (2 * stiffness);
      EXPECT_GT(sag(simulation), 0.995 * expected) << stiffness;
      EXPECT_LT(sag(simulation), 1.005 * expected + more) << stiffness;
    }
  }
}

TEST(MaterialTune, DampingSlowsByItsRate) {
  // Eq. 3 with nothing else: v decays by exp(-k t / density), and goes on so with another k.
  for (const IntegratorDescription& integrator : kMethodsOfMaterials) {
    SCOPED_TRACE(integrator.index());
    SimulationDescription scene = hung_sheet(integrator);
    scene.effects = {DampingEffect{}};
    scene.time_step = 1.0 / 240;
    ClothDescription& cloth = scene.cloths[0];
    cloth.pins.clear();
    cloth.velocity = {1, 0, 0};
    cloth.material.damping = 0.1;
    Simulation<float> simulation(scene);
    const auto speed = [&] { return test::get(simulation.cloths()[0].particles().velocity, 4, 4).x(); };
    many_steps(simulation, 120);
    EXPECT_NEAR(speed(), std::exp(-0.5), 0.005);
    Material other = cloth.material;
    other.damping = 0.4;
    simulation.set_material(0, other);
    many_steps(simulation, 120);
    EXPECT_NEAR(speed(), std::exp(-2.5), 0.005);
  }
}

TEST(MaterialTune, WakesAClothThatSleeps) {
  SimulationDescription scene = hung_sheet(Bdf2Description{});
  scene.sleep_speed = 1e-4;
  scene.cloths[0].material.damping = 0.5;
  Simulation<float> simulation(scene);
  for (int step = 0; step < 2400 && !simulation.cloths()[0].asleep(); ++step) simulation.step();
  ASSERT_TRUE(simulation.cloths()[0].asleep());
  simulation.set_material(0, scene.cloths[0].material);
  EXPECT_TRUE(simulation.cloths()[0].asleep());
  Material softer = scene.cloths[0].material;
  softer.structural = softer.structural.warp / 10;
  simulation.set_material(0, softer);
  EXPECT_FALSE(simulation.cloths()[0].asleep());
}

TEST(MaterialTune, IsOfAClothsStateAndLevelsKeepIt) {
  SimulationDescription scene = hung_sheet(Bdf2Description{});
  scene.cloths[0].max_level = 4;
  Simulation<float> tuned(scene), copy(scene);
  many_steps(copy, 5);
  tuned.set_material(0, other_materials()[4]);
  many_steps(tuned, 10);
  copy.take_state(tuned);
  for (const int level : {4, 3}) {
    tuned.request_level(0, level);
    copy.request_level(0, level);
    many_steps(tuned, 10);
    many_steps(copy, 10);
    EXPECT_EQ(state_hash(tuned), state_hash(copy)) << level;
  }
  EXPECT_EQ(copy.cloths()[0].description().material, other_materials()[4]);
}

TEST(MaterialTune, ToAnythingInItsRangeEveryStepStaysFinite) {
  for (const IntegratorDescription& integrator : kMethodsOfMaterials) {
    SCOPED_TRACE(integrator.index());
    SimulationDescription scene = hung_sheet(integrator);
    // The stiffest need 10,000 substeps of symplectic Euler, each way.
    const bool explicit_method = std::holds_alternative<SymplecticEulerDescription>(integrator);
    Simulation<float> simulation(scene);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> share(0, 1);
    const auto any = [&](double low, double high) {
      const double least = std::max(low, 1e-6 * high);
      return low == 0 && share(random) < 0.1 ? 0 : least * std::pow(high / least, share(random));
    };
    for (int step = 0; step < (explicit_method ? 20 : 120); ++step) {
      Material material;
      material.structural = any(0, 1e9);
      material.shear = any(0, 1e9);
      material.bending = any(0, 1e9);
      material.damping = any(0, 1e6);
      material.rigidity = {any(0, 1e4), any(0, 1e4), any(0, 1e4)};
      material.limit = {any(1e-3, 10), any(1e-3, 10), any(1e-3, 1.5), any(1, 1000)};
      simulation.set_material(0, material);
      simulation.step();
      const Particles<float>& particles = simulation.cloths()[0].particles();
      test::each_node(particles.grid(), [&](int r, int c) {
        ASSERT_TRUE(test::get(particles.position, r, c).allFinite()) << step;
        ASSERT_TRUE(test::get(particles.velocity, r, c).allFinite()) << step;
      });
      if (HasFatalFailure()) return;
    }
    EXPECT_TRUE(simulation.healthy());
  }
}

/// A free sheet flat on a slope of 30 degrees.
SimulationDescription on_a_plane(const IntegratorDescription& integrator, double friction) {
  SimulationDescription scene = hung_sheet(integrator);
  scene.effects = {GravityEffect{}};
  ClothDescription& cloth = scene.cloths[0];
  cloth.pins.clear();
  const double tilt = std::acos(-1.0) / 6;
  cloth.orientation = Quaternion(Eigen::AngleAxisd(tilt - std::acos(-1.0) / 2, Vec3::UnitX()));
  const Vec3 normal(0, std::cos(tilt), std::sin(tilt));
  cloth.position = 1e-4 * normal;
  ObstacleDescription plane;
  plane.shape = PlaneDescription{normal};
  plane.friction = friction;
  scene.obstacles = {plane};
  return scene;
}

TEST(FrictionTuneSlow, LetsASheetGoThatItHeld) {
  // Coulomb on a slope: held where tan 30 = 0.577 is less than the coefficient, else it slides with
  // g (sin 30 - mu cos 30), T14.
  for (const IntegratorDescription& integrator : kMethodsOfMaterials) {
    SCOPED_TRACE(integrator.index());
    Simulation<float> simulation(on_a_plane(integrator, 0.8));
    many_steps(simulation, 60);
    const Vec3 held = simulation.centre(0);
    many_steps(simulation, 60);
    EXPECT_LT((simulation.centre(0) - held).norm(), 1e-4);
    ASSERT_TRUE(simulation.set_obstacle_friction(0, 0.2));
    many_steps(simulation, 60);
    const double slid = (simulation.centre(0) - held).norm();
    // For 1 s, but for two steps: so many may implicit friction take to see it, and so far ahead of the time
    // is backward Euler, by which nodes in contact go (half a step, and what the ledger gives back of it).
    const double acceleration = 9.81 * (0.5 - 0.2 * std::sqrt(3.0) / 2);
    const double off = 2.0 / 60;
    EXPECT_LT(slid, acceleration / 2 * (1 + off) * (1 + off));
    EXPECT_GT(slid, acceleration / 2 * (1 - off) * (1 - off));
    EXPECT_FALSE(simulation.set_obstacle_friction(1, 0.2));
  }
}

TEST(FrictionTune, OfABallIsAsIfItHadBeenDescribedSo) {
  for (const IntegratorDescription& integrator : kMethodsOfMaterials) {
    SCOPED_TRACE(integrator.index());
    SimulationDescription scene = on_a_plane(integrator, 0.3);
    scene.cloths[0].orientation = Quaternion(Eigen::AngleAxisd(-std::acos(-1.0) / 2, Vec3::UnitX()));
    scene.cloths[0].position = {0.1, 0.301, 0};
    scene.obstacles.clear();
    scene.balls = {BallDescription()};
    scene.balls[0].radius = 0.3;
    Simulation<float> slippery(scene), tuned(scene);
    many_steps(slippery, 30);
    scene.balls[0].friction = 0.7;
    Simulation<float> rough(scene);
    ASSERT_TRUE(tuned.set_ball_friction(1, 0.7));
    EXPECT_FALSE(tuned.set_ball_friction(2, 0.7));
    many_steps(rough, 30);
    many_steps(tuned, 30);
    EXPECT_EQ(state_hash(tuned), state_hash(rough));
    EXPECT_NE(state_hash(tuned), state_hash(slippery));
    tuned.reset();
    EXPECT_EQ(tuned.colliders().find(1)->friction, 0);
  }
}

IntegratorDescription without_ledger(IntegratorDescription integrator) {
  std::visit(
      [](auto& method) {
        if constexpr (requires { method.liveliness; }) method.liveliness = 0;
      },
      integrator);
  return integrator;
}

// What integrators remember of the steps before stays right: BDF2's moves, and what XPBD's damped springs
// hold, by spring. In wind and without the ledger: the books of the energy begin anew with a change.
TEST(MaterialTuneSlow, ThereAndBackBetweenTwoStepsChangesNoBit) {
  for (const IntegratorDescription& integrator : kMethodsOfMaterials) {
    SCOPED_TRACE(integrator.index());
    SimulationDescription scene = hung_sheet(without_ledger(integrator));
    scene.effects.push_back(StrainDampingEffect{0.01});
    scene.effects.push_back(AerodynamicsEffect{});
    scene.wind.speed = 1;
    Simulation<float> tuned(scene), untouched(scene);
    for (int step = 0; step < 20; ++step) {
      for (const Material& other : other_materials()) tuned.set_material(0, other);
      tuned.set_material(0, scene.cloths[0].material);
      tuned.step();
      untouched.step();
    }
    EXPECT_EQ(state_hash(tuned), state_hash(untouched));
  }
}

// Springs of next to no stiffness come before the others in the list, and nothing moves: XPBD's damped
// springs go on holding what each held, by 0.3 mm if they took another's.
TEST(MaterialTuneSlow, AddsSpringsToADampedSheetAtRest) {
  for (const IntegratorDescription& integrator : kMethodsOfMaterials) {
    SCOPED_TRACE(integrator.index());
    SimulationDescription scene = hung_sheet(integrator, 4);
    scene.effects = {GravityEffect{}, DampingEffect{}, StrainDampingEffect{0.5}};
    scene.cloths[0].material.bending = 0;
    Simulation<float> simulation(scene);
    many_steps(simulation, 600);
    const Particles<float> hung = simulation.cloths()[0].particles();
    Material with_bending = scene.cloths[0].material;
    with_bending.bending = 1e-9;
    simulation.set_material(0, with_bending);
    double farthest = 0;
    for (int step = 0; step < 3; ++step) {
      simulation.step();
      test::each_node(hung.grid(), [&](int r, int c) {
        const Vec3 now = simulation.cloths()[0].particles().position_at(r, c);
        farthest = std::max(farthest, (now - hung.position_at(r, c)).norm());
      });
    }
    EXPECT_LT(farthest, 1e-5);
  }
}

// Nor does what is refused.
TEST(FrictionTune, ToWhatItIsWakesNothing) {
  SimulationDescription scene = on_a_plane(Bdf2Description{}, 0.8);
  scene.sleep_speed = 1e-3;
  Simulation<float> simulation(scene);
  for (int step = 0; step < 1200 && !simulation.cloths()[0].asleep(); ++step) simulation.step();
  EXPECT_TRUE(simulation.set_obstacle_friction(0, 0.8));
  EXPECT_FALSE(simulation.set_obstacle_friction(1, 0.1));
  EXPECT_FALSE(simulation.set_ball_friction(7, 0.1));
  EXPECT_TRUE(simulation.cloths()[0].asleep());
}

TEST(FrictionTune, WakesWhatSleeps) {
  SimulationDescription scene = on_a_plane(Bdf2Description{}, 0.8);
  scene.sleep_speed = 1e-3;
  Simulation<float> simulation(scene);
  for (int step = 0; step < 1200 && !simulation.cloths()[0].asleep(); ++step) simulation.step();
  ASSERT_TRUE(simulation.cloths()[0].asleep());
  const Vec3 lay = simulation.centre(0);
  simulation.set_obstacle_friction(0, 0.1);
  many_steps(simulation, 60);
  EXPECT_GT((simulation.centre(0) - lay).norm(), 1);
}

}  // namespace
}  // namespace weft
