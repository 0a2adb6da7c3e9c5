// scene.schema.json and the reader say the same, as far as a schema can say it.
#include <set>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "fixtures.h"

namespace weft::scene::test {
namespace {

using nlohmann::json;

class SchemaTest : public testing::Test {
 protected:
  SchemaTest() {
    const json document = json::parse(read_file(WEFT_SCENE_SCHEMA));
    valijson::adapters::NlohmannJsonAdapter adapter(document);
    valijson::SchemaParser().populateSchema(adapter, schema_);
  }

  /// What the schema says against `document`; empty if nothing.
  std::string errors(const json& document) const {
    valijson::adapters::NlohmannJsonAdapter adapter(document);
    valijson::ValidationResults results;
    std::string text;
    if (valijson::Validator().validate(schema_, adapter, &results)) return text;
    for (const auto& error : results) {
      for (const std::string& part : error.context) text += part;
      text += ": " + error.description + "\n";
    }
    return text;
  }

  valijson::Schema schema_;
};

TEST_F(SchemaTest, AcceptsThePresets) {
  for (const Preset& preset : presets()) {
    EXPECT_EQ(errors(json::parse(preset.text)), "") << preset.name;
  }
}

TEST_F(SchemaTest, AcceptsGoodFiles) {
  const auto files = scene_files("good");
  EXPECT_GE(files.size(), 3u);
  for (const auto& file : files) {
    EXPECT_EQ(errors(json::parse(read_file(file))), "") << file;
    good(load(file.string()));
  }
}

TEST_F(SchemaTest, RefusesWhatTheReaderRefuses) {
  // Relations between fields, and what is no longer there once JSON has been read.
  const std::set<std::string> beyond_a_schema = {
      "ball_path_order",    "bodies_thin", "duplicate_keys",    "effect_twice",
      "level_policy_order", "nodes_count", "pin_span_descends", "surfaces_values",
      "too_many_nodes",     "wind_unread", "zero_direction",
  };
  int refused = 0;
  for (const auto& file : scene_files("bad")) {
    const json document = json::parse(read_file(file), nullptr, false);
    if (document.is_discarded()) continue;  // not JSON, or a number that is not finite
    const bool beyond = beyond_a_schema.count(file.stem().string()) > 0;
    EXPECT_EQ(errors(document).empty(), beyond) << file;
    refused += beyond ? 0 : 1;
  }
  EXPECT_GE(refused, 20);
}

// Each fabric of the schema is one of weft_cloth's, and the other way round.
TEST_F(SchemaTest, ListsTheFabrics) {
  const json document = json::parse(read_file(WEFT_SCENE_SCHEMA));
  std::set<std::string> named, known;
  for (const auto& name : document["definitions"]["fabric"]["enum"]) named.insert(name.get<std::string>());
  for (const Fabric& fabric : fabrics()) known.emplace(fabric.name);
  EXPECT_EQ(named, known);
}

}  // namespace
}  // namespace weft::scene::test
