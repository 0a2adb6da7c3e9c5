#include "cloth/integrators/body_energy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "rig.h"

namespace weft {
namespace {

constexpr double kStep = 1.0 / 60;

/// A sheet of 0.4 kg at rest, without effects, and a ball of 2 kg.
struct SheetAndBall {
  test::Rig<double> rig = test::sheet_rig<double>(6, 6, BackwardEulerDescription{});
  std::vector<Solid> solids{1};
  BodyEnergy<double> energy;

  SheetAndBall() {
    solids[0].shape = Sphere{0.1};
    solids[0].inverse_mass = 0.5;
  }
  /// A step that takes the ball from one speed to another and gives all nodes that of the sheet, m/s.
  AdvanceReport step(double ball_from, double ball_to, double sheet) {
    solids[0].velocity = {ball_from, 0, 0};
    energy.begin(rig.particles, rig.forces(0), solids, kStep);
    solids[0].velocity = {ball_to, 0, 0};
    test::each_node(rig.particles.grid(), [&](int r, int c) {
      test::set(rig.particles.velocity, r, c, {sheet, 0, 0});
    });
    AdvanceReport report;
    energy.judge(rig.particles, rig.forces(0), solids, report);
    return report;
  }
};

TEST(BodyEnergy, WhatTheBallLosesTheSheetMayGain) {
  // From 3 to 2 m/s the ball loses 5 J; the sheet has 4.05 J at 4.5 m/s.
  EXPECT_EQ(SheetAndBall().step(3, 2, 4.5).gained, 0);
}

TEST(BodyEnergy, MoreIsTold) {
  const AdvanceReport report = SheetAndBall().step(3, 2, 6);
  EXPECT_NEAR(report.gained, 0.5 * 0.4 * 36, 1e-12);
  // Lost, and 0.05 of the ball's 9 J and of what gravity gives 2.4 kg in the step.
  EXPECT_NEAR(report.could_give, 5 + 0.05 * (9 + 0.5 * 2.4 * 9.81 * 9.81 * kStep * kStep), 1e-12);
}

/// Pulls the whole sheet along x.
struct Pull : Effect<double> {
  double force = 0;  // N
  const char* name() const override { return "pull"; }
  void add_forces(const Particles<double>& particles, const EffectContext&,
                  VectorField<double>& sum) const override {
    test::each_node(particles.grid(),
                    [&](int r, int c) { sum.x.at(r, c) += force / particles.grid().nodes(); });
  }
};

// Of a force that is there as the step begins and gone as it ends, as the air's is once the cloth goes with
// it, or comes in it, the work over all the way may have been done: 1 m of 2 N, beside the 5 J that the ball
// loses and a twentieth of what there is.
TEST(BodyEnergy, AForceAtEitherEndOfTheStepMayHaveWorked) {
  const double least = 5 + 0.05 * (9 + 0.5 * 2.4 * 9.81 * 9.81 * kStep * kStep);
  for (const std::pair<double, double>& forces :
       {std::pair(2.0, 0.0), std::pair(0.0, 2.0), std::pair(-2.0, 1.0), std::pair(1.0, -2.0)}) {
    SheetAndBall scene;
    auto owned = std::make_unique<Pull>();
    Pull& pull = *owned;
    scene.rig.effects.push_back(std::move(owned));
    const auto step = [&](double speed) {
      scene.solids[0].velocity = {3, 0, 0};
      pull.force = forces.first;
      scene.energy.begin(scene.rig.particles, scene.rig.forces(0), scene.solids, kStep);
      scene.solids[0].velocity = {2, 0, 0};
      pull.force = forces.second;
      test::each_node(scene.rig.particles.grid(), [&](int r, int c) {
        scene.rig.particles.position.x.at(r, c) += 1;
        test::set(scene.rig.particles.velocity, r, c, {speed, 0, 0});
      });
      AdvanceReport report;
      scene.energy.judge(scene.rig.particles, scene.rig.forces(0), scene.solids, report);
      test::each_node(scene.rig.particles.grid(), [&](int r, int c) {
        test::set(scene.rig.particles.velocity, r, c, {0, 0, 0});
      });
      return report;
    };
    EXPECT_EQ(step(std::sqrt((least + 1.9) / 0.2)).gained, 0) << forces.first << ' ' << forces.second;
    EXPECT_NEAR(step(std::sqrt((least + 2.1) / 0.2)).could_give, least + 2, 1e-9)
        << forces.first << ' ' << forces.second;
  }
}

TEST(BodyEnergy, WhatSpringsThatBearWeightGiveIsNotTold) {
  // From rest the ball is pushed to 12 mm/s, as by the springs that hold it off a floor, and the sheet to a
  // thousandth of that.
  EXPECT_EQ(SheetAndBall().step(0, 0.012, 1.2e-5).gained, 0);
}

}  // namespace
}  // namespace weft
