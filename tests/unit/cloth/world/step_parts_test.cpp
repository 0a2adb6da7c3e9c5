// Long steps are made in parts (step_parts.h), each with the substeps described: how many are counted by
// those.
#include "cloth/world/step_parts.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bodies.h"
#include "cloth/world/simulation.h"
#include "folding_scenes.h"

namespace weft::test {
namespace {

int substeps(SimulationDescription scene, int hz) {
  scene.time_step = 1.0 / hz;
  Simulation<float> simulation(scene);
  simulation.step();
  simulation.step();
  EXPECT_EQ(simulation.time(), 2.0 / hz);
  return simulation.last_advance(0).substeps;
}

/// A sheet that lies in the ground's plane, held all around.
SimulationDescription held_bed(const IntegratorDescription& integrator) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.initial_level = cloth.max_level = 4;
  cloth.orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  cloth.pins = {{0, 1, 0, 0}, {0, 1, 1, 1}, {0, 0, 0, 1}, {1, 1, 0, 1}};
  scene.cloths = {cloth};
  scene.integrator = integrator;
  return scene;
}

}  // namespace

// At most 1/30 s by a single cloth's implicit steps, 1/60 s by those of several, 1/240 s by explicit steps.
TEST(StepsInParts, AreThoseOfClothsThatTouch) {
  const IntegratorDescription implicit = Bdf2Description{}, projective = XpbdDescription{.substeps = 3};
  EXPECT_EQ(substeps(caught(4, implicit), 15), 4);
  EXPECT_EQ(substeps(caught(4, implicit), 30), 2);
  EXPECT_EQ(substeps(caught(4, implicit), 60), 1);
  EXPECT_EQ(substeps(caught(4, projective), 15), 16 * 3);
  EXPECT_EQ(substeps(caught(4, projective), 60), 4 * 3);
  EXPECT_EQ(substeps(dropped_on_edge(4, implicit), 15), 2);
  EXPECT_EQ(substeps(dropped_on_edge(4, implicit), 30), 1);
  EXPECT_EQ(substeps(dropped_on_edge(4, projective), 15), 16 * 3);
  EXPECT_EQ(substeps(dropped_on_edge(4, projective), 60), 4 * 3);
  SimulationDescription apart = caught(4, implicit);
  std::erase_if(apart.effects, [](const EffectDescription& each) {
    return std::holds_alternative<ClothContactEffect>(each);
  });
  EXPECT_EQ(substeps(apart, 15), 1);
}

// At most 4 cells a part by a sheet that goes past another one 4 mm under it: 3 cells a step are one part, 10
// three, 14 four; 3 m above it as if it were alone.
TEST(StepsInParts, AreThoseOfClothsThatGoPastEachOther) {
  const auto passing = [](double cells, double apart) {
    SimulationDescription scene = fall_together(4, Bdf2Description{});
    scene.effects.erase(scene.effects.begin());  // gravity
    scene.obstacles.clear();
    const double cell = 1.0 / (scene.cloths[0].base_cells.at(4).cols - 1);
    scene.cloths[1].position.y() = scene.cloths[0].position.y() + apart;
    scene.cloths[1].velocity = {cells * cell * 60, 0, 0};
    return scene;
  };
  EXPECT_EQ(substeps(passing(3, 0.004), 60), 1);
  EXPECT_EQ(substeps(passing(10, 0.004), 60), 3);
  EXPECT_EQ(substeps(passing(14, 0.004), 60), 4);
  EXPECT_EQ(substeps(passing(14, 3), 60), 1);
}

// Of a sheet of 2 m whose edge goes to and fro at 50 m/s, with something solid: at most 1 m a part by
// implicit methods. 50 / 60 m are one part, 50 / 30 two, 50 / 15 four, though it is back where it was at the
// step's end, and 500 m/s eight.
TEST(StepsInParts, AreThoseOfPinsThatGoFarPastWhatIsSolid) {
  const auto yanked = [](const IntegratorDescription& integrator, double speed, double period) {
    SimulationDescription scene;
    ClothDescription cloth;
    cloth.initial_level = 3;
    cloth.pins = {
        {0, 1, 0, 0, {{0, {0, 0, 0}}, {period / 2, {0, 0, speed * period / 2}}, {period, {0, 0, 0}}}}};
    cloth.pins[0].loop = true;
    scene.cloths = {cloth};
    scene.integrator = integrator;
    BallDescription ball;
    ball.position = {0, -5, 0};
    scene.balls = {ball};
    return scene;
  };
  const IntegratorDescription implicit = BackwardEulerDescription{};
  const double period = 1.0 / 15;
  EXPECT_EQ(substeps(yanked(implicit, 50, period), 60), 1);
  EXPECT_EQ(substeps(yanked(implicit, 50, period), 30), 2);
  EXPECT_EQ(substeps(yanked(implicit, 50, period), 15), 4);
  EXPECT_EQ(substeps(yanked(implicit, 500, period), 15), 8);
  EXPECT_EQ(substeps(yanked(XpbdDescription{.substeps = 3}, 50, period), 15), 3);
  SimulationDescription free = yanked(implicit, 50, period);
  free.balls.clear();
  EXPECT_EQ(substeps(free, 15), 1);
}

// A ball of 0.1 m that lies on a held bed and is thrown along it: at most a quarter of its radius a part by
// implicit methods, so 1 m/s are one part, 2.8 m/s two, and 20 m/s the most, four; so it is if another one,
// that flies, may hit it.
TEST(StepsInParts, AreThoseOfBodiesOnCloth) {
  const auto thrown = [](const IntegratorDescription& integrator, double speed, double above) {
    SimulationDescription scene = held_bed(integrator);
    const Vec3 place(-0.3, 0.099, 0);
    if (above == 0) {
      scene.balls = {flying_ball(place, 0.1, {speed, -0.5, 0})};
    } else {
      scene.balls = {flying_ball(place, 0.1, {0, -0.5, 0}),
                     flying_ball(place + Vec3(0, above, 0), 0.1, {0, 0, speed})};
    }
    return scene;
  };
  const IntegratorDescription implicit = BackwardEulerDescription{};
  EXPECT_EQ(substeps(thrown(implicit, 1, 0), 60), 1);
  EXPECT_EQ(substeps(thrown(implicit, 2.8, 0), 60), 2);
  EXPECT_EQ(substeps(thrown(implicit, 20, 0), 60), 4);
  EXPECT_EQ(substeps(thrown(implicit, 2.8, 0.21), 60), 2);
  EXPECT_EQ(substeps(thrown(implicit, 2.8, 2), 60), 1);
  EXPECT_EQ(substeps(thrown(SymplecticEulerDescription{.substeps = 64}, 2.8, 0), 60), 64);
}

// A box of 0.2 m that lies on a held bed and spins about its upright axis: its corners go past the cloth at
// 0.14 m times the spin, of which a quarter of its 0.1 m makes one part.
TEST(StepsInParts, AreThoseOfBodiesThatSpinOnCloth) {
  const auto spinning = [](double spin) {
    SimulationDescription scene = held_bed(BackwardEulerDescription{});
    ObstacleDescription box;
    box.shape = BoxDescription{{0.2, 0.2, 0.2}};
    box.position = {0, 0.099, 0};
    box.body = BodyDescription{.velocity = {0, -0.5, 0}, .spin = {0, spin, 0}};
    scene.obstacles = {box};
    return scene;
  };
  EXPECT_EQ(substeps(spinning(0), 60), 1);
  EXPECT_GT(substeps(spinning(20), 60), 1);
  EXPECT_EQ(substeps(spinning(60), 60), 4);
}

}  // namespace weft::test
