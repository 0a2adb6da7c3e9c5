#include <gtest/gtest.h>

#include "fixtures.h"
#include "folding_scenes.h"
#include "intersections.h"

namespace weft::test {
namespace {

int intersections(const Simulation<float>& simulation) {
  TriangleSoup soup;
  for (const Cloth<float>& cloth : simulation.cloths()) soup.add(cloth.particles());
  return count_intersections(soup);
}

/// Runs it; adds up the intersections seen on every fifth step and at the end.
int intersections_in(Simulation<float>& simulation, double seconds) {
  int count = 0;
  for (int step = 1; step <= seconds * 60; ++step) {
    simulation.step();
    if (step % 5 == 0) count += intersections(simulation);
  }
  return count + intersections(simulation);
}

struct Stepping {
  const char* name;
  IntegratorDescription description;
};
void PrintTo(const Stepping& stepping, std::ostream* out) { *out << stepping.name; }
class SelfContact : public ::testing::TestWithParam<Stepping> {};

INSTANTIATE_TEST_SUITE_P(Methods, SelfContact,
                         ::testing::Values(Stepping{"bdf2", Bdf2Description{}},
                                           Stepping{"backward_euler", BackwardEulerDescription{}},
                                           Stepping{"xpbd", XpbdDescription{}}),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace

// The counter itself: a segment through a triangle, beside it, and one whose crossing rounding would hide.
TEST(Intersections, AreDecidedExactly) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_TRUE(crosses({0.25, 0.25, 1}, {0.25, 0.25, -1}, a, b, c));
  EXPECT_FALSE(crosses({0.75, 0.75, 1}, {0.75, 0.75, -1}, a, b, c));
  EXPECT_FALSE(crosses({0.25, 0.25, 1}, {0.25, 0.25, 0}, a, b, c));  // ends on the plane
  const double tiny = 0x1p-100;
  EXPECT_TRUE(crosses({0.25, 0.25, tiny}, {0.25, 0.25, -tiny}, a, b, c));
  EXPECT_FALSE(crosses({0.25, 0.25, tiny}, {0.25, 0.25, tiny / 2}, a, b, c));
}

// A sheet folded so that its halves cross: seen, or the tests below could not fail.
TEST(Intersections, AreCounted) {
  Particles<float> sheet = flat_sheet<float>(9, 9, {1, 1});
  TriangleSoup flat;
  flat.add(sheet);
  EXPECT_EQ(count_intersections(flat), 0);
  each_node(sheet.grid(), [&](int r, int c) {
    if (c > 4) set(sheet.position, r, c, {0.1, 0.5 - r / 8.0, c < 7 ? 0.4 : -0.4});
    if (c > 6) set(sheet.position, r, c, {-0.2 - 0.01 * c, 0.48 - r / 8.0, c == 7 ? 0.1 : -0.1});
  });
  TriangleSoup folded;
  folded.add(sheet);
  EXPECT_GT(count_intersections(folded), 0);
}

TEST_P(SelfContact, SquareDroppedOnItsEdgeNeverCrossesItself) {
  SimulationDescription scene = dropped_on_edge(5, GetParam().description);
  Simulation<float> simulation(scene);
  EXPECT_EQ(intersections_in(simulation, 2), 0);
  EXPECT_TRUE(simulation.healthy());
  EXPECT_EQ(simulation.layers()->tangled_nodes(), 0);
  // It came down in a heap: without the effect the same scene crosses itself.
  scene.effects.pop_back();
  Simulation<float> without(scene);
  EXPECT_GT(intersections_in(without, 2), 0);
}

TEST_P(SelfContact, StripWrungByFourTurnsNeverCrossesItself) {
  Simulation<float> simulation(wrung(4, GetParam().description));
  EXPECT_EQ(intersections_in(simulation, 4.5), 0);
  EXPECT_TRUE(simulation.healthy());
}

TEST_P(SelfContact, ClothPulledOffABallNeverCrossesItself) {
  Simulation<float> simulation(pulled_off(5, GetParam().description));
  EXPECT_EQ(intersections_in(simulation, 2.5), 0);
  EXPECT_TRUE(simulation.healthy());
}

}  // namespace weft::test
