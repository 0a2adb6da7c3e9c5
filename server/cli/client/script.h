#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace weft::cli {

/// A message of the script, and when it is due after the start.
struct Timed {
  double at = 0;  ///< s
  nlohmann::json message;
};

/// The messages of a file that has one a line, in the order of their times. Throws std::runtime_error, with
/// the line, where one is none.
std::vector<Timed> read_script(const std::string& path);

}  // namespace weft::cli
