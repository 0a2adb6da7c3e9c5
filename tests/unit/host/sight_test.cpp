// Which level a cloth has for a viewer, and which cloths nobody sees.
#include "host/sight.h"

#include "fixtures.h"

namespace weft::host::test {
namespace {

constexpr int kSightDwell = 60;  // steps: Sight::kUnseenTime at 60 Hz

/// hung_cloth() around the origin, of level 6 within 1 m, 5 within 10 m and 4 beyond.
class Sights : public ::testing::Test {
 protected:
  explicit Sights(Relevance relevance = {Relevance::Unseen::coarse, 20}) : scene(relevant(relevance)) {
    sight.find_bounds(simulation.cloths());
  }
  static SimulationDescription relevant(Relevance relevance) {
    SimulationDescription scene = hung_cloth().simulation;
    scene.cloths[0].relevance = relevance;
    return scene;
  }
  /// At this distance from the origin, looking at it or away.
  Seat seat(double distance, bool away = false) const {
    Seat seat;
    seat.placed = true;
    seat.eye = Vec3(0, 0, distance);
    seat.cone = ViewCone{*seat.eye, Vec3(0, 0, away ? 1 : -1), 0.5};
    sight.look(seat);
    return seat;
  }
  void look(Seat& seat, int steps) const {
    for (int i = 0; i < steps; ++i) sight.look(seat, 1);
  }

  SimulationDescription scene;
  Simulation<float> simulation{scene};
  Sight sight{scene, std::size_t{1} << 24};
};

TEST_F(Sights, LevelsFollowTheDistance) {
  EXPECT_EQ(seat(0.5).levels, std::vector<int>{6});
  EXPECT_EQ(seat(5).levels, std::vector<int>{5});
  EXPECT_EQ(seat(15).levels, std::vector<int>{4});
  EXPECT_DOUBLE_EQ(seat(5).distances[0], 5);
}

TEST_F(Sights, ACoarserLevelIsSentWhereAFinerOneDoesNotFit) {
  // 33 x 33 nodes of level 5 at least 6 bytes each, and not the 65 x 65 of level 6.
  const std::size_t bytes = std::size_t{33} * 33 * 12 + 2000;
  Sight narrow(scene, bytes);
  narrow.find_bounds(simulation.cloths());
  Seat near = seat(0.5);
  narrow.look(near);
  EXPECT_LT(near.levels[0], 6);
  EXPECT_EQ(near.policy_levels[0], 6) << "Eq. 7 knows no frames";
}

TEST_F(Sights, WhoLooksAwayLosesTheClothAfterASecond) {
  Seat away = seat(5, true);
  look(away, kSightDwell);
  EXPECT_EQ(away.levels[0], 5);
  EXPECT_FALSE(sight.unseen({away}, 0));
  look(away, 1);
  EXPECT_EQ(away.levels[0], scene.cloths[0].min_level);
  EXPECT_TRUE(sight.unseen({away}, 0));
  EXPECT_FALSE(sight.unseen({away, seat(5)}, 0)) << "somebody else sees it";
  look(away, 1000);
  away.cone->axis *= -1;
  sight.look(away);
  EXPECT_EQ(away.levels[0], 5) << "at once";
}

TEST_F(Sights, WhoIsTooFarDoesNotSeeIt) {
  // Its sphere of sqrt(2) m begins 20 m away at 21.4 m.
  Seat near = seat(21.3), far = seat(21.5);
  look(near, kSightDwell + 1);
  look(far, kSightDwell + 1);
  EXPECT_FALSE(sight.unseen({near}, 0));
  EXPECT_TRUE(sight.unseen({far}, 0));
}

TEST_F(Sights, WhoHasNotSentItsCameraDoesNotCountBesideWhoHas) {
  Seat fresh = seat(0.5);
  fresh.placed = false;
  const Seat placed = seat(15);
  EXPECT_EQ(sight.wanted_levels({fresh, placed}), std::vector<int>{4});
  EXPECT_EQ(sight.wanted_levels({fresh}), std::vector<int>{6}) << "where nobody has, all do";
  EXPECT_EQ(sight.wanted_levels({placed, seat(5)}), std::vector<int>{5}) << "the finest";
}

TEST_F(Sights, LookingAnewForgetsWhatWasUnseen) {
  Seat away = seat(5, true);
  look(away, kSightDwell + 1);
  sight.look_anew(away);
  EXPECT_EQ(away.steps_unseen[0], 0);
  EXPECT_EQ(away.levels[0], 5);
}

class SightsOfAll : public Sights {
 protected:
  SightsOfAll() : Sights({Relevance::Unseen::step, 20}) {}
};

TEST_F(SightsOfAll, ClothForWhichItMakesNoDifferenceIsAlwaysSeen) {
  Seat away = seat(5, true);
  look(away, kSightDwell + 1);
  EXPECT_FALSE(sight.unseen({away}, 0));
  EXPECT_EQ(sight.bounds()[0].radius, 0) << "nobody asks for it";
}

}  // namespace
}  // namespace weft::host::test
