// What a level change puts into the springs comes out again, without motion.
#include "cloth/levels/settle.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cloth/sheet/diagnostics.h"
#include "cloth/world/simulation.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;
using test::set;

const Vec2 kSize{2, 2};

/// The fine sheet rolled about the y axis, radius 0.2 m, so that its structural springs are not strained:
/// each spans an angle of 2 asin(h / 2 R).
Particles<double> rolled(int rows) {
  Particles<double> sheet = test::flat_sheet<double>(rows, rows, kSize);
  const double h = kSize.x() / (rows - 1), radius = 0.2, angle = 2 * std::asin(h / (2 * radius));
  each_node(sheet.grid(), [&](int r, int c) {
    const double turned = angle * (c - (rows - 1) / 2.0);
    set(sheet.position, r, c, {radius * std::sin(turned), -h * r, radius * std::cos(turned)});
    set(sheet.velocity, r, c, {1, 2, 3});
  });
  return sheet;
}

struct Merged {
  ClothDescription cloth;
  Particles<double> sheet;
  Springs<double> springs;

  Merged()
      : sheet(test::flat_sheet<double>(17, 17, kSize)),
        springs(cloth.material, cloth.discretization, kSize, sheet.grid()) {
    merge(rolled(33), sheet);
    test::share_mass(sheet, 0.4, Discretization::continuum);
  }
  double compression() const { return springs.structural_strain(sheet.position).max_compression; }
};

TEST(Settle, TakesOutWhatAMergePutsIntoTheSpringsAcrossAFold) {
  // The coarse springs span two fine ones: shorter than rest by 1 - cos(asin(h / 2 R)), h the fine cell.
  Merged merged;
  EXPECT_NEAR(merged.compression(), 1 - std::cos(std::asin(0.0625 / 0.4)), 1e-12);
  const double before = merged.springs.energy(merged.sheet.position);
  const Sheet<double> resisting(merged.springs);
  settle<double>(merged.sheet, Unsettled::by_level,
                 {.sheet = &resisting, .context = {.cloth = &merged.cloth}}, nullptr, {}, 1.0 / 60);
  EXPECT_LT(merged.compression(), 0.1 * (1 - std::cos(std::asin(0.0625 / 0.4))));
  EXPECT_LT(merged.springs.energy(merged.sheet.position), 0.1 * before);
  each_node(merged.sheet.grid(),
            [&](int r, int c) { EXPECT_EQ(merged.sheet.velocity_at(r, c), Vec3(1, 2, 3)); });
}

// A sheet that swings and crumples from one corner: its folds, which the coarser grid has not, would expand
// against the pin and lift it. Energy may not rise, to the rounding of single precision.
TEST(Settle, AMergeBringsInNoEnergyWhereThereIsMotionToTakeItFrom) {
  for (const IntegratorDescription& method :
       {IntegratorDescription(Bdf2Description{}), IntegratorDescription(BackwardEulerDescription{}),
        IntegratorDescription(XpbdDescription{}), IntegratorDescription(SymplecticEulerDescription{})}) {
    SimulationDescription scene;
    scene.integrator = method;
    scene.effects = {GravityEffect{}};
    scene.cloths.resize(1);
    ClothDescription& cloth = scene.cloths[0];
    cloth.pins = {PinRegion{0.1, 0.1, 0.2, 0.2}};
    cloth.orientation = Quaternion(Eigen::AngleAxisd(-1.3, Vec3(1, 0.2, 0).normalized()));
    cloth.min_level = 3;
    cloth.max_level = cloth.initial_level = 5;
    Simulation<float> simulation(scene);
    Cloth<float>& sheet = simulation.cloths()[0];
    const auto energy = [&] {
      return sheet.elastic_energy() + kinetic_energy(sheet.particles()) +
             gravitational_energy(sheet.particles(), simulation.gravity());
    };
    for (const int level : {4, 3, 4, 5, 4, 3}) {
      for (int step = 0; step < 5; ++step) simulation.step();
      const double before = energy();
      sheet.request_level(level);
      sheet.apply_pending_level();
      std::vector<Solid> none;
      if (sheet.unsettled(none)) sheet.settle_down(none, simulation.time());
      EXPECT_LE(energy(), before + 1e-5 * std::abs(before)) << "to level " << level;
    }
  }
}

TEST(Settle, LeavesAFlatSheetWhereItIs) {
  Particles<double> sheet = test::flat_sheet<double>(17, 17, kSize);
  test::share_mass(sheet, 0.4, Discretization::continuum);
  const Particles<double> before = sheet;
  const ClothDescription cloth;
  const Sheet<double> resisting(Springs<double>(cloth.material, cloth.discretization, kSize, sheet.grid()));
  settle<double>(sheet, Unsettled::by_level, {.sheet = &resisting, .context = {.cloth = &cloth}}, nullptr, {},
                 1.0 / 60);
  each_node(sheet.grid(), [&](int r, int c) {
    EXPECT_LT((sheet.position_at(r, c) - before.position_at(r, c)).norm(), 1e-12);
  });
}

TEST(Settle, LetsNodesOutOfABallPutOntoThemWithoutMotion) {
  Particles<double> sheet = test::flat_sheet<double>(17, 17, kSize);
  test::share_mass(sheet, 0.4, Discretization::continuum);
  each_node(sheet.grid(), [&](int r, int c) { set(sheet.velocity, r, c, {1, 2, 3}); });
  const ClothDescription cloth;
  const Sheet<double> resisting(Springs<double>(cloth.material, cloth.discretization, kSize, sheet.grid()));
  Contact<double> contact(sheet.grid());
  // Half of the ball is above the sheet's middle.
  Solid ball{.id = 1, .shape = Sphere{0.3}};
  ball.start = ball.position = sheet.position_at(8, 8);
  EXPECT_FALSE(is_put_onto(sheet, contact, {ball}));  // it was there before
  ball.just_put = true;
  EXPECT_TRUE(is_put_onto(sheet, contact, {ball}));
  settle<double>(sheet, Unsettled::by_solid, {.sheet = &resisting, .context = {.cloth = &cloth}}, &contact,
                 {ball}, 1.0 / 60);
  EXPECT_FALSE(is_put_onto(sheet, contact, {ball}));
  each_node(sheet.grid(), [&](int r, int c) {
    EXPECT_GE((sheet.position_at(r, c) - ball.position).norm(), 0.3);
    EXPECT_EQ(sheet.velocity_at(r, c), Vec3(1, 2, 3));
  });
}

TEST(Settle, TheLevelOfAHungSheetChangedForEverDoesNotShakeIt) {
  // XPBD hangs longer the finer the level; what a merge finds too long must not become motion. Nothing moves
  // it: it stays slower than what falling by its stretch, under 5 cm, would give it.
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.min_level = 4;
  cloth.initial_level = 5;
  cloth.pins = {{0, 1, 0, 0}};
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{}, DampingEffect{}};
  scene.integrator = XpbdDescription{};
  Simulation<float> simulation(scene);
  constexpr int kLevels[] = {4, 5, 6, 5};
  for (int step = 0; step < 240; ++step) {
    simulation.request_level(0, kLevels[step % 4]);
    simulation.step();
    EXPECT_LT(simulation.report(0).kinetic_energy, 0.4 * 9.81 * 0.05) << step;
  }
}

}  // namespace
}  // namespace weft
