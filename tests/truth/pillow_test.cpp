// A pillow of two squares sewn together: what it holds, and that its gas keeps p V.
#include "cloth/sheet/diagnostics.h"
#include "cloth/world/simulation.h"
#include "methods.h"

namespace weft::test {
namespace {

/// Of two squares of 1 m, nearly inextensible, in still air and without weight.
SimulationDescription pillow(const IntegratorDescription& integrator, int level, const InflationEffect& gas) {
  SimulationDescription scene;
  scene.integrator = integrator;
  scene.sleep_speed = 0;
  ClothDescription& cloth = scene.cloths.emplace_back();
  cloth.sewn = true;
  cloth.size = {2, 1};
  cloth.base_cells = {2, 1};
  cloth.min_level = 3;
  cloth.max_level = cloth.initial_level = level;
  cloth.material.density = 0.2;
  cloth.material.structural = 50000;
  cloth.material.shear = 5000;
  cloth.material.bending = 0;
  cloth.material.damping = 1;
  scene.effects = {DampingEffect{}, StrainDampingEffect{0.002}, gas};
  return scene;
}

double volume_after(const SimulationDescription& scene, double seconds) {
  Simulation<double> simulation(scene);
  for (int step = 0; step < seconds / scene.time_step; ++step) simulation.step();
  return enclosed_volume(simulation.cloths()[0].particles().position);
}

// The teabag problem: a square bag of inextensible sheet, 1 m a side, can hold between 0.2055 and 0.2172 m3
// (Kepert's bounds, as Wikipedia's "Paper bag problem" gives them; Robin, Paper Bag Problem, Mathematics
// Today, June 2004, estimates 0.19 and 0.2017). Cells cannot crumple below their own size, so that each level
// lacks some volume in proportion to that size. Which of its many equilibria a bag finds is chance, worth
// 0.003 m3 at level 4: several are blown up, each with offsets of its own, as a perfectly flat one is no
// usual one.
TEST(PillowNightly, HoldsWhatASquareTeabagHolds) {
  constexpr int kBags = 3;
  const auto held = [](int level) {
    double sum = 0;
    for (int bag = 1; bag <= kBags; ++bag) {
      SimulationDescription scene = pillow(BackwardEulerDescription{}, level, {50, {}, 0});
      scene.cloths[0].perturbation = 1e-3;
      scene.seed = static_cast<std::uint64_t>(bag);
      sum += volume_after(scene, 4);
    }
    return sum / kBags;
  };
  const double coarse = held(4), middle = held(5), fine = held(6);
  EXPECT_LT(coarse, middle);
  EXPECT_LT(middle, fine);
  EXPECT_GT(fine, 0.18);
  EXPECT_LT(fine, 0.2172 * 1.01);  // it stretches by 50 Pa * 0.3 m / 50000 N/m
  // What cells of no size would hold (Richardson), from either pair of levels.
  for (const double limit : {2 * middle - coarse, 2 * fine - middle}) {
    EXPECT_GT(limit, 0.19);
    EXPECT_LT(limit, 0.2172 * 1.01);
  }
}

// Filled with what has no pressure in 0.05 m3, which the bag can hold at this level, it holds that, p_a (0.05
// / V - 1) being no more than what little the sheet resists: some 10 Pa, 1e-4 of p_a.
class Boyle : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Methods, Boyle, ::testing::ValuesIn(kMethods), name_of_case);

TEST_P(Boyle, LimpPillowHoldsItsGasAtThePressureOutside) {
  const int substeps = GetParam() == Method::symplectic_euler ? 0 : GetParam() == Method::xpbd ? 100 : 1;
  const double volume = volume_after(pillow(stepping(GetParam(), substeps, 4), 3, {0, 0.05, 0.5}), 2);
  EXPECT_NEAR(volume, 0.05, 0.05 * 2e-4);
}

// Gas in a bag pushes it as a whole nowhere: thrown up, it falls as everything does.
class Thrown : public ImplicitMethod {};
INSTANTIATE_TEST_SUITE_P(Implicit, Thrown, ::testing::ValuesIn(kImplicitMethods), name_of_case);

TEST_P(Thrown, PillowFallsAsEverythingDoes) {
  for (const int level : {3, 4, 5}) {
    SimulationDescription scene = pillow(integrator(), level, {50, 0.05, 0.5});
    scene.cloths[0].velocity = {1, 5, 0};
    scene.effects = {GravityEffect{}, InflationEffect{50, 0.05, 0.5}};
    Simulation<float> simulation(scene);
    for (int step = 0; step < 120; ++step) simulation.step();
    const Particles<float>& particles = simulation.cloths()[0].particles();
    const Vec3 velocity = linear_momentum(particles) / total_mass(particles);
    // Velocities of single precision, to each of which 120 steps add.
    EXPECT_LT((velocity - Vec3(1, 5 - 2 * 9.81, 0)).norm(), 0.01) << level;
  }
}

/// Angular momentum about its centre of mass, N m s.
Vec3 spin(const Particles<float>& particles) {
  return angular_momentum(particles) - centre_of_mass(particles).cross(linear_momentum(particles));
}

// Gravity has no torque about the centre of mass, and how fast a bag goes as a whole nobody sees: thrown
// level it does not begin to spin (Galilei). Its radius of gyration is about 0.4 m.
TEST_P(Thrown, PillowDoesNotBeginToSpin) {
  for (const int level : {3, 4}) {
    for (const double speed : {5.0, -10.0}) {
      SimulationDescription scene = pillow(integrator(), level, {50, 0.05, 0.5});
      scene.cloths[0].velocity = {speed, 0, 0};
      scene.effects = {GravityEffect{}, InflationEffect{50, 0.05, 0.5}};
      Simulation<float> simulation(scene);
      for (int step = 0; step < 60; ++step) {
        simulation.step();
        const Particles<float>& particles = simulation.cloths()[0].particles();
        const double mass = total_mass(particles);
        ASSERT_LT(spin(particles).norm(), mass * 0.4 * 0.4 * 0.02) << level << " " << step;  // 0.02 rad/s
      }
    }
  }
}

}  // namespace
}  // namespace weft::test
