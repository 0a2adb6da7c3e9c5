// cloth.tune and friction.set: materials and friction of a live scene changed, and who is told.
#include "live_scene_test.h"

namespace weft::host::test {
namespace {

using protocol::ClothTune;
using protocol::FrictionSet;

/// A cloth over a ball and a floor.
scene::Scene cloth_on_things() {
  scene::Scene scene = hung_cloth();
  scene.simulation.effects = {GravityEffect{}, DampingEffect{}, StrainLimitEffect{}};
  BallDescription ball;
  ball.position = {0, -0.4, 0.05};
  ball.friction = 0.3;
  scene.simulation.balls = {ball};
  ObstacleDescription floor, box;
  floor.position = {0, -3, 0};
  floor.friction = 0.5;
  box.shape = BoxDescription{};
  box.position = {0, -5, 0};
  scene.simulation.obstacles = {floor, box};
  return scene;
}

class MaterialCommands : public LiveSceneTest {
 protected:
  MaterialCommands() : LiveSceneTest(cloth_on_things()) {}
  template <class Command>
  void expect_refused(const Command& wrong, const char* code, const char* path, const char* message) {
    const json error = command(wrong);
    EXPECT_EQ(error.value("code", ""), code) << error;
    EXPECT_EQ(error.value("path", ""), path);
    EXPECT_EQ(error.value("message", ""), message);
  }
  static std::vector<double> frictions_of(const json& things) {
    std::vector<double> frictions;
    for (const json& thing : things) frictions.push_back(thing.at("friction"));
    return frictions;
  }
};

class Looks : public LiveSceneTest {
 protected:
  static scene::Scene looks() {
    scene::Scene scene = hung_cloth();
    scene.simulation.cloths.push_back(scene.simulation.cloths[0]);
    scene.simulation.cloths[1].position = {0, 0, 1};
    scene.looks = {
        {"twill", "#24406e", "#c9cdd3", "", 0.003, {}},
        {"plain", "#ffffff", "#fffffe", "#000000", 0.002, scene::Stripe{"#b3263c", 0.06, 0.12, 3, true}}};
    return scene;
  }
  Looks() : LiveSceneTest(looks()) {}
};

TEST_F(Looks, AreTold) {
  drain();
  const json cloths = other.last("scene").at("cloths");
  EXPECT_EQ(cloths.at(0).at("look"),
            json::parse(R"({"weave": "twill", "colour": "#24406e", "weft": "#c9cdd3", "thread": 0.003})"));
  EXPECT_EQ(cloths.at(1).at("look"), json::parse(R"({
    "weave": "plain", "colour": "#ffffff", "weft": "#fffffe", "back": "#000000", "thread": 0.002,
    "stripe": {"colour": "#b3263c", "width": 0.06, "spacing": 0.12, "bands": 3, "across": true}})"));
}

TEST_F(MaterialCommands, ASceneTellsItsMaterialsAndWhatTheyMayBe) {
  drain();
  const json scene = other.last("scene");
  EXPECT_EQ(scene.at("cloths").at(0).at("material"), json::parse(R"({
    "structural": 200, "structural_weft": 200, "shear": 20, "bending": 0.01, "damping": 0.1,
    "limit_warp": 0.05, "limit_weft": 0.08, "limit_shear": 0.3, "stiffening": 20})"));
  const json& tunable = scene.at("material_tunable");
  EXPECT_EQ(tunable.size(), 9u);
  EXPECT_EQ(tunable.at("structural"), json::parse(R"({"range": [0, 1000000000], "unit": "N/m"})"));
  EXPECT_EQ(tunable.at("limit_shear"),
            json::parse(R"({"range": [0.001, 1.5], "unit": "rad", "effect": "strain_limit"})"));
}

TEST_F(MaterialCommands, AreToldToAllAndTakeEffectInTheNextStep) {
  steps(7);
  const json ok = command(ClothTune{0, {{"structural", {800}}, {"limit_warp", {0.5}}}});
  EXPECT_EQ(ok.at("op"), "ok");
  EXPECT_EQ(ok.at("f"), 8);
  const json event = other.last("event", "cloth.tune");
  EXPECT_EQ(event.at("f"), 8);
  EXPECT_EQ(event.at("cloth"), 0);
  EXPECT_EQ(event.at("material"), json::parse(R"({
    "structural": 800, "structural_weft": 800, "shear": 20, "bending": 0.01, "damping": 0.1,
    "limit_warp": 0.5, "limit_weft": 0.08, "limit_shear": 0.3, "stiffening": 20})"));
  EXPECT_EQ(scene_now().at("cloths").at(0).at("material"), event.at("material"));
  EXPECT_EQ(live.simulation().cloths()[0].description().material.structural, 200);  // not yet
  live.step();
  EXPECT_EQ(live.simulation().cloths()[0].description().material.structural, 800);
  EXPECT_EQ(live.studied().cloths[0].material.limit.warp, 0.5);
}

TEST_F(MaterialCommands, SetTheWeftAloneAndItsShareStays) {
  command(ClothTune{0, {{"structural_weft", {50}}}});
  EXPECT_EQ(other.last("event", "cloth.tune").at("material").at("structural"), 200);
  command(ClothTune{0, {{"structural", {400}}}});
  EXPECT_EQ(other.last("event", "cloth.tune").at("material").at("structural_weft"), 100);
  live.step();
  EXPECT_EQ(live.simulation().cloths()[0].description().material.structural, Stiffness(400, 100));
}

TEST_F(MaterialCommands, OfManyBeforeAStepTheLastCounts) {
  for (int i = 1; i <= 50; ++i) command(ClothTune{0, {{"damping", {0.1 * i}}}});
  scene::Scene slow = cloth_on_things();
  slow.simulation.cloths[0].material.damping = 0.1 * 50;
  expect_steps_as(slow);
}

TEST_F(MaterialCommands, ToTheSameChangeNothing) {
  const std::uint64_t number = live.study_number();
  expect_steps_as(cloth_on_things(), [&] {
    EXPECT_EQ(command(ClothTune{0, {{"shear", {20}}}}).at("op"), "ok");
    EXPECT_EQ(command(FrictionSet{0.3, 1, {}}).at("op"), "ok");
  });
  EXPECT_TRUE(other.last("event", "cloth.tune").is_null());
  EXPECT_TRUE(other.last("event", "friction").is_null());
  EXPECT_EQ(live.study_number(), number);
}

TEST_F(MaterialCommands, ThatAreWrongSayWhatIsAllowedAndChangeNothing) {
  expect_refused(ClothTune{1, {{"shear", {1}}}}, "not_found", "/cloth",
                 "/cloth is 1; the scene has 1 cloths, counted from 0");
  expect_refused(ClothTune{0, {{"shear", {2}}, {"structural", {-1}}}}, "range", "/parameters/structural",
                 "/parameters/structural is -1; allowed: 0..1000000000 (N/m)");
  // No effect of the scene reads it.
  expect_refused(
      ClothTune{0, {{"rigidity", {1}}}}, "unknown_member", "/parameters/rigidity",
      "/parameters/rigidity is 1; allowed: in the material only structural, structural_weft, shear, bending, "
      "damping, limit_warp, limit_weft, limit_shear, stiffening");
  expect_refused(
      ClothTune{0, {{"density", {1}}}}, "unknown_member", "/parameters/density",
      "/parameters/density is 1; allowed: in the material only structural, structural_weft, shear, bending, "
      "damping, limit_warp, limit_weft, limit_shear, stiffening");
  expect_refused(FrictionSet{1, 2, {}}, "not_found", "/ball", "/ball is 2; the scene has no such ball");
  expect_refused(FrictionSet{1, {}, 2}, "not_found", "/obstacle",
                 "/obstacle is 2; the scene has 2 obstacles, counted from 0");
  json now = scene_now(), before = other.last("scene");
  now.erase("seat");  // which is each viewer's own
  before.erase("seat");
  EXPECT_EQ(now, before);
  EXPECT_TRUE(other.last("event").is_null());
}

TEST_F(MaterialCommands, SetTheFrictionOfOneThingOrOfAll) {
  drain();
  EXPECT_EQ(frictions_of(other.last("scene").at("balls")), (std::vector<double>{0.3}));
  EXPECT_EQ(frictions_of(other.last("scene").at("obstacles")), (std::vector<double>{0.5, 0}));
  const auto expect_now = [&](double ball, double floor, double box) {
    const json event = other.last("event", "friction");
    EXPECT_EQ(frictions_of(event.at("balls")), (std::vector<double>{ball}));
    EXPECT_EQ(event.at("frictions"), json({floor, box}));
    const json scene = scene_now();
    EXPECT_EQ(frictions_of(scene.at("balls")), (std::vector<double>{ball}));
    EXPECT_EQ(frictions_of(scene.at("obstacles")), (std::vector<double>{floor, box}));
    EXPECT_EQ(live.studied().balls[0].friction, ball);
    EXPECT_EQ(live.studied().obstacles[1].friction, box);
  };
  const std::uint64_t number = live.study_number();
  EXPECT_EQ(command(FrictionSet{0.8, 1, {}}).at("f"), 1);
  expect_now(0.8, 0.5, 0);
  EXPECT_NE(live.study_number(), number);
  command(FrictionSet{2, {}, 1});
  expect_now(0.8, 0.5, 2);
  command(FrictionSet{0.1, {}, {}});
  expect_now(0.1, 0.1, 0.1);
}

TEST_F(MaterialCommands, OfAnAddedBallAreKept) {
  protocol::BallAdd rough;
  rough.position = {0, 5, 0};
  rough.radius = 0.1;
  rough.friction = 0.6;
  const json ok = command(rough);
  EXPECT_EQ(frictions_of(other.last("event", "ball.add").at("balls")), (std::vector<double>{0.3, 0.6}));
  command(protocol::BallRemove{1});
  EXPECT_EQ(live.studied().balls[0].friction, 0.3);  // what is studied is the scene from its start
  EXPECT_EQ(command(FrictionSet{0.7, ok.at("ball").get<std::uint32_t>(), {}}).at("op"), "ok");
  EXPECT_EQ(frictions_of(other.last("event", "friction").at("balls")), (std::vector<double>{0.7}));
}

// With the ball goes the friction it was given: what is studied is the scene's own again.
TEST_F(MaterialCommands, StudyIsOutdatedByTheRemovalOfABallOfOtherFriction) {
  command(FrictionSet{0.9, 1, {}});
  EXPECT_EQ(live.studied().balls[0].friction, 0.9);
  const std::uint64_t number = live.study_number();
  command(protocol::BallRemove{1});
  EXPECT_EQ(live.studied().balls[0].friction, 0.3);
  EXPECT_NE(live.study_number(), number);
}

TEST_F(MaterialCommands, AResetBringsTheScenesOwnBack) {
  drain();
  const json own = other.last("scene").at("cloths").at(0).at("material");
  command(ClothTune{0, {{"bending", {50}}}});
  command(FrictionSet{0.1, {}, {}});
  steps(10);
  const std::uint64_t number = live.study_number();
  command(protocol::Reset{});
  EXPECT_NE(live.study_number(), number);
  const json reset = other.last("event", "reset");
  EXPECT_EQ(reset.at("materials"), json::array({own}));
  EXPECT_EQ(reset.at("frictions"), json({0.5, 0.0}));
  EXPECT_EQ(frictions_of(reset.at("balls")), (std::vector<double>{0.3}));
  expect_steps_as(cloth_on_things());
}

}  // namespace
}  // namespace weft::host::test
