// What a file of options may hold (TOML 1.0, sections Comment, String, Integer and Array), and what is said
// of anything else.
#include "cli/toml.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <utility>

namespace weft::cli {
namespace {

using Values = std::vector<std::string>;

std::string refusal(const std::string& text) {
  try {
    read_toml(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Toml, ReadsWhatStandsInALine) {
  const std::vector<std::pair<std::string, Values>> texts{
      {"port = 8080", {"8080"}},
      {"  port=8080\r\n", {"8080"}},
      {"\n# port = 1\nport = 8080  # port = 2\n", {"8080"}},
      {"\"port\" = true", {"true"}},
      {"port = json", {"json"}},
      {"port = \"\"", {""}},
      {R"(port = "/a#b = [c]" # d)", {"/a#b = [c]"}},
      {R"(port = '/a\b"#')", {"/a\\b\"#"}},
      {R"(port = "\"\\\t\u00e4\U0001F600")", {"\"\\\t\xc3\xa4\xf0\x9f\x98\x80"}},
      {"port = []", {}},
      {"port = [ 'a,b', \"]\",\n  # c\n  3,\n]", {"a,b", "]", "3"}},
  };
  for (const auto& [text, values] : texts) {
    const std::vector<TomlEntry> entries = read_toml(text);
    ASSERT_EQ(entries.size(), 1u) << text;
    EXPECT_EQ(entries[0].name, "port") << text;
    EXPECT_EQ(entries[0].values, values) << text;
  }
  EXPECT_EQ(read_toml("a = 1\nb = 2\na = 3").size(), 3u);
  EXPECT_TRUE(read_toml("# nothing\n\n").empty());
}

TEST(Toml, RefusesTheRestAndNamesTheLine) {
  const std::vector<std::pair<std::string, std::string>> texts{
      {"a = 1\n[serve]\nport = 1", "line 2: [serve] is unknown; allowed: options, without tables"},
      {"port", "line 1: port must be followed by = and a value"},
      {"= 1", "line 1: a name is missing"},
      {"port =\n8080", "line 1: a value is missing"},
      {"port = 1 2", "line 1: after the value of port only a comment is allowed"},
      {"port = \"a\"\"b\"", "line 1: after the value of port only a comment is allowed"},
      {"port = \"a\nb\"", "line 1: a string must end in the line in which it begins"},
      {"port = 'a", "line 1: a string must end in the line in which it begins"},
      {"port = [1\n2]", "line 2: values of an array must be separated by commas"},
      {"port = [1,\n", "line 2: a value or ] is missing"},
      {"port = \"\x01\"", "line 1: control characters are allowed as escapes alone"},
      {R"(port = "\q")", R"(line 1: \q is unknown; allowed: \b \t \n \f \r \" \\ \uXXXX \UXXXXXXXX)"},
  };
  for (const auto& [text, message] : texts) EXPECT_EQ(refusal(text), message) << text;
  for (const char* digits : {"u12", "u12g4", "uD800", "U00110000", "u-123"}) {
    EXPECT_EQ(refusal("port = \"\\" + std::string(digits) + "\""),
              "line 1: \\u and \\U must be followed by 4 and 8 hexadecimal digits of a character");
  }
}

TEST(Toml, AStringThatIsWrittenIsTheSameWhenRead) {
  std::string all;
  for (int byte = 0; byte < 256; ++byte) all += static_cast<char>(byte);
  for (const std::string& value : {std::string(), std::string("/title=\"#1\""), std::string("a\\"), all}) {
    const std::vector<TomlEntry> entries = read_toml("set = " + toml_string(value) + "  # --set");
    ASSERT_EQ(entries.size(), 1u);
    EXPECT_EQ(entries[0].values, Values{value});
  }
}

}  // namespace
}  // namespace weft::cli
