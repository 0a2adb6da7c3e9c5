#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace weft::cli {

/// A line `name = value` or `name = [value, value]`.
struct TomlEntry {
  std::string name;
  std::vector<std::string> values;
};

/// The part of TOML 1.0 that a list of options needs: comments; strings in one line, with quotes and escapes
/// resolved; numbers and `true` and `false`, as they stand; arrays of these, over as many lines as one likes.
/// Other words without quotes are taken as they stand, too. Tables, and all else, are refused: throws
/// std::invalid_argument, naming the line and what is allowed in it.
std::vector<TomlEntry> read_toml(std::string_view text);

/// A string that read_toml reads as `value`, whatever bytes that has.
std::string toml_string(std::string_view value);

}  // namespace weft::cli
