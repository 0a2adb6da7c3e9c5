// What a cloth looks like: as the scene says, else as its fabric, else as cloth of no name. The simulation
// does not know of it.
#include "cloth/world/simulation.h"
#include "cloth/world/state_hash.h"
#include "fixtures.h"

namespace weft::scene::test {
namespace {

/// The look of a scene's only cloth, of which this is the rest.
Look look_of(const std::string& members) {
  const Scene scene = good(parse(R"({"cloths":[{"size":[2,2])" + members + "}]}", "look"));
  EXPECT_EQ(scene.looks.size(), 1u);
  return scene.looks.empty() ? Look{} : scene.looks[0];
}

TEST(Looks, AreAsTheSceneSays) {
  const Scene scene =
      good(load((std::filesystem::path(WEFT_SCENE_TEST_DATA) / "good/everything.json").string()));
  ASSERT_EQ(scene.looks.size(), scene.simulation.cloths.size());
  const Look expected{"knit", "#AB12cd", "#000000", "#ffffff", 0.01, Stripe{"#123456", 0.02, 0.1, 3, true}};
  EXPECT_EQ(scene.looks[0], expected);
}

// Each named fabric has a weave, whether the material is its name or begins with it.
TEST(Looks, FollowTheFabric) {
  const std::vector<std::pair<std::string, std::string>> weaves = {
      {"silk", "satin"}, {"cotton", "plain"},    {"canvas", "canvas"},     {"denim", "twill"},
      {"wool", "wool"},  {"polyester", "plain"}, {"stretch_wool", "twill"}};
  ASSERT_EQ(weaves.size(), fabrics().size());
  for (const auto& [fabric, weave] : weaves) {
    SCOPED_TRACE(fabric);
    const Look look = look_of(R"(,"material":")" + fabric + "\"");
    EXPECT_EQ(look.weave, weave);
    EXPECT_FALSE(look.stripe);
    EXPECT_EQ(look_of(R"(,"material":{"bending":1,"fabric":")" + fabric + "\"}"), look);
  }
}

TEST(Looks, OfNoFabricArePlainAndStriped) {
  const Look look = look_of("");
  EXPECT_EQ(look.weave, std::string("plain"));
  EXPECT_TRUE(look.stripe);
  EXPECT_EQ(look_of(R"(,"material":{"density":0.2})"), look);
}

// What a look leaves out is the weave's, not that of a fabric woven otherwise; a colour goes for all threads,
// but for twill's weft, which is what makes its back pale.
TEST(Looks, FillInWhatIsLeftOut) {
  const Look leather = look_of(R"(,"material":"silk","look":{"weave":"leather"})");
  EXPECT_NE(leather.colour, look_of(R"(,"material":"silk")").colour);
  const Look red = look_of(R"(,"material":"cotton","look":{"colour":"#ff0000"})");
  EXPECT_EQ(red.weave, std::string("plain"));
  EXPECT_EQ(red.weft, "#ff0000");
  const Look denim = look_of(R"(,"material":"denim")");
  const Look black = look_of(R"(,"material":"denim","look":{"colour":"#101010"})");
  EXPECT_EQ(black.colour, "#101010");
  EXPECT_EQ(black.weft, denim.weft);
  EXPECT_NE(denim.weft, denim.colour);
  const Look wide = look_of(R"(,"look":{"stripe":{"colour":"#123456","spacing":0.2}})");
  ASSERT_TRUE(wide.stripe);
  EXPECT_EQ(*wide.stripe, (Stripe{"#123456", 0.1, 0.2, 1, false}));
}

TEST(Looks, DoNotChangeTheSimulation) {
  const auto hash = [](const std::string& look) {
    const std::string text = R"({"cloths":[{"levels":{"min":4,"max":4},"pins":["top_left"])" + look +
                             R"(}],"effects":[{"type":"gravity"}]})";
    Simulation<float> simulation(good(parse(text, "look")).simulation);
    for (int step = 0; step < 10; ++step) simulation.step();
    return state_hash(simulation);
  };
  EXPECT_EQ(hash(R"(,"look":{"weave":"wool","colour":"#ff0000"})"), hash(""));
}

}  // namespace
}  // namespace weft::scene::test
