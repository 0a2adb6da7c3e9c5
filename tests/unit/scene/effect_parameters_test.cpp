// The table of the effects' numbers against the schema and the reader: one set of names and ranges.
#include "scene/effect_parameters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/scene.h"

namespace weft::scene {
namespace {

using nlohmann::json;

json schema_of(const EffectDescription& effect) {
  static const json schema = json::parse(std::ifstream(WEFT_SCENE_SCHEMA));
  const auto name = std::visit([](const auto& each) { return std::string(each.kName); }, effect);
  return schema.at("definitions").at(name).at("properties");
}

/// Each type, and both kinds of inflation.
std::vector<EffectDescription> all_effects() {
  InflationEffect gas;
  gas.volume = 0.1;
  return {GravityEffect{},       DampingEffect{},
          PaperWindEffect{},     AerodynamicsEffect{},
          StrainDampingEffect{}, PlateBendingEffect{},
          StrainLimitEffect{},   ClothContactEffect{},
          InflationEffect{},     gas,
          TearingEffect{}};
}

TEST(EffectParameters, HaveTheSchemasNamesAndRanges) {
  int numbers = 0;
  for (const EffectDescription& effect : all_effects()) {
    for (const EffectParameter& parameter : parameters_of(effect)) {
      SCOPED_TRACE(parameter.name);
      ++numbers;
      ASSERT_TRUE(schema_of(effect).contains(parameter.name));
      json property = schema_of(effect).at(parameter.name);
      if (property.contains("oneOf")) property = property.at("oneOf").at(0);
      if (property.contains("items")) {
        EXPECT_EQ(property.at("minItems"), parameter.count);
        property = property.at("items");
      }
      // Of gas the schema, which cannot tell it from a pump by this member alone, allows what a pump may
      // have.
      const auto* inflation = std::get_if<InflationEffect>(&effect);
      const bool above_vacuum =
          inflation != nullptr && inflation->volume && std::string(parameter.name) == "pressure";
      EXPECT_EQ(above_vacuum ? json(-1e6) : json(parameter.range.min), property.at("minimum"));
      EXPECT_EQ(json(parameter.range.max), property.at("maximum"));
    }
  }
  EXPECT_EQ(numbers, 13);
}

TEST(EffectParameters, AreReadAndWritten) {
  for (EffectDescription effect : all_effects()) {
    for (const EffectParameter& parameter : parameters_of(effect)) {
      SCOPED_TRACE(parameter.name);
      EXPECT_EQ(parameter.read(effect).size(), parameter.count);
      std::vector<double> values;
      for (std::size_t i = 0; i < parameter.count; ++i) values.push_back(0.25 + double(i));
      parameter.write(effect, values);
      EXPECT_EQ(parameter.read(effect), values);
    }
  }
}

TEST(EffectParameters, OfLiftIsDragUntilItIsSet) {
  EffectDescription effect = AerodynamicsEffect{1, 2};
  const EffectParameter& lift = parameters_of(effect)[2];
  ASSERT_STREQ(lift.name, "lift");
  EXPECT_EQ(lift.read(effect), std::vector<double>{2});
  EXPECT_FALSE(std::get<AerodynamicsEffect>(effect).lift);
  lift.write(effect, {0});
  EXPECT_EQ(lift.read(effect), std::vector<double>{0});
}

TEST(EffectParameters, BoundTheReaderToo) {
  // At each bound a scene is read, a little beyond it is not.
  for (const EffectDescription& effect : all_effects()) {
    const auto* inflation = std::get_if<InflationEffect>(&effect);
    if (inflation != nullptr && inflation->volume) continue;  // needs a sewn cloth
    for (const EffectParameter& parameter : parameters_of(effect)) {
      for (const double bound : {parameter.range.min, parameter.range.max}) {
        for (const double by : {0.0, bound == parameter.range.min ? -1e-6 : 1e-6}) {
          const double number = bound + by * std::max(1.0, std::abs(bound));
          json listed{{"type", std::visit([](const auto& e) { return e.kName; }, effect)}};
          listed[parameter.name] = number;
          if (!parameter.takes_one()) listed[parameter.name] = std::vector<double>(parameter.count, number);
          const Result result = from_json({{"cloths", {json::object()}}, {"effects", {listed}}}, "bounds");
          EXPECT_EQ(std::holds_alternative<Scene>(result), by == 0) << listed;
        }
      }
    }
  }
}

}  // namespace
}  // namespace weft::scene
