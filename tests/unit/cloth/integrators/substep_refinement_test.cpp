// When XPBD's steps have more substeps than described: stretched and fast, struck, blown up, tangled.
#include "cloth/integrators/substep_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "cloth/world/simulation.h"
#include "rig.h"

namespace weft {
namespace {

using test::kFrame;
using test::Rig;
using test::sheet_rig;
using test::without_springs;

// --- Stretched and fast ---

/// Substeps of the next step of a sheet of 2 m and 8 x 8 cells whose columns are stretched by so much, and of
/// which one node goes so many of its springs' lengths in each of 10 substeps.
int substeps_when(double stretch, double lengths, const Material& material) {
  constexpr int kSubsteps = 10;
  constexpr double kLength = 0.25;
  Rig<double> rig = sheet_rig<double>(9, 9, XpbdDescription{kSubsteps}, {}, material);
  for (double& y : rig.particles.position.y.values()) y *= 1 + stretch;
  rig.particles.velocity.z.at(4, 4) = lengths * kLength / (kFrame / kSubsteps);
  return rig.advance(0, kFrame).substeps;
}

TEST(SubstepRefinement, AreSoManyInAStretchedSheetThatNoNodeGoesHalfOfASpring) {
  Material material = without_springs();
  material.structural = 5000;
  EXPECT_EQ(substeps_when(0.06, 0.49, material), 10);
  EXPECT_EQ(substeps_when(0.06, 0.51, material), 20);  // 0.255 in each
  EXPECT_EQ(substeps_when(0.06, 1.49, material), 30);
  EXPECT_EQ(substeps_when(0.06, 1.99, material), 40);
  EXPECT_EQ(substeps_when(0.06, 100, material), 40);  // four times at most
}

TEST(SubstepRefinement, StayInASheetThatIsNotStretchedOrTooMuchOrHasNothingToStretch) {
  Material material = without_springs();
  EXPECT_EQ(substeps_when(0.06, 100, material), 10);
  material.structural = 5000;
  EXPECT_EQ(substeps_when(0.04, 100, material), 10);
  EXPECT_EQ(substeps_when(0.49, 100, material), 40);
  EXPECT_EQ(substeps_when(0.51, 100, material), 10);
  EXPECT_EQ(substeps_when(0.06, 0, material), 10);
}

TEST(SubstepRefinement, FallBackOneByOneEachAfterACalmSecond) {
  Material material = without_springs();
  material.structural = 5000;
  Rig<double> rig = sheet_rig<double>(9, 9, XpbdDescription{10}, {}, material);
  for (double& y : rig.particles.position.y.values()) y *= 1.06;
  rig.particles.velocity.z.at(4, 4) = 1.2 * 0.25 / (kFrame / 10);
  std::vector<int> substeps;
  for (int step = 0; step < 125; ++step) {
    substeps.push_back(rig.advance(step * kFrame, kFrame).substeps);
    rig.particles.velocity.x.fill(0);
    rig.particles.velocity.y.fill(0);
    rig.particles.velocity.z.fill(0);
  }
  EXPECT_EQ(std::count(substeps.begin(), substeps.begin() + 61, 30), 61);
  EXPECT_EQ(std::count(substeps.begin() + 61, substeps.begin() + 122, 20), 61);
  EXPECT_EQ(std::count(substeps.begin() + 122, substeps.end(), 10), 3);
}

// --- Struck ---

/// A level sheet of 2 m at level 4.
SimulationDescription level_sheet() {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.min_level = cloth.max_level = cloth.initial_level = 4;
  cloth.orientation = Quaternion(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()));
  scene.cloths = {cloth};
  scene.integrator = XpbdDescription{};
  return scene;
}

int substeps_of_first_step(const SimulationDescription& scene) {
  Simulation<float> simulation(scene);
  simulation.step();
  return simulation.last_advance(0).substeps;
}

/// Where a ball of 0.1 m sets out at so many m/s downwards, 0.1 m over the middle of the sheet.
int substeps_when_struck(double speed, BallDescription::Motion motion) {
  SimulationDescription scene = level_sheet();
  BallDescription ball;
  ball.position = {0, 0.2, 0};
  ball.radius = 0.1;
  ball.velocity = {0, -speed, 0};
  ball.motion = motion;
  scene.balls = {ball};
  return substeps_of_first_step(scene);
}

/// Where the sheet falls at so many m/s onto this, whose top is 0.1 m below it.
int substeps_when_thrown(double speed, const ObstacleDescription& onto) {
  SimulationDescription scene = level_sheet();
  scene.cloths[0].velocity = {0, -speed, 0};
  scene.obstacles = {onto};
  return substeps_of_first_step(scene);
}

TEST(SubstepRefinement, AStrokeGoesNoDeeperThanATenthOfASpring) {
  // Of 0.125 m in substeps of 1/2400 s: 30 m/s. The node in the middle is struck head on.
  using Motion = BallDescription::Motion;
  EXPECT_EQ(substeps_when_struck(29.7, Motion::dynamic), 40);
  EXPECT_EQ(substeps_when_struck(30.3, Motion::dynamic), 80);
  EXPECT_EQ(substeps_when_struck(59.4, Motion::dynamic), 80);
  EXPECT_EQ(substeps_when_struck(60.6, Motion::dynamic), 120);
  EXPECT_EQ(substeps_when_struck(1000, Motion::dynamic), 160);
}

TEST(SubstepRefinement, AStrokeOfWhatStandsFirmGoesNoDeeperThan15HundredthsOfASpring) {
  // 45 m/s.
  EXPECT_EQ(substeps_when_struck(44.7, BallDescription::Motion::kinematic), 40);
  EXPECT_EQ(substeps_when_struck(45.3, BallDescription::Motion::kinematic), 80);
  const ObstacleDescription box{.shape = BoxDescription{{0.3, 0.2, 0.3}}, .position = {0, -0.2, 0}};
  EXPECT_EQ(substeps_when_thrown(44.7, box), 40);
  EXPECT_EQ(substeps_when_thrown(45.3, box), 80);
}

TEST(SubstepRefinement, WhatDoesNotStrikeAsksForNothingNorDoAWallAndSpringsThatAreSoftThemselves) {
  using Motion = BallDescription::Motion;
  EXPECT_EQ(substeps_when_struck(-1000, Motion::dynamic), 40);
  EXPECT_EQ(substeps_when_struck(5, Motion::dynamic), 40);  // is not there yet after the step
  EXPECT_EQ(substeps_when_thrown(1000, {.shape = PlaneDescription{}, .position = {0, -0.1, 0}}), 40);
  // Springs of 200 N/m have 4 % added by substeps between nodes of 0.4 kg / 256: 2 / 2400^2 / 0.00156 m/N.
  SimulationDescription scene = level_sheet();
  scene.cloths[0].velocity = {0, -1000, 0};
  scene.obstacles = {{.shape = BoxDescription{{0.3, 0.2, 0.3}}, .position = {0, -0.2, 0}}};
  scene.cloths[0].material.structural = 200;
  EXPECT_EQ(substeps_of_first_step(scene), 40);
}

// --- Blown up ---

TEST(SubstepRefinement, AreSoManyThatAPressedSheetBearsTwiceThePressure) {
  const auto substeps_at = [](double pressure) {
    Material material = without_springs();
    material.structural = 5000;
    return sheet_rig<double>(9, 9, XpbdDescription{10}, {InflationEffect{pressure}}, material)
        .advance(0, kFrame)
        .substeps;
  };
  // With n times the substeps of 1/600 s between masses of 0.4 kg / 64 springs are no stiffer than
  // 1 / (1/5000 + 8.89e-4 / n^2) N/m, which is to be the pressure times 2 m.
  EXPECT_EQ(substeps_at(459), 10);
  EXPECT_EQ(substeps_at(460), 20);
  EXPECT_EQ(substeps_at(-460), 20);
  EXPECT_EQ(substeps_at(1184), 20);
  EXPECT_EQ(substeps_at(1185), 30);
  EXPECT_EQ(substeps_at(1674), 40);
  EXPECT_EQ(substeps_at(1e6), 40);  // which bursts the springs by themselves
}

TEST(SubstepRefinement, AWindPressesAsMuchAsItsDynamicPressure) {
  const AerodynamicsEffect air;
  const auto substeps_in = [&](double pressure) {
    Material material = without_springs();
    material.structural = 5000;
    Rig<double> rig = sheet_rig<double>(9, 9, XpbdDescription{10}, {air}, material);
    rig.wind.direction = {0, 0, 1};  // head on
    rig.wind.speed = std::sqrt(2 * pressure / (air.air_density * air.drag));
    return rig.advance(0, kFrame).substeps;
  };
  EXPECT_EQ(substeps_in(459), 10);
  EXPECT_EQ(substeps_in(460), 20);
}

// --- Pulled ---

TEST(SubstepRefinement, AreSoManyThatAPatchBearsAHandsPull) {
  const auto substeps_at = [](double force) {
    SimulationDescription scene;  // a sheet of 2 m, 0.4 kg
    scene.integrator = XpbdDescription{10};
    ClothDescription cloth;
    cloth.min_level = cloth.max_level = cloth.initial_level = 3;
    cloth.size = {2, 2};
    cloth.material = without_springs();
    cloth.material.density = 0.1;
    cloth.material.structural = 5000;
    cloth.pins = {PinRegion{0, 1, 0, 0}};
    scene.cloths = {cloth};
    Simulation<float> simulation(scene);
    simulation.grab(0, {0.5, 0.5}, Vec3(0, 0, 1000), force);  // so far away that it pulls with all its force
    simulation.step();
    return simulation.last_advance(0).substeps;
  };
  // As above, where the pull by the patch, two cells of 2 m / 8, is to be the springs' stiffness: 459.5 N.
  EXPECT_EQ(substeps_at(459), 10);
  EXPECT_EQ(substeps_at(461), 20);
  EXPECT_EQ(substeps_at(1e6), 40);
}

// --- Tangled ---

/// Times the substeps after so many calm steps of a sheet that has just had 4 times as many, stretched by so
/// much. Of a spring's stretch 9 times as much as its own is the substeps' that it began with.
int times_after(int steps, double stretch) {
  constexpr double kSubstep = 1e-3;
  Material material = without_springs();
  // k h^2 2 / m = 9, where m = 0.4 kg / 64.
  material.structural = 9 * (0.4 / 64) / 2 / (kSubstep * kSubstep);
  const auto sheet = [&](double by) {
    Rig<double> rig = sheet_rig<double>(9, 9, XpbdDescription{}, {}, material);
    for (double& y : rig.particles.position.y.values()) y *= 1 + by;
    return rig;
  };
  SubstepRefinement<double> refinement;
  Rig<double> violent = sheet(0.06);
  violent.particles.velocity.z.at(4, 4) = 1e4;
  EXPECT_EQ(refinement.begin_step(violent.particles, violent.forces(0), nullptr, {}, kSubstep, kFrame), 4);
  const Rig<double> calm = sheet(stretch);
  int times = 4;
  for (int step = 0; step < steps; ++step) {
    times = refinement.begin_step(calm.particles, calm.forces(0), nullptr, {}, kSubstep, kFrame);
  }
  return times;
}

TEST(SubstepRefinement, StaysWhereFewerSubstepsWouldOverstretchSprings) {
  // With 4, 3, 2 times the substeps springs are left 1 + 9/16, 2, 3.25 times as stretched as by themselves.
  EXPECT_EQ(times_after(1000, 0.06), 4);   // by themselves 0.0384; with 3 times 0.077
  EXPECT_EQ(times_after(1000, 0.04), 4);   // 0.0256, 0.051
  EXPECT_EQ(times_after(1000, 0.038), 3);  // 0.0243, 0.049; as 0.038 with 3 times 0.019, with 2 times 0.062
  EXPECT_EQ(times_after(1000, 0.03), 2);   // 0.0192, 0.038; 0.015, 0.049; 0.0092, 0.092
  EXPECT_EQ(times_after(1000, 0.001), 1);
}

TEST(SubstepRefinement, IsGivenUpWhereSpringsAreStretchedByThemselves) {
  EXPECT_EQ(times_after(1000, 0.17), 1);  // 0.109 by themselves; as 0.17 with 3 times 0.085, with 2 0.052
}

}  // namespace
}  // namespace weft
