#include <gtest/gtest.h>

#include "fixtures.h"
#include "folding_scenes.h"
#include "held.h"
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

/// J, of a cloth's motion, springs, and height.
double energy(const Simulation<float>& simulation) {
  const ClothReport report = simulation.report(0);
  return report.kinetic_energy + report.potential_energy;
}

/// J, over so many steps in which nothing puts in energy.
struct Balance {
  double risen = 0;  ///< at most, above the least before
  double lost = 0;   ///< at most
};
Balance balance(Simulation<float>& simulation, int steps) {
  const double start = energy(simulation);
  double lowest = start;
  Balance result;
  for (int step = 0; step < steps; ++step) {
    simulation.step();
    lowest = std::min(lowest, energy(simulation));
    result.risen = std::max(result.risen, energy(simulation) - lowest);
  }
  result.lost = start - lowest;
  return result;
}

struct Stepping {
  const char* name;
  IntegratorDescription description;
};
void PrintTo(const Stepping& stepping, std::ostream* out) { *out << stepping.name; }
class SelfContact : public ::testing::TestWithParam<Stepping> {};

constexpr Stepping kBdf2{"bdf2", Bdf2Description{}},
    kBackwardEuler{"backward_euler", BackwardEulerDescription{}}, kXpbd{"xpbd", XpbdDescription{}},
    kSymplecticEuler{"symplectic_euler", SymplecticEulerDescription{}};

INSTANTIATE_TEST_SUITE_P(Methods, SelfContact, ::testing::Values(kBdf2, kBackwardEuler, kXpbd),
                         [](const auto& tested) { return tested.param.name; });

/// Falls that last some seconds of processor time each.
class SelfContactSlow : public SelfContact {};
INSTANTIATE_TEST_SUITE_P(Methods, SelfContactSlow, ::testing::Values(kBdf2, kBackwardEuler, kXpbd),
                         [](const auto& tested) { return tested.param.name; });

/// By method and number of falls.
class SelfContactFolds : public ::testing::TestWithParam<std::tuple<Stepping, int>> {};
std::string method_of(const ::testing::TestParamInfo<std::tuple<Stepping, int>>& tested) {
  return std::get<0>(tested.param).name;
}
INSTANTIATE_TEST_SUITE_P(Slow, SelfContactFolds,
                         ::testing::Combine(::testing::Values(kBdf2, kBackwardEuler, kXpbd),
                                            ::testing::Values(1)),
                         method_of);
INSTANTIATE_TEST_SUITE_P(Nightly, SelfContactFolds,
                         ::testing::Combine(::testing::Values(kBdf2, kBackwardEuler, kXpbd),
                                            ::testing::Values(8)),
                         method_of);

class SelfContactFrictionSlow : public SelfContact {};
INSTANTIATE_TEST_SUITE_P(Methods, SelfContactFrictionSlow,
                         ::testing::Values(kBdf2, kBackwardEuler, kXpbd, kSymplecticEuler),
                         [](const auto& tested) { return tested.param.name; });

/// By method and level. The finer one takes a minute, and so does symplectic Euler.
class SelfContactWrung : public ::testing::TestWithParam<std::tuple<Stepping, int>> {};
std::string method_and_level(const ::testing::TestParamInfo<std::tuple<Stepping, int>>& tested) {
  return std::get<0>(tested.param).name + ("_L" + std::to_string(std::get<1>(tested.param)));
}
INSTANTIATE_TEST_SUITE_P(Slow, SelfContactWrung,
                         ::testing::Combine(::testing::Values(kBdf2, kBackwardEuler, kXpbd),
                                            ::testing::Values(4)),
                         method_and_level);
INSTANTIATE_TEST_SUITE_P(Nightly, SelfContactWrung,
                         ::testing::Values(std::tuple(kBdf2, 5), std::tuple(kBackwardEuler, 5),
                                           std::tuple(kXpbd, 5), std::tuple(kSymplecticEuler, 4)),
                         method_and_level);

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

/// Neither as it falls nor in the heap.
void expect_no_crossing_in_a_heap(SimulationDescription scene) {
  Simulation<float> simulation(scene);
  EXPECT_EQ(intersections_in(simulation, 2), 0);
  EXPECT_TRUE(simulation.healthy());
  EXPECT_EQ(simulation.layers()->tangled_nodes(), 0);
  // It came down in a heap: without the effect the same scene crosses itself.
  scene.effects.pop_back();
  Simulation<float> without(scene);
  EXPECT_GT(intersections_in(without, 2), 0);
}

TEST_P(SelfContactSlow, SquareDroppedOnItsEdgeNeverCrossesItself) {
  expect_no_crossing_in_a_heap(dropped_on_edge(5, GetParam().description));
}

// At a level where its substeps are few.
TEST(SelfContactSymplecticEulerSlow, SquareDroppedOnItsEdgeNeverCrossesItself) {
  expect_no_crossing_in_a_heap(dropped_on_edge(4, SymplecticEulerDescription{}));
}

// Nothing puts in energy: gravity has a potential, the floor stands still, folds and floor only take some. So
// it never rises, but for what the method brings in without folds: they add none, to a hundredth of the fall.
// (1.65 J were seen with XPBD where only the net held them.) How it folds hangs on the last digits: falls
// that begin a little higher fold otherwise.
//
// At level 5 XPBD has four times its substeps: with 40 a step its springs bear less than the energy that is
// counted for their stretch, and in 2 of 16 falls 0.025 J more were counted than there had been, where a
// border whipped round.
TEST_P(SelfContactFolds, OfADroppedSquareBringInNoEnergy) {
  const auto& [stepping, falls] = GetParam();
  for (int fall = 0; fall < falls; ++fall) {
    SimulationDescription scene = dropped_on_edge(fall < 4 ? 4 : 5, stepping.description);
    auto* xpbd = std::get_if<XpbdDescription>(&scene.integrator);
    if (xpbd != nullptr && fall >= 4) xpbd->substeps = 160;
    scene.cloths[0].position.y() += 4e-7 * fall;
    Simulation<float> simulation(scene);
    const Balance folds = balance(simulation, 120);
    scene.effects.pop_back();
    Simulation<float> without(scene);
    EXPECT_LT(folds.risen, balance(without, 120).risen + 0.01 * folds.lost) << fall;
    EXPECT_GT(folds.lost, 0.4) << fall;  // J, of the 0.54 that 0.1 kg have at 0.55 m
  }
}

// The same of the explicit method, whose substeps are many: 0.26 J were seen where only the net held them.
TEST(SelfContactSymplecticEulerSlow, FoldsOfADroppedSquareBringInNoEnergy) {
  SimulationDescription scene = dropped_on_edge(4, SymplecticEulerDescription{});
  Simulation<float> simulation(scene);
  const Balance folds = balance(simulation, 120);
  scene.effects.pop_back();
  Simulation<float> without(scene);
  EXPECT_LT(folds.risen, balance(without, 120).risen + 0.01 * folds.lost);
}

// The hands put in energy, contact only takes some: less what they put in it never rises by more than 5 % of
// that, be it for the net's sake (0.04 to 0.4 J of 15 were seen at level 4, 0.02 of 8 at level 5; where the
// net held the rope, all 10 that were put in). Of XPBD and symplectic Euler only crossings are tested: their
// substeps do not hold a rope so tight, the net does, and brings in 24 J where 7 are put in, and 4 where 3.4
// are.
TEST_P(SelfContactWrung, StripWrungByFourTurnsNeverCrossesItselfNorGainsEnergy) {
  const auto& [stepping, level] = GetParam();
  Simulation<float> simulation(wrung(level, stepping.description));
  double put_in = 0, lowest = energy(simulation), most_risen = 0;
  int crossings = 0;
  Held before = Held::of(simulation.cloths()[0]);
  for (int step = 1; step <= 132; ++step) {
    simulation.step();
    const Held now = Held::of(simulation.cloths()[0]);
    put_in += work(before, now);
    before = now;
    lowest = std::min(lowest, energy(simulation) - put_in);
    most_risen = std::max(most_risen, energy(simulation) - put_in - lowest);
    if (step % 4 == 0) crossings += intersections(simulation);
  }
  EXPECT_EQ(crossings, 0);
  EXPECT_TRUE(simulation.healthy());
  if (!std::holds_alternative<Bdf2Description>(stepping.description) &&
      !std::holds_alternative<BackwardEulerDescription>(stepping.description))
    return;
  EXPECT_GT(put_in, 5);
  EXPECT_LT(most_risen, 0.05 * put_in);
}

TEST_P(SelfContactSlow, ClothPulledOffABallNeverCrossesItself) {
  Simulation<float> simulation(pulled_off(5, GetParam().description));
  EXPECT_EQ(intersections_in(simulation, 2.5), 0);
  EXPECT_TRUE(simulation.healthy());
}

TEST_P(SelfContactSlow, ClothsOfASceneDoNotPassThroughEachOther) {
  Simulation<float> simulation(caught(4, GetParam().description));
  EXPECT_EQ(intersections_in(simulation, 1.5), 0);
  EXPECT_TRUE(simulation.healthy());
  // It was caught: 1.5 s of free fall are 11 m.
  EXPECT_GT(simulation.centre(1).y(), -1);
}

// Nothing but gravity, which has a potential, and contact, which only takes energy: the halves of a cloth
// swing together without drag, clap, and stay. Before they meet it is the method's own affair.
TEST_P(SelfContact, ClappingBringsInNoEnergy) {
  Simulation<float> simulation(clapping(5, GetParam().description));
  // Until the halves meet it has the same energy as without contact, to the bit, with each method's own
  // rises.
  const bool xpbd = std::holds_alternative<XpbdDescription>(GetParam().description);
  const int meet = xpbd ? 18 : 12;  // implicit steps lose nothing on the way, so that they meet earlier
  for (int step = 0; step < meet; ++step) simulation.step();
  const auto [risen, lost] = balance(simulation, 120 - meet);
  // XPBD's own bound: it brings in more before, without contact.
  EXPECT_LT(risen, (xpbd ? 0.05 : 0.002) * lost);
  EXPECT_GT(lost, 0.03);  // J, of the 0.04 that the halves have when they meet
  EXPECT_EQ(intersections(simulation), 0);
}

// Inelastic: what the floor stops it does not throw up. The lower one is stopped in one step, which the other
// one must not take for how it goes on. No node comes higher than a tenth of the fall (the layers lie within
// their thickness, 5 mm, of the floor).
TEST_P(SelfContactSlow, SheetLiesOnOneThatTheFloorStops) {
  Simulation<float> simulation(fall_together(4, GetParam().description));
  double highest = 0;
  for (int step = 0; step < 120; ++step) {
    simulation.step();
    if (step < 30) continue;  // the fall takes 0.32 s
    for (const Cloth<float>& cloth : simulation.cloths()) {
      test::each_node(cloth.particles().grid(), [&](int r, int c) {
        highest = std::max(highest, cloth.particles().position_at(r, c).y());
      });
    }
  }
  EXPECT_LT(highest, 0.05);
  EXPECT_EQ(intersections(simulation), 0);
}

// T14: rests where tan(angle) < friction, and else slides down with g (sin - friction cos).
TEST_P(SelfContactFrictionSlow, ClothRubsOnCloth) {
  const auto after_half_a_second = [](Simulation<float>& simulation) {
    for (int step = 0; step < 30; ++step) simulation.step();
    return simulation.centre(1);
  };
  Simulation<float> rests(on_a_slope(15, 0.3, GetParam().description));
  const Vec3 lay = after_half_a_second(rests);
  EXPECT_LT((after_half_a_second(rests) - lay).norm(), 0.005);
  Simulation<float> slides(on_a_slope(20, 0.3, GetParam().description));
  const Vec3 first = after_half_a_second(slides), second = after_half_a_second(slides),
             third = after_half_a_second(slides);
  const double acceleration = 0.589702;  // m/s2
  // Friction is off by the fiftieth part, 0.0553 m/s2 of g cos friction: a tenth of what is left of gravity.
  EXPECT_NEAR((third - 2 * second + first).norm() / 0.25, acceleration, 0.1 * acceleration);
}

// What begins entangled comes free within a second and stays so. The small cloth has nothing but what leads
// it out; the bent corner straightens itself as well, which contact with the wrong side must not hinder.
TEST_P(SelfContact, UntanglesWhatBeginsTangledSlow) {
  // XPBD's impulses hold the small cloth, which is free, where it sticks: there it stays.
  const bool xpbd = std::holds_alternative<XpbdDescription>(GetParam().description);
  for (const auto make : {poked_by_its_corner, stuck_in}) {
    if (xpbd && make == stuck_in) continue;
    SimulationDescription scene = make(4, GetParam().description);
    Simulation<float> simulation(scene);
    EXPECT_GT(intersections(simulation), 10);
    for (int step = 0; step < 60; ++step) simulation.step();
    EXPECT_EQ(intersections_in(simulation, 2), 0);
    EXPECT_EQ(simulation.layers()->tangled_nodes(), 0);
    EXPECT_LT(simulation.report(0).strain.max, 0.05);
    if (make == poked_by_its_corner) continue;
    scene.effects.clear();
    Simulation<float> without(scene);
    for (int step = 0; step < 60; ++step) without.step();
    EXPECT_GT(intersections(without), 0);
  }
}

// Levels may change at any time, whatever that does to a heap.
TEST(SelfContactLevelsSlow, MayChangeInAHeap) {
  SimulationDescription scene = dropped_on_edge(5, Bdf2Description{});
  scene.cloths[0].min_level = 3;
  Simulation<float> simulation(scene);
  for (int step = 0; step < 120; ++step) {
    if (step >= 40) simulation.request_level(0, 3 + (step / 7) % 3);
    simulation.step();
    ASSERT_TRUE(simulation.healthy());
    ASSERT_FALSE(simulation.cloths()[0].frozen());
  }
}

// What crosses itself from the start is seen, left alone, and looked at again when it is free.
TEST(SelfContactLevels, TanglesAreLeftAloneUntilTheyAreFree) {
  SimulationDescription scene = cloth_scene({1, 1}, 4, Bdf2Description{});
  scene.cloths[0].pins = {PinRegion{0, 1, 0, 0}};
  const Quaternion across(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY()));
  ClothDescription other = scene.cloths[0];
  other.orientation = across;  // through the middle of the first
  other.pins.clear();
  other.velocity = {3, 0, 0};
  scene.cloths.push_back(other);
  scene.effects.erase(scene.effects.begin());  // gravity
  Simulation<float> simulation(scene);
  simulation.step();
  EXPECT_GT(simulation.layers()->tangled_nodes(), 0);
  for (int step = 0; step < 60; ++step) simulation.step();
  EXPECT_EQ(simulation.layers()->tangled_nodes(), 0);
  EXPECT_GT(simulation.centre(1).x(), 2);  // it went on as it went
}

// A cloth that lies on another comes to rest and sleeps; what falls onto it wakes it.
TEST(SelfContactSleepSlow, LayersSleepAndWake) {
  SimulationDescription scene = on_a_slope(0, 0.3, Bdf2Description{});
  scene.sleep_speed = 1e-3;
  ClothDescription late = scene.cloths[1];
  late.size = {0.2, 0.2};
  late.position += Vec3(0, 30, 0);  // 2.5 s to fall
  scene.cloths.push_back(late);
  Simulation<float> simulation(scene);
  for (int step = 0; step < 130; ++step) simulation.step();
  EXPECT_TRUE(simulation.cloths()[1].asleep());
  bool woken = false;
  for (int step = 0; step < 40; ++step) {
    simulation.step();
    woken = woken || !simulation.cloths()[1].asleep();
  }
  EXPECT_TRUE(woken);
}

}  // namespace weft::test
