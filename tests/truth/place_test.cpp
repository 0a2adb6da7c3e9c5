// Physics does not know where it is: a cloth 10 km from the origin comes to rest and swings as one at the
// origin, by every method, in single precision.
#include <cmath>

#include "cloth/world/simulation.h"
#include "methods.h"

namespace weft::test {
namespace {

using Place = EveryMethod;
INSTANTIATE_TEST_SUITE_P(Methods, Place, ::testing::ValuesIn(kMethods), name_of_case);

IntegratorDescription usual(Method method) {
  switch (method) {
    case Method::backward_euler:
      return BackwardEulerDescription{};
    case Method::bdf2:
      return Bdf2Description{};
    case Method::xpbd:
      return XpbdDescription{};
    default:
      return SymplecticEulerDescription{};
  }
}

/// 1 m of cotton hung by two corners.
SimulationDescription hung(Method method, const Vec3& at) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {1, 1};
  cloth.position = at;
  cloth.min_level = cloth.max_level = cloth.initial_level = 3;
  cloth.material = find_fabric("cotton")->material;
  cloth.pins = {{0, 0, 0, 0}, {1, 1, 0, 0}};
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{}, DampingEffect{}, AerodynamicsEffect{}};
  scene.integrator = usual(method);
  return scene;
}

/// Steps until the first cloth sleeps; `most` if it does not.
int steps_to_sleep(Simulation<float>& simulation, int most) {
  int step = 0;
  while (step < most && !simulation.cloths()[0].asleep()) simulation.step(), ++step;
  return step;
}

/// The farthest that a node is from where it is in the other, each as seen from its scene's place, m.
double shapes_apart(const Simulation<float>& one, const Vec3& at, const Simulation<float>& other) {
  double most = 0;
  const Particles<float>&a = one.cloths()[0].particles(), &b = other.cloths()[0].particles();
  each_node(a.grid(), [&](int r, int c) {
    most = std::max(most, (a.place - at + a.local_position_at(r, c) - b.position_at(r, c)).norm());
  });
  return most;
}

// What is not there: at 200 m rounding gave this cloth 0.5 J by symplectic Euler.
TEST_P(Place, AHungClothComesToRestAnywhere) {
  constexpr int kMost = 3000, kDamped = 510;
  Simulation<float> near(hung(GetParam(), {0, 0, 0}));
  const int expected = steps_to_sleep(near, kMost);
  ASSERT_LT(expected, kMost);
  // Multiples of the places' grid: the same bits. Between two: the start is rounded otherwise, by 1e-7 m, and
  // what is slower than the threshold, 0.1 mm/s, for a second sleeps sooner or later, and as much short of
  // its balance; but not later than by its damping: 510 steps, by symplectic Euler.
  for (const Vec3& at : {Vec3(200, 0, 0), Vec3(10000, -200, 5000)}) {
    Simulation<float> far(hung(GetParam(), at));
    EXPECT_EQ(steps_to_sleep(far, kMost), expected);
    EXPECT_EQ(shapes_apart(far, at, near), 0);
  }
  const Vec3 at(9998.3, -401.3, 7001.9);
  Simulation<float> far(hung(GetParam(), at));
  const int steps = steps_to_sleep(far, kMost);
  EXPECT_LT(steps, 1.2 * kDamped);
  EXPECT_LT(shapes_apart(far, at, near), 5e-4);
}

struct Swing {
  double frequency;  ///< Hz
  double energy;     ///< the most of motion in the last second, J
};

/// Four seconds of a strip hung by its upper edge, pulled aside, with nothing that damps it.
Swing swing(Method method, const Vec3& at) {
  SimulationDescription scene = hung(method, at);
  ClothDescription& strip = scene.cloths[0];
  strip.size = {0.25, 1};
  strip.pins = {{0, 1, 0, 0}};
  strip.orientation = Quaternion(Eigen::AngleAxisd(0.15, Vec3::UnitX()));
  strip.material.damping = 0;
  scene.effects = {GravityEffect{}};
  scene.sleep_speed = 0;
  Simulation<float> simulation(scene);
  Crossings crossings(scene.time_step);
  Swing found{};
  for (int step = 0; step < 360; ++step) {
    simulation.step();
    crossings.add(simulation.centre(0).z() - at.z() - 0.075);
    if (step >= 300) found.energy = std::max(found.energy, simulation.report(0).kinetic_energy);
  }
  found.frequency = crossings.frequency();
  return found;
}

TEST_P(Place, AnUndampedSwingIsTheSameAnywhere) {
  const Swing near = swing(GetParam(), {0, 0, 0}), far = swing(GetParam(), {10000, -200, 5000}),
              between = swing(GetParam(), {9998.3, -401.3, 7001.9});
  EXPECT_EQ(far.energy, near.energy);
  EXPECT_NEAR(far.frequency, near.frequency, 1e-9);
  // Up to 2 m from its place along an axis: what a float rounds there shakes stiff springs by 1e-4 J, as it
  // does 2 m from the origin.
  EXPECT_NEAR(between.energy, near.energy, 2e-4);
  EXPECT_NEAR(between.frequency, near.frequency, 3e-3 * near.frequency);
}

}  // namespace
}  // namespace weft::test
