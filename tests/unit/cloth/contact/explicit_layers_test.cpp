// Layers of cloths that are stepped explicitly.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "folding_scenes.h"

namespace weft::test {

// Standing squares of 1 m, with the ordinary sheet's drag, fall onto their edge, and lie still 4 s later, or
// did after 5 at the latest. Where a step held only the triangle that each node was thought to come nearest,
// one of them shook by 0.5 mm a step for ever.
TEST(ExplicitLayersSlow, HeapsComeToRest) {
  for (const double thickness : {0.005, 0.01}) {
    for (const double fall : {0.0, 0.1}) {
      SimulationDescription scene = dropped_on_edge(4, XpbdDescription{});
      scene.cloths[0].position.y() += fall;
      scene.cloths[0].material.damping = 0.5;
      scene.effects = {GravityEffect{}, ClothContactEffect{.thickness = thickness}, DampingEffect{}};
      scene.sleep_speed = SimulationDescription{}.sleep_speed;
      Simulation<float> simulation(scene);
      int step = 0;
      while (step < 600 && !simulation.cloths()[0].asleep()) {
        simulation.step();
        ++step;
      }
      EXPECT_LT(step, 600) << "thickness " << thickness << " m, fall " << fall << " m";
    }
  }
}

// Within its gap of 1 cm of a sheet that is held, one leaves it at 2 cm/s: it is slowed, as by a drag that
// bears its weight at 4 cm/s, in t to exp(-g t / 0.04 m/s) of that or, where several pairs hold a node, less.
// At 10 cm/s it is not.
TEST(ExplicitLayers, AreSlowedWhereTheySeparateSlowly) {
  const auto speed_after_a_step = [](double speed) {
    SimulationDescription scene = cloth_scene({1, 1}, 4, XpbdDescription{});
    scene.effects = {ClothContactEffect{.thickness = 0.01}};
    scene.cloths[0].orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
    scene.cloths.push_back(scene.cloths[0]);
    scene.cloths[0].pins = {PinRegion{0, 1, 0, 1}};
    scene.cloths[1].position = {0.003, 0.008, 0.002};
    scene.cloths[1].velocity = {0, speed, 0};
    Simulation<double> simulation(scene);
    simulation.step();
    const Particles<double>& particles = simulation.cloths()[1].particles();
    return particles.velocity_at(8, 8).y();
  };
  EXPECT_LT(speed_after_a_step(0.02), 0.02 * std::exp(-9.81 / 0.04 / 60));
  EXPECT_GT(speed_after_a_step(0.1), 0.099);
}

}  // namespace weft::test
