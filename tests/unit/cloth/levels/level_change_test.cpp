// A change of level leaves the same state whatever steps the cloth, and takes nothing that it had.
#include <cmath>

#include "cloth/sheet/diagnostics.h"
#include "cloth/world/simulation.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;

const IntegratorDescription kEveryMethod[] = {Bdf2Description{}, BackwardEulerDescription{},
                                              XpbdDescription{}, SymplecticEulerDescription{}};

/// 2 m of cloth at level 5 in waves of four cells, 3 cm high, that falls.
SimulationDescription falling_waves(const IntegratorDescription& method) {
  SimulationDescription scene;
  scene.integrator = method;
  scene.effects = {GravityEffect{}};
  ClothDescription& cloth = scene.cloths.emplace_back();
  cloth.min_level = 3;
  cloth.initial_level = 5;
  cloth.pins = {{0, 0, 0, 0}};
  cloth.velocity = {0.1, -0.5, 0.2};
  for (int r = 0; r <= 32; ++r) {
    for (int c = 0; c <= 32; ++c) {
      const double wave = std::sin(1.5707963267948966 * c + 0.3 * r);
      cloth.nodes.push_back(Vec3(c / 16.0 - 1, 0.03 * wave, r / 16.0 - 1));
    }
  }
  return scene;
}

/// Reaches into the waves.
std::vector<Solid> ball_below() {
  Solid ball{.id = 1, .shape = Sphere{0.3}};
  ball.start = ball.position = {0, -0.31, 0};
  return {ball};
}

/// The cloth's level changed, and what is to be relaxed relaxed.
const Particles<float>& changed(Simulation<float>& simulation, int level, const std::vector<Solid>& solids) {
  Cloth<float>& cloth = simulation.cloths()[0];
  cloth.request_level(level);
  EXPECT_TRUE(cloth.apply_pending_level());
  if (cloth.unsettled(solids)) cloth.settle_down(solids, simulation.time());
  return cloth.particles();
}

TEST(LevelChange, LeavesTheSameBitsWhateverStepsTheCloth) {
  for (const int level : {3, 4, 6}) {
    Simulation<float> first(falling_waves(kEveryMethod[0]));
    const Particles<float>& expected = changed(first, level, ball_below());
    for (const IntegratorDescription& method : kEveryMethod) {
      Simulation<float> other(falling_waves(method));
      const Particles<float>& found = changed(other, level, ball_below());
      int differing = 0;
      each_node(expected.grid(), [&](int r, int c) {
        differing += expected.position_at(r, c) != found.position_at(r, c) ||
                     expected.velocity_at(r, c) != found.velocity_at(r, c);
      });
      EXPECT_EQ(differing, 0) << "level " << level << ", method " << method.index();
    }
  }
}

// Two springs in a row pull as the one that they stand for: nothing is relaxed, though they hold 1 J.
TEST(LevelChange, ASplitKeepsSharedNodesAndTheSpringsEnergy) {
  for (const IntegratorDescription& method : kEveryMethod) {
    SimulationDescription scene;
    scene.integrator = method;
    scene.effects = {GravityEffect{}};
    ClothDescription& cloth = scene.cloths.emplace_back();
    cloth.min_level = cloth.initial_level = 4;
    cloth.pins = {{0, 1, 0, 0}};
    Simulation<float> simulation(scene);
    Cloth<float>& sheet = simulation.cloths()[0];
    each_node(sheet.particles().grid(), [&](int r, int c) {
      sheet.particles().position.y.at(r, c) *= 1.01F;
      sheet.particles().velocity.z.at(r, c) = 0.1F * static_cast<float>(r);
    });
    sheet.moved_from_outside();
    const Particles<float> before = sheet.particles();
    const double held = sheet.elastic_energy();
    EXPECT_GT(held, 0.01);
    for (const int level : {5, 6}) changed(simulation, level, {});
    each_node(before.grid(), [&](int r, int c) {
      ASSERT_EQ(sheet.particles().position_at(4 * r, 4 * c), before.position_at(r, c));
      ASSERT_EQ(sheet.particles().velocity_at(4 * r, 4 * c), before.velocity_at(r, c));
    });
    EXPECT_NEAR(sheet.elastic_energy() / held, 1, 0.005);
  }
}

}  // namespace
}  // namespace weft
