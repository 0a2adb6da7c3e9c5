// Commands that lay hands on things: obstacles moved, cloth grabbed and pinned.
#include "live_scene_test.h"

namespace weft::host::test {
namespace {

using namespace protocol;  // NOLINT(google-build-using-namespace): the commands' names

scene::Scene with_a_box() {
  scene::Scene scene = hung_cloth();
  ObstacleDescription box;
  box.shape = BoxDescription{.size = {0.1, 0.1, 0.1}};
  box.position = {0, 5, 0};
  scene.simulation.obstacles = {box, box};
  scene.simulation.obstacles[0].position = {0, 5, -3};  // out of the other's way
  scene.simulation.obstacles[1].body = BodyDescription{.mass = 2, .dynamic = false};
  return scene;
}

class ObstacleCommands : public Commands {
 protected:
  ObstacleCommands() : Commands(with_a_box()) {}
};

TEST_F(ObstacleCommands, MoveThemAndFramesTellOfThoseThatMoved) {
  steps(1);
  EXPECT_TRUE(reader.frames.back().obstacles.empty());
  EXPECT_EQ(command(ObstacleMove{1, {0, 6, 0}, Turn{0, 1, 0, 0}}).at("op"), "ok");
  EXPECT_EQ(command(BallAdd{{0, 0, 3}, 0.25, {}, Motion::kinematic, 1}).at("op"),
            "ok");  // both kinds of list
  steps(1);
  const FrameObstacle moved{1, {0, 6, 0}, {0, 1, 0, 0}};
  ASSERT_EQ(reader.frames.back().obstacles.size(), 1u);
  EXPECT_EQ(reader.frames.back().obstacles[0], moved);
  EXPECT_EQ(reader.frames.back().balls.size(), 1u);
  EXPECT_EQ(other.frames.back().obstacles.size(), 1u);
  // Without a quaternion it keeps its turn.
  EXPECT_EQ(command(ObstacleMove{1, {0, 7, 0}, {}}).at("op"), "ok");
  steps(1);
  EXPECT_EQ(reader.frames.back().obstacles.at(0), (FrameObstacle{1, {0, 7, 0}, {0, 1, 0, 0}}));
  EXPECT_EQ(command(Reset{}).at("op"), "ok");
  steps(1);
  EXPECT_TRUE(reader.frames.back().obstacles.empty());
  const json error = command(ObstacleMove{2, {}, {}});
  EXPECT_EQ(error.at("code"), "not_found");
  EXPECT_EQ(error.at("path"), "/obstacle");
  EXPECT_EQ(error.at("message"), "/obstacle is 2; the scene has 2 obstacles, counted from 0");
}

TEST_F(ObstacleCommands, ThrowThoseThatHaveAMass) {
  EXPECT_FALSE(reader.last("scene").at("obstacles").at(0).contains("mass"));
  EXPECT_EQ(reader.last("scene").at("obstacles").at(1).at("mass"), 2);
  EXPECT_EQ(command(ObstacleThrow{1, {0, 3, 0}, {6, 0, 0}}).at("op"), "ok");
  steps(1);
  const FrameObstacle thrown = reader.frames.back().obstacles.at(0);
  EXPECT_EQ(thrown.obstacle, 1u);
  EXPECT_NEAR(thrown.position[1], 5 + (3 - 9.81 / 60) / 60, 1e-6);
  EXPECT_NEAR(thrown.quaternion[1], std::sin(6.0 / 60 / 2), 1e-6);
  EXPECT_EQ(command(ObstacleMove{1, {0, 6, 0}, {}}).at("op"), "ok");
  steps(2);
  EXPECT_EQ(reader.frames.back().obstacles.at(0).position[1], 6);
  const json error = command(ObstacleThrow{0, {}, {}});
  EXPECT_EQ(error.at("code"), "unavailable");
  EXPECT_EQ(error.at("message"), "/obstacle is 0; it has no mass");
  EXPECT_EQ(command(ObstacleThrow{2, {}, {}}).at("code"), "not_found");
}

TEST_F(ObstacleCommands, HandsHoldThoseThatHaveAMass) {
  const std::uint32_t grab = command(ObstacleGrab{1, {0.05, 0, 0}, {}, 200}).at("grab");
  const BodyHand& hand = live.simulation().colliders().hands().at(0);
  EXPECT_EQ(hand.max_force, 200);
  EXPECT_EQ(hand.hand, Vec3(0.05, 5, 0));  // where the point is
  EXPECT_EQ(command(GrabMove{grab, {1, 6, 0}}).at("op"), "ok");
  steps(120);
  // By the middle of a face it hangs 9.81 / 30^2 m below the hand, the box's centre half an edge lower.
  EXPECT_NEAR(reader.frames.back().obstacles.at(0).position[1], 6 - 9.81 / 900 - 0.05, 1e-3);
  live.apply(other.viewer, other_visit, {7, GrabMove{grab, {0, 0, 0}}});
  drain();
  EXPECT_EQ(other.reply(7).at("code"), "not_found");
  EXPECT_EQ(command(GrabRelease{grab}).at("op"), "ok");
  EXPECT_EQ(command(GrabRelease{grab}).at("code"), "not_found");
  steps(60);
  EXPECT_LT(reader.frames.back().obstacles.at(0).position[1], 6 - 9.81 / 2);  // it fell for a second
  const json error = command(ObstacleGrab{0, {}, {}, 100});
  EXPECT_EQ(error.at("code"), "unavailable");
  EXPECT_EQ(error.at("path"), "/obstacle");
  EXPECT_EQ(error.at("message"), "/obstacle is 0; it has no mass");
  EXPECT_EQ(command(ObstacleGrab{2, {}, {}, 100}).at("message"),
            "/obstacle is 2; the scene has 2 obstacles, counted from 0");
}

TEST_F(ObstacleCommands, WhoLeavesLetsGoOfThemAndAResetLetsAllGo) {
  EXPECT_EQ(command(ObstacleGrab{1, {}, {}, 50}).at("grab"), 1);
  EXPECT_EQ(command(ClothGrab{0, 0.5, 1.0, {}, 50}).at("grab"), 2);  // counted together
  live.apply(other.viewer, other_visit, {7, ObstacleGrab{1, {}, {}, 50}});
  EXPECT_EQ(live.simulation().colliders().hands().size(), 2u);
  live.remove_viewer(other.viewer.get(), other_visit);
  EXPECT_EQ(live.simulation().colliders().hands().size(), 1u);
  command(Reset{});
  EXPECT_TRUE(live.simulation().colliders().hands().empty());
  EXPECT_EQ(command(GrabRelease{1}).at("code"), "not_found");
}

TEST_F(ObstacleCommands, The65thHandIsRefusedWhateverItHolds) {
  for (int i = 0; i < 32; ++i) ASSERT_EQ(command(ObstacleGrab{1, {}, {}, 1}).at("op"), "ok");
  for (int i = 0; i < 32; ++i) ASSERT_EQ(command(ClothGrab{0, 0.5, 0.5, {}, 1}).at("op"), "ok");
  const json error = command(ObstacleGrab{1, {}, {}, 1});
  EXPECT_EQ(error.at("code"), "limit");
  EXPECT_EQ(error.at("message"), "the scene is held at 64 points, the most allowed");
  EXPECT_EQ(command(ClothGrab{0, 0.5, 0.5, {}, 1}).at("code"), "limit");
}

TEST_F(ObstacleCommands, OneThatLeavesStaysWhereItDid) {
  EXPECT_EQ(command(ObstacleMove{1, {0, 999.9, 0}, {}}).at("op"), "ok");
  steps(1);
  EXPECT_EQ(command(ObstacleThrow{1, {0, 100, 0}, {}}).at("op"), "ok");
  steps(12);  // of 1.7 m: farther than 1000 m from all that the scene began with
  const float left = reader.frames.back().obstacles.at(0).position[1];
  EXPECT_GT(left, 1000);
  steps(3);
  EXPECT_EQ(reader.frames.back().obstacles.at(0).position[1], left);
}

TEST_F(Commands, HandsTakeHoldPullAndLetGo) {
  const json grabbed = command(ClothGrab{0, 0.5, 1.0, {}, 50});
  const std::uint32_t grab = grabbed.at("grab");
  EXPECT_EQ(live.simulation().cloths()[0].grabs().at(0).max_force, 50);
  EXPECT_EQ(command(GrabMove{grab, {0, 0, 2}}).at("op"), "ok");
  EXPECT_EQ(live.simulation().cloths()[0].grabs().at(0).hand, Vec3(0, 0, 2));
  steps(30);
  // Another viewer does not hold it.
  live.apply(other.viewer, other_visit, {7, GrabMove{grab, {0, 0, 0}}});
  drain();
  EXPECT_EQ(other.reply(7).at("code"), "not_found");
  EXPECT_EQ(other.reply(7).at("message"),
            "/grab is " + std::to_string(grab) + "; this viewer holds nothing by that id");
  EXPECT_EQ(command(GrabRelease{grab}).at("op"), "ok");
  EXPECT_EQ(command(GrabRelease{grab}).at("code"), "not_found");
  EXPECT_TRUE(live.simulation().cloths()[0].grabs().empty());
  const json error = command(ClothGrab{1, 0.5, 1.0, {}, 50});
  EXPECT_EQ(error.at("path"), "/cloth");
  EXPECT_EQ(error.at("message"), "/cloth is 1; the scene has 1 cloths, counted from 0");
}

TEST_F(Commands, WhoLeavesLetsGoAndAResetLetsAllGo) {
  command(ClothGrab{0, 0.5, 1.0, {}, 50});
  live.apply(other.viewer, other_visit, {7, ClothGrab{0, 0.2, 1.0, {}, 50}});
  EXPECT_EQ(live.simulation().cloths()[0].grabs().size(), 2u);
  live.remove_viewer(other.viewer.get(), other_visit);
  EXPECT_EQ(live.simulation().cloths()[0].grabs().size(), 1u);
  command(Reset{});
  EXPECT_TRUE(live.simulation().cloths()[0].grabs().empty());
  EXPECT_EQ(command(GrabRelease{1}).at("code"), "not_found");
}

TEST_F(Commands, AllViewersAreToldOfPins) {
  const json corners = {{{"u", {0.0, 0.0}}, {"v", {0.0, 0.0}}}, {{"u", {1.0, 1.0}}, {"v", {0.0, 0.0}}}};
  EXPECT_EQ(reader.last("scene").at("cloths").at(0).at("pins"), corners);
  command(ClothPin{0, 0.5, 1});
  json pins = corners;
  pins.push_back({{"u", {0.5, 0.5}}, {"v", {1.0, 1.0}}});
  EXPECT_EQ(other.last("event", "cloth.pin").at("pins"), pins);
  Reader late;
  live.add_viewer(late.viewer, late.viewer->enter());
  late.drain();
  EXPECT_EQ(late.last("scene").at("cloths").at(0).at("pins"), pins);
  command(ClothUnpin{0, 0.9, 0.1});
  pins.erase(1);
  EXPECT_EQ(other.last("event", "cloth.unpin").at("pins"), pins);
  command(Reset{});
  EXPECT_EQ(other.last("event", "reset").at("pins"), json::array({corners}));
}

TEST_F(Commands, The65thGrabAndThe257thPinAreRefused) {
  for (int i = 0; i < 64; ++i) ASSERT_EQ(command(ClothGrab{0, 0.5, 0.5, {}, 1}).at("op"), "ok");
  EXPECT_EQ(command(ClothGrab{0, 0.5, 0.5, {}, 1}).at("code"), "limit");
  const int pins = static_cast<int>(live.simulation().cloths()[0].description().pins.size());
  for (int i = pins; i < 256; ++i) ASSERT_EQ(command(ClothPin{0, 0.5, 0.5}).at("op"), "ok");
  EXPECT_EQ(command(ClothPin{0, 0.5, 0.5}).at("code"), "limit");
}

TEST_F(Commands, PinsAreSetAndTakenAway) {
  const std::size_t pins = live.simulation().cloths()[0].description().pins.size();
  EXPECT_EQ(command(ClothPin{0, 0.5, 1}).at("op"), "ok");
  EXPECT_EQ(live.simulation().cloths()[0].description().pins.size(), pins + 1);
  for (std::size_t i = 0; i <= pins; ++i) EXPECT_EQ(command(ClothUnpin{0, 0.5, 1}).at("op"), "ok");
  EXPECT_EQ(command(ClothUnpin{0, 0.5, 1}).at("message"), "/cloth is 0; it has no pins");
  EXPECT_EQ(command(ClothPin{3, 0.5, 1}).at("code"), "not_found");
}

}  // namespace
}  // namespace weft::host::test
