#pragma once
/// JSON read strictly, for text from strangers: nothing deep is built, nothing passes silently.
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace weft::protocol {

/// What was wrong with a text, and where.
struct JsonFault {
  std::string code;     ///< bad_json, or range for a number too large for a double
  std::string path;     ///< JSON pointer
  std::string message;  ///< says what and where
};

/// A read text: the tree, or the first fault.
struct StrictJson {
  nlohmann::json tree;
  std::optional<JsonFault> fault;
  std::optional<std::int64_t> id;  ///< a valid request id, if one was read before the fault
};

/// Reads `text`. A container nested deeper than `max_depth` (the outermost is 1 deep), a member given twice,
/// a number beyond double, and text that is not JSON or not UTF-8 are faults. Never throws on them.
StrictJson read_strictly(std::string_view text, int max_depth);

/// The request id that a member's value is, or nothing: an integer 1..2147483647.
std::optional<std::int64_t> request_id(const nlohmann::json& value);

/// `path`/`name`, escaped as RFC 6901 asks.
std::string pointer_to(const std::string& path, std::string_view name);

}  // namespace weft::protocol
