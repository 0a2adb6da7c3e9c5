// XPBD under bad conditions, and what its results must not depend on.
#include <gtest/gtest.h>

#include <numbers>

#include "cloth/sheet/diagnostics.h"
#include "cloth/world/simulation.h"
#include "rig.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::hung_rig;
using test::kFrame;
using test::Rig;
using test::set;

// --- Stability ---

/// Puts the nodes in some hopeless state.
enum class Start { random, point, line, folded };

void scramble(Start start, Particles<float>& particles) {
  if (start == Start::random) return test::randomise(particles.position, -1, 1, 7);
  each_node(particles.grid(), [&](int r, int c) {
    const Vec3 at = particles.position_at(r, c);
    if (start == Start::point) set(particles.position, r, c, {0, 0, 0});
    if (start == Start::line) set(particles.position, r, c, {at.x(), 0, 0});
    if (start == Start::folded && r % 2 == 1) set(particles.position, r, c, {-at.x(), at.y(), at.z()});
  });
}

TEST(XpbdStability, NoStiffnessSubstepOrStartBlowsUpSlow) {
  // Hung by two corners, 5 s. No node gets farther than the start (1.7 m from the middle), the sheet's
  // diagonal (2.8 m), for the softest as much again for its weight, and what the substep adds along N cells,
  // g h^2 N^2 / 2, twice for the fall that leads there.
  for (const double stiffness : {1e-1, 5e3, 1e7}) {
    for (const Start start : {Start::random, Start::point, Start::line, Start::folded}) {
      for (const auto& [substeps, dt] :
           std::vector<std::pair<int, double>>{{1, kFrame}, {20, kFrame}, {1, 1.0}}) {
        Material material;
        material.structural = stiffness;
        Rig<float> rig = hung_rig<float>(17, 17, XpbdDescription{substeps}, {GravityEffect{}}, material);
        scramble(start, rig.particles);
        const double h = dt / substeps;
        const double reach = 5 + 2 * 9.81 * h * h * 16 * 16 + (stiffness < 1 ? 3 : 0);
        double farthest = 0;
        for (double time = 0; time < 5; time += dt) {
          rig.advance(time, dt);
          each_node(rig.particles.grid(), [&](int r, int c) {
            farthest = std::max(farthest, rig.particles.position_at(r, c).norm());
          });
        }
        EXPECT_TRUE(is_finite(rig.particles)) << stiffness << " N/m, start " << int(start) << ", h = " << h;
        EXPECT_LT(farthest, reach) << stiffness << " N/m, start " << int(start) << ", h = " << h;
      }
    }
  }
}

// Nothing but the sheet's own bending is there to be lost. With damped springs that were left their long
// memory beside a plate faster than the substeps, some of these had 1e9 J after two seconds.
TEST(XpbdStability, DampedSpringsBesideAStiffPlateGainNoEnergySlow) {
  for (const double size : {0.08, 0.5}) {
    for (const double rigidity : {1e-2, 1.0}) {
      for (const double time : {0.01, 0.1}) {
        for (const double stiffness : {5e2, 5e4}) {
          SimulationDescription scene;
          ClothDescription sheet;
          sheet.size = {size, size};
          sheet.min_level = sheet.max_level = sheet.initial_level = 4;
          sheet.material.structural = stiffness;
          sheet.material.rigidity = {rigidity, rigidity, rigidity};
          sheet.perturbation = 1e-3 * size;
          scene.cloths = {sheet};
          scene.effects = {StrainDampingEffect{time}, PlateBendingEffect{}};
          scene.integrator = XpbdDescription{};
          scene.sleep_speed = 0;
          Simulation<float> simulation(scene);
          const auto energy = [&] {
            const ClothReport report = simulation.report(0);
            return report.kinetic_energy + report.potential_energy;
          };
          const double start = energy();
          double most = start;
          for (int step = 0; step < 60; ++step) {
            simulation.step();
            most = std::max(most, energy());
          }
          EXPECT_LE(most, 1.001 * start + 1e-6)
              << size << " m, " << rigidity << " N m, " << time << " s, " << stiffness << " N/m";
        }
      }
    }
  }
}

TEST(XpbdStability, ComesToRest) {
  // The sweep is what decides it: orders that change between substeps, or springs corrected by more than
  // their share, leave metres a second. Shaken by 1 m/s at the start and damped at 2/s, e^-16 of that is left
  // after 8 s but for the slow sway of folds, which the drag all but stops: under 1 mm/s.
  for (const double stiffness : {50.0, 5e3, 1e7}) {
    Material material;
    material.structural = stiffness;
    material.damping = 0.2;
    Rig<double> rig =
        hung_rig<double>(17, 17, XpbdDescription{10}, {GravityEffect{}, DampingEffect{}}, material);
    test::randomise(rig.particles.velocity, -1, 1, 3);
    for (int c : {0, 16}) set(rig.particles.velocity, 0, c, {0, 0, 0});
    for (int step = 0; step < 480; ++step) rig.advance(step * kFrame, kFrame);
    EXPECT_LT(std::sqrt(2 * kinetic_energy(rig.particles) / 0.4), 1e-3) << stiffness;
  }
}

// --- What it must not depend on ---

TEST(XpbdPrecision, FloatFollowsDouble) {
  Rig<float> single = hung_rig<float>(17, 17, XpbdDescription{20}, {GravityEffect{}, DampingEffect{}});
  Rig<double> twice = hung_rig<double>(17, 17, XpbdDescription{20}, {GravityEffect{}, DampingEffect{}});
  for (int step = 0; step < 60; ++step) {
    single.advance(step * kFrame, kFrame);
    twice.advance(step * kFrame, kFrame);
  }
  // 1200 substeps, each rounding positions by 6e-8 m: 7e-5 m if every rounding went one way.
  EXPECT_LT(test::largest_difference(single.particles.position, twice.particles.position), 5e-5);
}

TEST(XpbdSymmetry, MirrorImagesDifferOnlyByTheSweepsOrder) {
  // Left and right hand are projected one after the other. What that leaves falls like the sweep's other
  // error, with the square of the substep: 16 times between 10 and 40.
  const auto asymmetry = [](int substeps) {
    Rig<double> rig = hung_rig<double>(17, 17, XpbdDescription{substeps}, {GravityEffect{}, DampingEffect{}});
    for (int step = 0; step < 30; ++step) rig.advance(step * kFrame, kFrame);
    double largest = 0;
    each_node(rig.particles.grid(), [&](int r, int c) {
      const Vec3 left = rig.particles.position_at(r, c), right = rig.particles.position_at(r, 16 - c);
      largest = std::max(largest, (left - Vec3(-right.x(), right.y(), right.z())).norm());
    });
    return largest;
  };
  const double coarse = asymmetry(10), fine = asymmetry(40);
  EXPECT_LT(coarse, 0.005);
  EXPECT_LT(fine, coarse / 8);
}

TEST(XpbdHeldNodes, StayWhateverPulls) {
  Rig<float> rig = hung_rig<float>(9, 9, XpbdDescription{5}, {GravityEffect{}});
  const Particles<float> start = rig.particles;
  for (int step = 0; step < 60; ++step) rig.advance(step * kFrame, kFrame);
  for (int c : {0, 8}) {
    EXPECT_EQ(rig.particles.position_at(0, c), start.position_at(0, c));
    EXPECT_EQ(rig.particles.velocity_at(0, c), Vec3(0, 0, 0));
    EXPECT_EQ(get(rig.particles.acceleration, 0, c), Vec3(0, 0, 0));
  }
  EXPECT_LT(rig.particles.position_at(8, 4).y(), start.position_at(8, 4).y());
}

TEST(XpbdRun, TwiceGivesTheSameBitsAcrossLevels) {
  const auto run = [] {
    SimulationDescription scene;
    ClothDescription cloth;
    cloth.min_level = 3;
    cloth.initial_level = 4;
    cloth.base_cells = {2, 1};
    cloth.pins = {{0, 0, 0, 1}};
    scene.cloths = {cloth};
    scene.effects = {GravityEffect{}, DampingEffect{}, AerodynamicsEffect{}};
    scene.wind = {{0, 0, -1}, 4.0};
    scene.integrator = XpbdDescription{};
    Simulation<float> simulation(scene);
    for (int frame = 0; frame < 60; ++frame) {
      if (frame % 20 == 10) simulation.request_level(0, frame == 30 ? 5 : 3);
      simulation.step();
    }
    return simulation.cloths()[0].particles();
  };
  const Particles<float> once = run();
  EXPECT_TRUE(is_finite(once));
  EXPECT_TRUE(test::same_state(once, run()));
}

// --- Contact ---

TEST(XpbdContact, NoNodeIsLeftInsideABall) {
  // A free sheet falls onto a ball, and a ball at 30 m/s flies into it: resolved at the end of every substep.
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.min_level = cloth.max_level = cloth.initial_level = 5;
  cloth.orientation = Quaternion(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()));
  scene.cloths = {cloth};
  BallDescription resting, flying;
  resting.position = {0, -0.35, 0};
  resting.radius = 0.3;
  flying.position = {-0.5, 10, 0.4};
  flying.velocity = {0, -30, 0};
  scene.balls = {resting, flying};
  scene.effects = {GravityEffect{}, DampingEffect{}};
  scene.integrator = XpbdDescription{};
  Simulation<float> simulation(scene);
  std::uint64_t touched = 0;
  for (int frame = 0; frame < 60; ++frame) {
    simulation.step();
    const auto& particles = simulation.cloths()[0].particles();
    ASSERT_TRUE(is_finite(particles));
    each_node(particles.grid(), [&](int r, int c) {
      for (const Ball& ball : simulation.colliders().balls()) {
        ASSERT_GE((particles.position_at(r, c) - ball.position).norm(), ball.radius) << frame;
      }
    });
    touched = simulation.cloths()[0].contact_counters().nodes_in_contact;
  }
  EXPECT_GT(touched, 1000u);
}

}  // namespace
}  // namespace weft
