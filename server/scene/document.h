#pragma once
/// JSON text -> a tree, with all that a tree alone would hide: duplicate keys, too large numbers, excessive
/// depth.
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace weft::scene {

inline constexpr std::size_t kMaxTextBytes = 32u << 20;  ///< 16 cloths of explicit nodes need less
inline constexpr std::size_t kMaxDepth = 16;

struct Document {
  nlohmann::json tree;            ///< not meaningful unless `readable`
  bool readable = false;          ///< false: `problems` says why the text is not JSON
  std::vector<Problem> problems;  ///< duplicate keys, or the one reason why the text cannot be read
  /// By JSON pointer, numbers too large for a double as they were written; the tree has null in their places.
  std::map<std::string, std::string> overflows;
};

/// Never throws. At most kMaxTextBytes and kMaxDepth levels are read.
Document read_document(std::string_view text);

/// The file's bytes, and not many beyond kMaxTextBytes of a larger one, which read_document() then refuses: a
/// device that never ends must not fill memory. Nothing, and errno says why, if it cannot be read.
std::optional<std::string> read_text_file(const std::string& path);

/// `token` as a part of a JSON pointer: "/" followed by the token, ~ and / escaped.
std::string pointer_token(std::string_view token);

}  // namespace weft::scene
