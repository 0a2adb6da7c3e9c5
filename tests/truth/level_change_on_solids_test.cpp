// A change of level leaves cloth on the solids and on the other cloth that it lies on, whole and with no more
// energy than it had.
#include <gtest/gtest.h>

#include <numbers>

#include "draws.h"
#include "fixtures.h"
#include "methods.h"
#include "undamped.h"

namespace weft::test {
namespace {

/// Lies flat above the height, m.
ClothDescription flat(const std::string& fabric, double side, double height) {
  ClothDescription sheet;
  sheet.size = {side, side};
  sheet.position = {0, height, 0};
  sheet.orientation = Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX());
  sheet.material = find_fabric(fabric)->material;
  sheet.perturbation = 0.001;
  sheet.min_level = 3;
  sheet.max_level = 6;
  return sheet;
}

double highest(const Simulation<float>& simulation) {
  const Particles<float>& particles = simulation.cloths()[0].particles();
  double most = -1e9;
  each_node(particles.grid(), [&](int r, int c) { most = std::max(most, particles.position_at(r, c).y()); });
  return most;
}

void run(Simulation<float>& simulation, int level, double seconds) {
  for (Cloth<float>& cloth : simulation.cloths()) cloth.request_level(level);
  for (double time = 0; time < seconds; time += simulation.description().time_step) simulation.step();
}

constexpr std::array<const char*, 4> kFabrics{"silk", "cotton", "denim", "wool"};

class LevelChange : public ImplicitMethod {
 protected:
  LevelChange() {
    scene.effects = {GravityEffect{}, DampingEffect{}};
    scene.integrator = integrator();
    scene.obstacles = {{PlaneDescription{}, {0, 0, 0}, 0.4}};
  }
  SimulationDescription scene;
  Draws draws;
};

// 0.6 m of cloth or more hang on each side; cloth that came off would lie on the floor. A rail is as thick as
// a fifth of a coarse cell or more: cloth comes off some thinner ones.
TEST_P(LevelChange, ToACoarserOneLeavesClothOnItsRail) {
  constexpr std::array<std::array<int, 2>, 3> kLevels{{{6, 4}, {5, 4}, {6, 5}}};
  for (int k = 0; k < sample(16); ++k) {
    const auto [fine, coarse] = draws.one_of(kLevels);
    const double side = draws.between(1.2, 3), radius = side / (1 << coarse) * draws.between(0.1, 0.4);
    scene.cloths = {flat(draws.one_of(kFabrics), side, side + radius + 0.02)};
    scene.cloths[0].initial_level = fine;
    const Quaternion across(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()));
    scene.obstacles.resize(1);
    if (k % 3 < 2) {
      scene.obstacles.push_back({CapsuleDescription{radius, 4, across}, {0, side, 0}, 0.6});
    } else {
      scene.obstacles.push_back({BoxDescription{{4, 2 * radius, 2 * radius}}, {0, side, 0}, 0.6});
    }
    Simulation<float> simulation(scene);
    run(simulation, fine, 1.2);
    ASSERT_GT(highest(simulation), side + radius - 1e-3) << "rail " << k << " before";
    const double energy = state_energy(simulation).sum();
    run(simulation, coarse, 1);
    EXPECT_GT(highest(simulation), side + radius - 1e-3)
        << "rail " << k << ": " << radius << " m under " << side << " m, " << fine << " to " << coarse;
    EXPECT_LT(state_energy(simulation).sum(), energy * 1.001) << "rail " << k;
  }
}

// Over the sharp edge of a box, and more so at its corner, a spring may stay hooked, whose pull the side face
// bears: of 150 boxes drawn otherwise 3 have then more than 1.3 of the start's energy, up to 1.8 times.
TEST_P(LevelChange, ToAFinerOneHardlyStretchesClothOnATable) {
  constexpr std::array<std::array<int, 2>, 3> kLevels{{{4, 6}, {4, 5}, {5, 6}}};
  int hooked = 0;
  for (int k = 0; k < sample(16); ++k) {
    const double side = draws.between(1, 2.4), width = side * draws.between(0.3, 0.6);
    const auto [coarse, fine] = draws.one_of(kLevels);
    const double thickness = side / (1 << coarse) * draws.between(0.5, 2);
    const bool round = k % 2 == 0;
    scene.cloths = {flat(draws.one_of(kFabrics), side, side + 0.02)};
    scene.cloths[0].initial_level = coarse;
    scene.obstacles.resize(1);
    if (round) {
      const Quaternion across(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()));
      scene.obstacles.push_back(
          {CapsuleDescription{width / 3, width, across}, {0, side - width / 3, 0}, 0.4});
    } else {
      scene.obstacles.push_back({BoxDescription{{width, thickness, width * draws.between(0.7, 1.3)}},
                                 {0, side - thickness / 2, 0},
                                 0.4});
    }
    Simulation<float> simulation(scene);
    run(simulation, coarse, 1.2);
    const double energy = state_energy(simulation).sum();
    double most = 0;
    simulation.cloths()[0].request_level(fine);
    for (double time = 0; time < 0.5; time += scene.time_step) {
      simulation.step();
      most = std::max(most, state_energy(simulation).sum());
    }
    const std::string which = "table " + std::to_string(k) + ": " + std::to_string(width) + " m under " +
                              std::to_string(side) + " m, " + std::to_string(coarse) + " to " +
                              std::to_string(fine);
    hooked += most > 1.3 * energy || simulation.report(0).strain.max > 0.5 ? 1 : 0;
    if (!round) continue;
    EXPECT_LT(most, energy * 1.001) << which;
    EXPECT_LT(simulation.report(0).strain.max, 0.03) << which;
  }
  EXPECT_LE(hooked, 1);
}

TEST_P(LevelChange, KeepsTwoClothsApart) {
  constexpr std::array<std::array<int, 2>, 3> kLevels{{{4, 5}, {3, 5}, {5, 4}}};
  scene.effects.emplace_back(ClothContactEffect{});
  for (int k = 0; k < sample(6); ++k) {
    const double side = draws.between(1.2, 2), radius = side * draws.between(0.1, 0.25);
    const auto [from, to] = draws.one_of(kLevels);
    scene.cloths = {flat(draws.one_of(kFabrics), side, side + radius + 0.02),
                    flat(draws.one_of(kFabrics), side * draws.between(0.5, 0.9), side + radius + 0.06)};
    for (ClothDescription& cloth : scene.cloths) cloth.initial_level = from;
    scene.obstacles.resize(1);
    if (k % 2 == 0) {
      BallDescription ball;
      ball.position = {0, side, 0};
      ball.radius = radius;
      ball.friction = 0.4;
      scene.balls = {ball};
    } else {
      scene.balls.clear();
      scene.obstacles.push_back({BoxDescription{{2 * radius, 2 * radius, 2 * radius}}, {0, side, 0}, 0.4});
    }
    Simulation<float> simulation(scene);
    run(simulation, from, 1.2);
    ASSERT_EQ(simulation.layers()->tangled_nodes(), 0) << "before";
    run(simulation, to, 0.6);
    EXPECT_EQ(simulation.layers()->tangled_nodes(), 0)
        << "pair " << k << ": " << side << " m on " << radius << " m, " << from << " to " << to;
  }
}

INSTANTIATE_TEST_SUITE_P(Implicit, LevelChange, ::testing::Values(Method::bdf2), name_of_case);
INSTANTIATE_TEST_SUITE_P(Nightly, LevelChange, ::testing::ValuesIn(kImplicitMethods), name_of_case);

}  // namespace
}  // namespace weft::test
