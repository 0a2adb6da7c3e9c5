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
  if (name == "structural_weft") return material.at("structural");
  if (name == "stiffening") return material.at("limit").at("properties").at(name);
  return material.at(name);
}

TEST(MaterialParameters, AreThoseThatTheScenesEffectsRead) {
  const std::vector<std::string> springs{"structural", "structural_weft", "shear", "bending"};
  EXPECT_EQ(names_in({}), springs);
  EXPECT_EQ(names_in({GravityEffect{}, DampingEffect{}}),
            (std::vector<std::string>{"structural", "structural_weft", "shear", "bending", "damping"}));
  EXPECT_EQ(names_in({PlateBendingEffect{}}),
            (std::vector<std::string>{"structural", "structural_weft", "shear", "bending", "rigidity"}));
  EXPECT_EQ(names_in(kAllThatReadIt).size(), 10u);
}

TEST(MaterialParameters, HaveTheSchemasNamesAndRanges) {
  for (const MaterialParameter& parameter : material_parameters(kAllThatReadIt)) {
    SCOPED_TRACE(parameter.name);
    json schema = schema_of_number(parameter.name);
    if (schema.contains("oneOf")) {
      if (parameter.count > 1) {
        EXPECT_EQ(schema.at("oneOf").at(1).at("minItems"), parameter.count);
      }
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
                                .structural = {0.25, 1.25},
                                .shear = 2.25,
                                .bending = 3.25,
                                .damping = 4.25,
                                .rigidity = {5.25, 6.25, 7.25},
                                .limit = {8.25, 9.25, 10.25, 11.25}}));
  next = 0.25;
  for (const MaterialParameter& parameter : material_parameters(kAllThatReadIt)) {
    for (const double value : parameter.read(material)) EXPECT_EQ(value, next++) << parameter.name;
  }
}

TEST(MaterialParameters, TheWeftKeepsItsShareOfTheWarpsStiffness) {
  const std::vector<MaterialParameter> known = material_parameters({});
  const MaterialParameter &structural = known[0], &weft = known[1];
  Material material;
  structural.write(material, {800});  // one sheet alike both ways stays so
  EXPECT_EQ(material.structural, Stiffness(800));
  weft.write(material, {200});
  EXPECT_EQ(material.structural, Stiffness(800, 200));
  structural.write(material, {400});
  EXPECT_EQ(material.structural, Stiffness(400, 100));
  weft.write(material, {1e9});
  structural.write(material, {4000});  // ten times as much would be out of the range
  EXPECT_EQ(material.structural, Stiffness(4000, 1e9));
  material.structural = {0, 100};
  structural.write(material, {400});  // no share of nothing
  EXPECT_EQ(material.structural, Stiffness(400, 100));
}

}  // namespace
}  // namespace weft::scene
