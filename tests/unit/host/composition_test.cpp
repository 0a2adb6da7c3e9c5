// What a scene's steps are composed of: what commands change of it, and when that is due.
#include "host/composition.h"

#include "fixtures.h"

namespace weft::host::test {
namespace {

using protocol::ClothTune;
using protocol::EffectSet;
using protocol::EffectTune;

class Composed : public ::testing::Test {
 protected:
  SimulationDescription scene = hung_cloth().simulation;  // gravity, damping, paper_wind
  Composition composition{scene};
};

TEST_F(Composed, IsTheScenesAtFirst) {
  EXPECT_TRUE(composition.has("gravity"));
  EXPECT_FALSE(composition.has("tearing"));
  EXPECT_TRUE(composition.effects_off().empty());
  EXPECT_EQ(composition.materials().at(0), scene.cloths[0].material);
  EXPECT_EQ(composition.take_due(), Recompose::nothing);
}

TEST_F(Composed, EffectsThatAreOffAreListedAsTheSceneListsThem) {
  EXPECT_TRUE(composition.set(EffectSet{"paper_wind", false}));
  EXPECT_TRUE(composition.set(EffectSet{"gravity", false}));
  EXPECT_FALSE(composition.set(EffectSet{"gravity", false})) << "it is off already";
  EXPECT_EQ(composition.effects_off(), (std::vector<std::string>{"gravity", "paper_wind"}));
  SimulationDescription now = scene;
  composition.put_into(now);
  ASSERT_EQ(now.effects.size(), 1U);
  EXPECT_STREQ(name_of(now.effects[0]), "damping");
  EXPECT_EQ(composition.effects().size(), 3U) << "their parameters are kept";
}

TEST_F(Composed, ChangesAreDueOnceAndEffectsBeforeMaterials) {
  composition.set(EffectSet{"gravity", false});
  EXPECT_EQ(std::get<bool>(composition.tune(ClothTune{0, {{"structural", {800}}}})), true);
  EXPECT_EQ(composition.take_due(), Recompose::effects) << "which wake all there is";
  EXPECT_EQ(composition.take_due(), Recompose::nothing);
  composition.tune(ClothTune{0, {{"structural", {900}}}});
  EXPECT_EQ(composition.take_due(), Recompose::materials);
}

TEST_F(Composed, WhatChangesNothingIsNotDue) {
  EXPECT_EQ(std::get<bool>(composition.tune(ClothTune{0, {{"structural", {200}}}})), false) << "as it is";
  EXPECT_EQ(composition.take_due(), Recompose::nothing);
  composition.set(EffectSet{"gravity", false});
  composition.take_due();
  EXPECT_EQ(std::get<bool>(composition.tune(EffectTune{"gravity", {{"acceleration", {0, -5, 0}}}})), true);
  EXPECT_EQ(composition.take_due(), Recompose::nothing) << "the effect is off";
}

TEST_F(Composed, AWrongCommandSaysWhyAndChangesNothing) {
  const auto outcome = composition.tune(EffectTune{"gravity", {{"mass", {1}}}});
  ASSERT_TRUE(std::holds_alternative<protocol::Error>(outcome));
  EXPECT_EQ(std::get<protocol::Error>(outcome).code, "unknown_member");
  EXPECT_EQ(composition.take_due(), Recompose::nothing);
}

TEST_F(Composed, GoesOnFromWhatWasWrittenDownAndBeginsAnew) {
  composition.set(EffectSet{"damping", false});
  composition.tune(ClothTune{0, {{"structural", {800}}}});
  ServiceState state;
  composition.save(state);
  Composition other{scene};
  other.load(state);
  EXPECT_TRUE(other.is_off("damping"));
  EXPECT_EQ(other.materials().at(0).structural.warp, 800);
  EXPECT_EQ(other.take_due(), Recompose::effects) << "it was not done yet";
  other.begin_anew(scene);
  EXPECT_FALSE(other.is_off("damping"));
  EXPECT_EQ(other.materials().at(0).structural.warp, 200);
}

// A simulation that has two of the scene's effects: the other one is off.
TEST_F(Composed, FollowsASimulationThatOthersCommand) {
  SimulationDescription played = scene;
  played.effects = {GravityEffect{}, PaperWindEffect{}};
  played.cloths[0].material.density = 0.3;
  composition.follow(Simulation<float>(played));
  EXPECT_EQ(composition.effects_off(), std::vector<std::string>{"damping"});
  EXPECT_EQ(composition.materials().at(0).density, 0.3);
}

}  // namespace
}  // namespace weft::host::test
