// A pair of two sheets in the explicit step of one of them.
#include "cloth/contact/constraints/layer_impulses.h"

#include "node_over_triangle.h"

namespace weft::test {
namespace {

/// The first sheet's step with the pair.
struct ExplicitPair : NodeOverTriangle {
  ExplicitPair(double height, const Vec3& velocity) : NodeOverTriangle(height, velocity) {}
  void resolve(const Substep& substep) { impulses.resolve(sheet, substep, {pair}, given); }
  double speed() const { return get(sheet.velocity, 0, 0).y(); }

  std::vector<Vec3> given = std::vector<Vec3>(sheet.grid().size(), Vec3(0, 0, 0));
  LayerImpulses<double> impulses{nodes(), found(), grid(), 0, parameters()};
};

TEST(LayerImpulses, StopTheApproachPlastically) {
  ExplicitPair pair(kPairGap / 2, {0, -2, 0});
  pair.resolve(Substep{0, 1, kPairStep});
  // An impulse of v / share: the other sheet's part of the approach is its own to stop.
  EXPECT_NEAR(pair.speed(), -2 + 2 / pair.share, 1e-9);
  EXPECT_NEAR(pair.given[0].y(), 2 / pair.share, 1e-9) << "N s, as another cloth gave it";
  EXPECT_EQ(get(pair.sheet.velocity, 0, 1), Vec3(0, -2, 0)) << "nothing is near that one";
}

TEST(LayerImpulses, Rub) {
  ExplicitPair pair(kPairGap / 2, {3, -2, 0});
  pair.resolve(Substep{0, 1, kPairStep});
  // Coulomb, 0.5: half of the impulse across it.
  EXPECT_NEAR(get(pair.sheet.velocity, 0, 0).x(), 3 - 0.5 * 2 / pair.share, 1e-9);
}

TEST(LayerImpulses, LeaveAloneWhatIsApartOrFliesApart) {
  ExplicitPair apart(2 * kPairGap, {0, -2, 0}), leaving(kPairGap / 2, {0, 1, 0});
  apart.resolve(Substep{0, 1, kPairStep});
  leaving.resolve(Substep{0, 1, kPairStep});
  EXPECT_EQ(get(apart.sheet.velocity, 0, 0), Vec3(0, -2, 0));
  EXPECT_EQ(get(leaving.sheet.velocity, 0, 0), Vec3(0, 1, 0));
}

// Both have one velocity after the first substep, which the triangle keeps: in the second nothing approaches.
// Forgotten, the triangle would stand still there and take as much from the node once more.
TEST(LayerImpulses, TheOthersKeepWhatTheyGotFromSubstepToSubstep) {
  ExplicitPair pair(kPairGap / 2, {0, -2, 0});
  pair.resolve(Substep{0, 0.5, kPairStep / 2});
  const double after_first = pair.speed();
  pair.resolve(Substep{0.5, 1, kPairStep / 2});
  EXPECT_NEAR(pair.speed(), after_first, 1e-9);
}

// Of what it lacks a pair at rest is led apart by a tenth in a step, however many substeps that has.
TEST(LayerImpulses, LeadApartByAShareOfTheLackInAStep) {
  for (const int substeps : {1, 4}) {
    ExplicitPair pair(kPairGap / 2, {0, 0, 0});
    for (int i = 0; i < substeps; ++i) pair.resolve(Substep::of(i, substeps, kPairStep));
    // The node's part of it is its inverse mass in all of the pair's.
    const double led = kLayersLedApart * (kPairGap / 2) / pair.share;
    EXPECT_NEAR(get(pair.sheet.position, 0, 0).y() - kPairGap / 2, led, 1e-3 * led) << substeps;
  }
}

}  // namespace
}  // namespace weft::test
