// What of TOML 1.0 a file of options may hold, and where what is refused is said to be.
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

TEST(Toml, ReadsValuesAndArraysOfValues) {
  const std::vector<std::pair<std::string, Values>> texts{
      {"port = 8080", {"8080"}},
      {"  port=8080\r\n", {"8080"}},
      {"\n# port = 1\nport = 8_080  # port = 2\n", {"8080"}},
      {"\"port\" = true", {"true"}},
      {"port = 0x10", {"16"}},
      {"port = 1e-3", {"0.001"}},
      {"port = 2026-01-31", {"2026-01-31"}},
      {"port = \"\"", {""}},
      {R"(port = "/a#b = [c]" # d)", {"/a#b = [c]"}},
      {R"(port = '/a\b"#')", {"/a\\b\"#"}},
      {R"(port = "\"\\\t\u00e4\U0001F600")", {"\"\\\t\xc3\xa4\xf0\x9f\x98\x80"}},
      {"port = \"\"\"\na\nb\"\"\"", {"a\nb"}},
      {"port = \"\"\"\\\n\xc2\xa7\"\"\"", {"\xc2\xa7"}},
      {"port = []", {}},
      {"port = [ 'a,b', \"]\",\n  # c\n  3,\n]", {"a,b", "]", "3"}},
  };
  for (const auto& [text, values] : texts) {
    const std::vector<TomlEntry> entries = read_toml(text);
    ASSERT_EQ(entries.size(), 1u) << text;
    EXPECT_EQ(entries[0].name, "port") << text;
    EXPECT_EQ(entries[0].values, values) << text;
  }
  EXPECT_EQ(read_toml("a = 1\nb = 2\nc = 3").size(), 3u);
  EXPECT_TRUE(read_toml("# nothing\n\n").empty());
}

TEST(Toml, RefusesTheRestAndNamesLineAndColumn) {
  const std::vector<std::pair<std::string, std::string>> texts{
      {"a = 1\n[serve]\nport = 1", "line 2, column 1: serve must be a value or an array of values"},
      {"serve.port = 1", "line 1, column 1: serve must be a value or an array of values"},
      {"[[serve]]", "line 1, column 1: serve must be a value or an array of values"},
      {"port = [1, [2]]", "line 1, column 12: port must be a value or an array of values"},
      {"port", "line 1, column "},
      {"= 1", "line 1, column "},
      {"port =\n8080", "line 1, column "},
      {"port = json", "line 1, column "},
      {"port = \xc3\xa4", "line 1, column "},
      {"\xef\xb9\xbf", "line 1, column "},
      {"port = 1 2", "line 1, column "},
      {"port = \"a\nb\"", "line 1, column "},
      {"port = 'a", "line 1, column "},
      {"port = [1\n2]", "line 2, column "},
      {"port = [1,", "line 1, column "},
      {"port = 1\nport = 2", "line 2, column "},
      {"port = 99999999999999999999", "line 1, column "},
      {"port = \"\x01\"", "line 1, column "},
      {"port = \"\xff\"", "line 1, column "},
      {R"(port = "\q")", "line 1, column "},
      {R"(port = "\uD800")", "line 1, column "},
  };
  for (const auto& [text, message] : texts) {
    const std::string told = refusal(text);
    EXPECT_TRUE(told.starts_with(message)) << text << "\n" << told;
    EXPECT_EQ(told.find('\n'), std::string::npos) << told;
  }
}

TEST(Toml, AStringThatIsWrittenIsTheSameWhenRead) {
  std::string all;
  for (int byte = 0; byte < 128; ++byte) all += static_cast<char>(byte);
  for (const std::string& value : {std::string(), std::string("/title=\"#1\""), std::string("a\\"), all,
                                   all + "\xc3\xa4\xe2\x80\xa8\xf0\x9f\x98\x80" + all}) {
    const std::vector<TomlEntry> entries = read_toml("set = " + toml_string(value) + "  # --set");
    ASSERT_EQ(entries.size(), 1u);
    EXPECT_EQ(entries[0].values, Values{value});
    EXPECT_EQ(toml_string(value).find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace weft::cli
