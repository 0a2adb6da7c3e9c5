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

/// What a file in TOML 1.0 says, in the order of the names; numbers and dates as toml++ writes them. An entry
/// is a value or an array of values: throws std::invalid_argument, naming line and column, for tables, arrays
/// in arrays, and what is not TOML.
std::vector<TomlEntry> read_toml(std::string_view text);

/// A string in TOML that read_toml reads as `value`, which must be UTF-8.
std::string toml_string(std::string_view value);

}  // namespace weft::cli
