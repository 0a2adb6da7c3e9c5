// effect.tune: parameters of a live scene's effects changed, and who is told.
#include "live_scene_test.h"

namespace weft::host::test {
namespace {

using protocol::EffectTune;

scene::Scene windy_cloth() {
  scene::Scene scene = hung_cloth();
  scene.simulation.effects = {GravityEffect{}, DampingEffect{}, AerodynamicsEffect{},
                              TearingEffect{1e6, 1e6}};
  return scene;
}

class TuneCommands : public LiveSceneTest {
 protected:
  TuneCommands() : LiveSceneTest(windy_cloth()) {}
  void expect_refused(const EffectTune& tuning, const char* code, const char* path, const char* message) {
    const json error = command(tuning);
    EXPECT_EQ(error.value("code", ""), code) << error;
    EXPECT_EQ(error.value("path", ""), path);
    EXPECT_EQ(error.value("message", ""), message);
  }
};

TEST_F(TuneCommands, ASceneTellsItsParametersAndWhatTheyMayBe) {
  drain();
  const json scene = other.last("scene");
  EXPECT_EQ(scene.at("parameters"), json::parse(R"({
    "gravity": {"acceleration": [0, -9.81, 0]},
    "aerodynamics": {"air_density": 1.225, "drag": 1.2, "lift": 1.2},
    "tearing": {"strength": [1000000, 1000000]}})"));
  EXPECT_EQ(scene.at("tunable"), json::parse(R"({
    "gravity": {"acceleration": {"range": [-10000, 10000], "unit": "m/s2"}},
    "aerodynamics": {"air_density": {"range": [0, 10000], "unit": "kg/m3"},
                     "drag": {"range": [0, 100], "unit": ""},
                     "lift": {"range": [0, 100], "unit": ""}},
    "tearing": {"strength": {"range": [0.001, 1000000000], "unit": "N/m"}}})"));
}

TEST_F(TuneCommands, AreToldToAllAndTakeEffectInTheNextStep) {
  steps(7);
  const json ok = command(EffectTune{"aerodynamics", {{"drag", {2.5}}}});
  EXPECT_EQ(ok.at("op"), "ok");
  EXPECT_EQ(ok.at("f"), 8);
  const json event = other.last("event", "tune");
  EXPECT_EQ(event.at("f"), 8);
  EXPECT_EQ(event.at("effect"), "aerodynamics");
  // The scene gives no lift: it goes with drag until somebody sets it.
  EXPECT_EQ(event.at("parameters"), json::parse(R"({"air_density": 1.225, "drag": 2.5, "lift": 2.5})"));
  EXPECT_EQ(scene_now().at("parameters").at("aerodynamics"), event.at("parameters"));
  command(EffectTune{"aerodynamics", {{"lift", {0.5}}, {"air_density", {1}}}});
  command(EffectTune{"aerodynamics", {{"drag", {1}}}});
  EXPECT_EQ(other.last("event", "tune").at("parameters"),
            json::parse(R"({"air_density": 1, "drag": 1, "lift": 0.5})"));
  command(EffectTune{"tearing", {{"strength", {800}}}});  // for both directions
  EXPECT_EQ(other.last("event", "tune").at("parameters"), json::parse(R"({"strength": [800, 800]})"));
  command(EffectTune{"tearing", {{"strength", {700, 900.5}}}});
  EXPECT_EQ(other.last("event", "tune").at("parameters"), json::parse(R"({"strength": [700, 900.5]})"));
  EXPECT_EQ(name_of(live.studied().effects[3]), std::string("tearing"));
  EXPECT_EQ(std::get<TearingEffect>(live.studied().effects[3]).weft, 900.5);
}

TEST_F(TuneCommands, ThatAreWrongSayWhatIsAllowedAndChangeNothing) {
  expect_refused({"inflation", {{"pressure", {1}}}}, "unavailable", "/effect",
                 "the scene has no effect \"inflation\"");
  expect_refused({"levitation", {{"pressure", {1}}}}, "unavailable", "/effect",
                 "the scene has no effect \"levitation\"");
  expect_refused({"aerodynamics", {{"drug", {1}}}}, "unknown_member", "/parameters/drug",
                 "/parameters/drug is 1; allowed: in aerodynamics only air_density, drag, lift");
  expect_refused({"damping", {{"k", {0.5}}}}, "unknown_member", "/parameters/k",
                 "/parameters/k is 0.5; allowed: in damping none");
  expect_refused({"aerodynamics", {{"drag", {100.5}}}}, "range", "/parameters/drag",
                 "/parameters/drag is 100.5; allowed: 0..100");
  expect_refused({"gravity", {{"acceleration", {0, -2e4, 0}}}}, "range", "/parameters/acceleration/1",
                 "/parameters/acceleration/1 is -20000; allowed: -10000..10000 (m/s2)");
  expect_refused({"gravity", {{"acceleration", {-9.81}}}}, "bad_type", "/parameters/acceleration",
                 "/parameters/acceleration is -9.81; allowed: an array of 3 numbers -10000..10000 (m/s2)");
  expect_refused({"aerodynamics", {{"drag", {1, 2}}}}, "bad_type", "/parameters/drag",
                 "/parameters/drag is [1,2]; allowed: a number 0..100");
  expect_refused(
      {"tearing", {{"strength", {1, 2, 3}}}}, "bad_type", "/parameters/strength",
      "/parameters/strength is [1,2,3]; allowed: a number 0.001..1000000000 (N/m) or an array of 2 "
      "numbers 0.001..1000000000 (N/m)");
  // The first that is wrong is told, and none of the right ones is taken.
  expect_refused({"aerodynamics", {{"air_density", {2}}, {"drag", {-1}}}}, "range", "/parameters/drag",
                 "/parameters/drag is -1; allowed: 0..100");
  EXPECT_EQ(scene_now().at("parameters"), other.last("scene").at("parameters"));
  EXPECT_TRUE(other.last("event", "tune").is_null());
}

TEST_F(TuneCommands, ToTheSameChangeNothing) {
  expect_steps_as(windy_cloth(), [&] {
    EXPECT_EQ(command(EffectTune{"aerodynamics", {{"drag", {1.2}}}}).at("op"), "ok");
  });
  EXPECT_TRUE(other.last("event", "tune").is_null());
}

TEST_F(TuneCommands, ManyBeforeAStepComposeTheSceneOnce) {
  for (int i = 1; i <= 50; ++i) command(EffectTune{"gravity", {{"acceleration", {0, -0.1 * i, 0}}}});
  EXPECT_EQ(live.simulation().gravity().y(), -9.81);  // not yet
  scene::Scene weak = windy_cloth();
  weak.simulation.effects[0] = GravityEffect{{0, -0.1 * 50, 0}};
  expect_steps_as(weak);
  EXPECT_EQ(live.simulation().gravity().y(), -0.1 * 50);
}

TEST_F(TuneCommands, WhileItIsAwayAreKeptForWhenItComesBack) {
  command(protocol::EffectSet{"gravity", false});
  command(EffectTune{"gravity", {{"acceleration", {0, 1, 0}}}});
  EXPECT_EQ(other.last("event", "tune").at("effect"), "gravity");
  live.step();
  EXPECT_EQ(live.simulation().gravity().y(), 0);
  command(protocol::EffectSet{"gravity", true});
  live.step();
  EXPECT_EQ(live.simulation().gravity().y(), 1);
}

TEST_F(TuneCommands, AResetBringsTheScenesOwnBack) {
  command(EffectTune{"gravity", {{"acceleration", {0, 1, 0}}}});
  steps(10);
  const std::uint64_t number = live.study_number();
  command(protocol::Reset{});
  EXPECT_NE(live.study_number(), number);
  const json own = other.last("scene").at("parameters");
  EXPECT_EQ(other.last("event", "reset").at("parameters"), own);
  EXPECT_EQ(scene_now().at("parameters"), own);
  expect_steps_as(windy_cloth());
}

TEST_F(TuneCommands, MakeAStudyOutOfDate) {
  const std::uint64_t number = live.study_number();
  command(EffectTune{"gravity", {{"acceleration", {0, 1, 0}}}});
  EXPECT_NE(live.study_number(), number);
  EXPECT_EQ(std::get<GravityEffect>(live.studied().effects[0]).acceleration.y(), 1);
}

}  // namespace
}  // namespace weft::host::test
