// effect.set: effects of a live scene taken away and brought back, and who is told.
#include "choices.h"
#include "live_scene_test.h"

namespace weft::host::test {
namespace {

using protocol::EffectSet;

class EffectCommands : public LiveSceneTest {
 protected:
  EffectCommands() : LiveSceneTest(hung_cloth()) {}
  std::vector<std::string> studied() const {
    std::vector<std::string> names;
    for (const EffectDescription& effect : live.studied().effects) names.emplace_back(name_of(effect));
    return names;
  }
};

using Names = std::vector<std::string>;

TEST_F(EffectCommands, AreToldToAllAndTakeEffectInTheNextStep) {
  EXPECT_FALSE(other.last("scene").contains("effects_off"));
  steps(7);
  const json ok = command(EffectSet{"paper_wind", false});
  EXPECT_EQ(ok.at("op"), "ok");
  EXPECT_EQ(ok.at("f"), 8);
  const json event = other.last("event", "effect");
  EXPECT_EQ(event.at("f"), 8);
  EXPECT_EQ(event.at("effect"), "paper_wind");
  EXPECT_EQ(event.at("on"), false);
  EXPECT_EQ(event.at("effects_off"), json({"paper_wind"}));
  EXPECT_EQ(studied(), (Names{"gravity", "damping"}));
  command(EffectSet{"gravity", false});
  EXPECT_EQ(other.last("event", "effect").at("effects_off"), json({"gravity", "paper_wind"}));  // as listed
  const json late = scene_now();
  EXPECT_EQ(late.at("effects_off"), json({"gravity", "paper_wind"}));
  EXPECT_EQ(late.at("effects"), json({"gravity", "damping", "paper_wind"}));
  command(EffectSet{"paper_wind", true});
  EXPECT_EQ(other.last("event", "effect").at("on"), true);
  EXPECT_EQ(other.last("event", "effect").at("effects_off"), json({"gravity"}));
  EXPECT_EQ(studied(), (Names{"damping", "paper_wind"}));
}

TEST_F(EffectCommands, OfOthersAreRefusedAndOfTheSameChangeNothing) {
  const json error = command(EffectSet{"aerodynamics", false});
  EXPECT_EQ(error.at("code"), "unavailable");
  EXPECT_EQ(error.at("path"), "/effect");
  EXPECT_EQ(error.at("message"), "the scene has no effect \"aerodynamics\"");
  expect_steps_as(hung_cloth(), [&] { EXPECT_EQ(command(EffectSet{"gravity", true}).at("op"), "ok"); });
  EXPECT_TRUE(other.last("event", "effect").is_null());
}

TEST_F(EffectCommands, AreSteppedAsASceneThatDoesNotListThem) {
  scene::Scene less = hung_cloth();
  less.simulation.effects = {GravityEffect{}, PaperWindEffect{}};
  command(EffectSet{"damping", false});
  expect_steps_as(less);
}

TEST_F(EffectCommands, AResetBringsAllBack) {
  command(EffectSet{"gravity", false});
  steps(10);
  command(protocol::Reset{});
  EXPECT_FALSE(scene_now().contains("effects_off"));
  expect_steps_as(hung_cloth());
}

TEST_F(EffectCommands, MakeAStudyOutOfDate) {
  command(protocol::Quality{std::nullopt, 2.0});
  EXPECT_TRUE(live.wants_study());
  live.take_study({three_levels(), ""});
  EXPECT_FALSE(live.wants_study());
  live.send_stats(1);
  drain();
  EXPECT_EQ(other.last("stats").at("quality").at("state"), "chosen");
  const std::uint64_t number = live.study_number();
  command(EffectSet{"damping", false});
  EXPECT_NE(live.study_number(), number);
  EXPECT_TRUE(live.wants_study());  // the wish is still there
  live.send_stats(1);
  drain();
  EXPECT_EQ(other.last("stats").at("quality").at("state"), "measuring");
  // Without a wish it is studied when somebody asks.
  command(protocol::Quality{});
  EXPECT_FALSE(live.wants_study());
  command(protocol::Cost{});
  EXPECT_TRUE(live.wants_study());
  command(EffectSet{"damping", true});
  EXPECT_TRUE(live.wants_study());  // one who waits for the curve still does
  live.take_study({three_levels(), ""});
  drain();
  EXPECT_FALSE(reader.last("curve").is_null());
  command(EffectSet{"damping", false});
  EXPECT_FALSE(live.wants_study());
}

}  // namespace
}  // namespace weft::host::test
