// The yardstick and the library do the same thing: same substeps, same positions up to rounding.
#include "baseline.h"

#include <gtest/gtest.h>

namespace weft::bench {
namespace {

SimulationDescription hung_cloth(int level) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.min_level = kMinLevel;
  cloth.initial_level = level;
  cloth.discretization = Discretization::paper;
  cloth.material.damping = 0.001;
  cloth.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}};
  cloth.perturbation = 0.001;
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{}, DampingEffect{}, PaperWindEffect{0.01, false}};
  scene.wind = {{0.6, 0, -0.8}, 1.5};
  scene.integrator = SymplecticEulerDescription{};
  return scene;
}

/// Largest distance between a particle of the one and of the other, m.
template <class Real>
double apart(const Simulation<Real>& simulation, const Baseline<Real>& baseline) {
  const Particles<Real>& state = simulation.cloths()[0].particles();
  double largest = 0;
  for (int r = 0; r < state.grid().rows; ++r) {
    for (int c = 0; c < state.grid().cols; ++c) {
      const auto& p = baseline.particles()[static_cast<std::size_t>(r * state.grid().cols + c)].position;
      largest = std::max(largest, (state.position_at(r, c) - Vec3(p.x, p.y, p.z)).norm());
    }
  }
  return largest;
}

/// Steps both from the simulation's first step on, `steps` times, and returns how far apart they came, m.
template <class Real>
double run_both(const SimulationDescription& scene, int steps, double* moved = nullptr) {
  Simulation<Real> simulation(scene);
  simulation.step();
  Baseline<Real> baseline(simulation, simulation.report(0).substeps);
  const Simulation<Real> start = Simulation<Real>(scene);
  for (int i = 0; i < steps; ++i) {
    simulation.step();
    baseline.step();
  }
  if (moved != nullptr) *moved = apart(start, baseline);
  return apart(simulation, baseline);
}

TEST(Baseline, HasTheSpringsOfFigure1) {
  // On 17 x 17 nodes: 2*17*16 structural, 2*16*16 shear, 2*17*15 bending.
  const Simulation<double> simulation(hung_cloth(4));
  const Baseline<double> baseline(simulation, 1);
  EXPECT_EQ(baseline.particles().size(), 289u);
  EXPECT_EQ(baseline.springs().size(), 544u + 512u + 510u);
}

TEST(Baseline, AgreesWithTheLibraryToRounding) {
  // Both add the same forces in another order, 1e-16 of them each time. A limp cloth multiplies a disturbance
  // by about 1e5 in a second (physics.md D); a third of a second leaves 1e-13 well under 1e-10 m.
  for (int level : {3, 4, 5}) {
    double moved = 0;
    EXPECT_LT(run_both<double>(hung_cloth(level), 20, &moved), 1e-10) << level;
    EXPECT_GT(moved, 0.1) << level;
  }
}

TEST(Baseline, AgreesWithABallInTheCloth) {
  SimulationDescription scene = hung_cloth(4);
  BallDescription ball;
  ball.position = {0.1, -0.1, -0.45};
  ball.radius = 0.4;
  ball.velocity = {0, 0, 1};
  scene.balls = {ball};
  EXPECT_LT(run_both<double>(scene, 20), 1e-9);
  // And the ball matters: without it the cloth ends elsewhere.
  Simulation<double> with(scene);
  scene.balls.clear();
  Simulation<double> without(scene);
  for (int i = 0; i < 20; ++i) {
    with.step();
    without.step();
  }
  EXPECT_GT(
      (with.cloths()[0].particles().position_at(8, 8) - without.cloths()[0].particles().position_at(8, 8))
          .norm(),
      0.05);
}

TEST(Baseline, RefusesWhatIsNotThePapersMethod) {
  SimulationDescription scene = hung_cloth(3);
  scene.effects.push_back(AerodynamicsEffect{});
  EXPECT_THROW(Baseline<double>(Simulation<double>(scene), 1), std::invalid_argument);
  scene = hung_cloth(3);
  scene.cloths[0].discretization = Discretization::continuum;
  EXPECT_THROW(Baseline<double>(Simulation<double>(scene), 1), std::invalid_argument);
  scene = hung_cloth(3);
  scene.effects = {PaperWindEffect{1.0, true}};
  EXPECT_THROW(Baseline<double>(Simulation<double>(scene), 1), std::invalid_argument);
}

}  // namespace
}  // namespace weft::bench
