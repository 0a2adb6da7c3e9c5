// Frames of a torn cloth.
#include "cloth/sheet/tear/walls.h"
#include "fixtures.h"
#include "host/frame_encoder.h"
#include "host/live_scene.h"

namespace weft::host::test {
namespace {

/// A sheet far too weak for its own weight, and a whole one beside it.
scene::Scene torn_cloth() {
  scene::Scene scene = hung_cloth();
  scene.simulation.effects = {GravityEffect{}, TearingEffect{0.05, 0.05}};
  scene.simulation.cloths.push_back(scene.simulation.cloths[0]);
  scene.simulation.cloths[1].name = "strong";
  scene.simulation.cloths[1].material.structural = 0;
  return scene;
}

TEST(Tears, GoWithTheirClothsAtEveryLevel) {
  LiveScene live(torn_cloth(), protocol::Limits{});
  for (int i = 0; i < 20; ++i) live.step();
  const Cloth<float>& cloth = live.simulation().cloths()[0];
  ASSERT_NE(cloth.walls(), nullptr);
  FrameEncoder encoder;
  encoder.capture(live.simulation(), {7, 1, 0.5, 0, 0});
  for (int level = cloth.level(); level >= cloth.level() - 1; --level) {
    const protocol::Frame frame = decoded(*encoder.message({level, level}));
    ASSERT_EQ(frame.cloths.size(), 2U);
    EXPECT_EQ(frame.cloths[0].level, level);
    EXPECT_EQ(frame.cloths[0].torn_faces, cloth.walls()->at(level).torn_faces());
    EXPECT_TRUE(frame.cloths[1].torn_faces.empty());
  }
  EXPECT_FALSE(cloth.walls()->at(cloth.level()).torn_faces().empty());
}

TEST(Tears, MayBeTheMessagesLastRecord) {
  scene::Scene scene = torn_cloth();
  scene.simulation.cloths.pop_back();
  LiveScene live(scene, protocol::Limits{});
  for (int i = 0; i < 20; ++i) live.step();
  FrameEncoder encoder;
  encoder.capture(live.simulation(), {7, 1, 0.5, 0, 0});
  EXPECT_FALSE(decoded(*encoder.message({4})).cloths[0].torn_faces.empty());
}

TEST(Tears, AResetSendsTheClothWholeAgain) {
  LiveScene live(torn_cloth(), protocol::Limits{});
  Reader reader;
  const auto visit = reader.viewer->enter();
  live.add_viewer(reader.viewer, visit);
  const auto torn_shown = [&] {
    live.publish(0);
    reader.drain();
    return !reader.frames.back().cloths[0].torn_faces.empty();
  };
  for (int i = 0; i < 20; ++i) live.step();
  EXPECT_TRUE(torn_shown());
  live.apply(reader.viewer, visit, {std::nullopt, protocol::Reset{}});
  EXPECT_FALSE(torn_shown());
}

}  // namespace
}  // namespace weft::host::test
