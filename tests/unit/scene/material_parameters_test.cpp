// The table of a material's numbers against the schema: one set of names and ranges.
#include "scene/material_parameters.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/scene.h"

namespace weft::scene {
namespace {

using nlohmann::json;

const std::vector<EffectDescription> kAllThatReadIt{DampingEffect{}, PlateBendingEffect{},
                                                    StrainLimitEffect{}};

std::vector<std::string> names_in(const std::vector<EffectDescription>& effects) {
  std::vector<std::string> names;
  for (const MaterialParameter& parameter : material_parameters(effects)) names.emplace_back(parameter.name);
  return names;
}

/// Of a material's number; the limits are an object of their own in files.
json schema_of_number(const std::string& name) {
  static const json file = json::parse(std::ifstream(WEFT_SCENE_SCHEMA));
  const json& material = file.at("definitions").at("material").at("properties");
  if (name.starts_with("limit_")) return material.at("limit").at("properties").at(name.substr(6));
  if (name == "stiffening") return material.at("limit").at("properties").at(name);
  return material.at(name);
}

TEST(MaterialParameters, AreThoseThatTheScenesEffectsRead) {
  const std::vector<std::string> springs{"structural", "shear", "bending"};
  EXPECT_EQ(names_in({}), springs);
  EXPECT_EQ(names_in({GravityEffect{}, DampingEffect{}}),
            (std::vector<std::string>{"structural", "shear", "bending", "damping"}));
  EXPECT_EQ(names_in({PlateBendingEffect{}}),
            (std::vector<std::string>{"structural", "shear", "bending", "rigidity"}));
  EXPECT_EQ(names_in(kAllThatReadIt).size(), 9u);
}

TEST(MaterialParameters, HaveTheSchemasNamesAndRanges) {
  for (const MaterialParameter& parameter : material_parameters(kAllThatReadIt)) {
    SCOPED_TRACE(parameter.name);
    json schema = schema_of_number(parameter.name);
    if (schema.contains("oneOf")) {
      EXPECT_EQ(schema.at("oneOf").at(1).at("minItems"), parameter.count);
      schema = schema.at("oneOf").at(0);
    }
    EXPECT_EQ(json(parameter.range.min), schema.at("minimum"));
    EXPECT_EQ(json(parameter.range.max), schema.at("maximum"));
  }
}

TEST(MaterialParameters, AreReadAndWritten) {
  Material material;
  double next = 0.25;
  for (const MaterialParameter& parameter : material_parameters(kAllThatReadIt)) {
    std::vector<double> values;
    for (std::size_t i = 0; i < parameter.count; ++i) values.push_back(next++);
    parameter.write(material, values);
  }
  // Each has its own place.
  EXPECT_EQ(material, (Material{.density = Material{}.density,
                                .structural = 0.25,
                                .shear = 1.25,
                                .bending = 2.25,
                                .damping = 3.25,
                                .rigidity = {4.25, 5.25, 6.25},
                                .limit = {7.25, 8.25, 9.25, 10.25}}));
  next = 0.25;
  for (const MaterialParameter& parameter : material_parameters(kAllThatReadIt)) {
    for (const double value : parameter.read(material)) EXPECT_EQ(value, next++) << parameter.name;
  }
}

}  // namespace
}  // namespace weft::scene
