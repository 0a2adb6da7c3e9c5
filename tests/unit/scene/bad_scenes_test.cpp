// Every file in bad/ must give exactly the problems listed in the .txt beside it: path, value, allowed range,
// in order.
#include <cctype>
#include <cstdio>

#include "fixtures.h"

namespace weft::scene::test {
namespace {

class BadScene : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(BadScene, GivesExactlyTheListedProblems) {
  auto expected = GetParam();
  expected.replace_extension(".txt");
  EXPECT_EQ(problems_of(parse(read_file(GetParam()), "bad")), read_file(expected));
}

INSTANTIATE_TEST_SUITE_P(Files, BadScene, testing::ValuesIn(scene_files("bad")),
                         [](const auto& each) { return each.param.stem().string(); });

TEST(BadScenes, TextBeyondTheLimitIsRefusedUnread) {
  const std::string text((32u << 20) + 1, ' ');
  EXPECT_EQ(problems_of(parse(text, "large")), "the text has 33554433 bytes; at most 33554432 are allowed\n");
}

// A scene file may be sent by anyone: nesting must not exhaust the stack, nor a long list of mistakes the
// memory.
TEST(BadScenes, DeepNestingIsRefusedAtTheLimit) {
  std::string path;
  for (int level = 0; level < 16; ++level) path += "/0";
  EXPECT_EQ(problems_of(parse(std::string(10'000'000, '['), "deep")),
            path + ": nested deeper than 16 levels\n");
}

TEST(BadScenes, ProblemsAreListedUpToAThousand) {
  std::string notes;
  for (int i = 0; i < 64; ++i) notes += (i ? ",1" : "1");
  std::string cloths;
  for (int i = 0; i < 16; ++i) {
    std::string pins;
    for (int pin = 0; pin < 256; ++pin) pins += (pin ? ",1" : "1");
    cloths += (i ? ",{\"pins\":[" : "{\"pins\":[") + pins + "]}";
  }
  const Result result = parse("{\"notes\":[" + notes + "],\"cloths\":[" + cloths + "]}", "many");
  const auto& problems = std::get<std::vector<Problem>>(result);
  ASSERT_EQ(problems.size(), 1001u);
  EXPECT_EQ(problems[63].path, "/notes/63");
  EXPECT_EQ(problems.back().text(), "more problems are not listed");
}

TEST(BadScenes, ManyNumbersThatAreNotFiniteStopTheReading) {
  std::string notes;
  for (int i = 0; i < 30; ++i) notes += (i ? ",1e999" : "1e999");
  EXPECT_EQ(problems_of(parse("{\"notes\":[" + notes + "]}", "many")),
            "/notes/20: is 1e999, one of too many numbers that are not finite\n");
}

// from_json takes documents that no text could give.
TEST(BadScenes, ADocumentWithInfinityIsRefused) {
  nlohmann::json document = {{"cloths", {{{"perturbation", std::numeric_limits<double>::infinity()}}}}};
  EXPECT_EQ(problems_of(from_json(document, "inf")),
            "/cloths/0/perturbation: is not finite; must be a number from 0 to 100 m\n");
}

TEST(BadScenes, OnlyASceneThatIsAFileNamesFiles) {
  const std::string text =
      R"({"cloths": [{}], "colliders": [{"type": "mesh", "position": [0, 0, 0], "file": "box.obj"}]})";
  EXPECT_EQ(problems_of(parse(text, "sent")),
            "/colliders/0/file: is \"box.obj\", which is given by a scene that is not a file itself\n");
}

TEST(BadScenes, MissingFilesNameThePresets) {
  EXPECT_EQ(problems_of(load("no-such-scene")),
            "no-such-scene: No such file or directory (neither a file nor a preset; the presets are flag, "
            "flag-gusts, curtain, fan, tablecloth, silk, round-table, cape, walker, sail, trampoline, "
            "washing-line, "
            "towel, hide, cushion, pillow, paper-screen, swing, zheng2020-wind, zheng2020-distance, "
            "zheng2020-ball)\n");
}

}  // namespace
}  // namespace weft::scene::test
