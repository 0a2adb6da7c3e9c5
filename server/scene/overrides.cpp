#include "scene/overrides.h"

#include <charconv>
#include <string>
#include <utility>
#include <vector>

#include "scene/document.h"

namespace weft::scene {
namespace {

using nlohmann::json;

/// The parts of a JSON pointer, unescaped; nothing if it is not one.
std::optional<std::vector<std::string>> parts_of(std::string_view pointer) {
  if (pointer.empty() || pointer.front() != '/') return std::nullopt;
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    const char c = pointer[i];
    if (c == '/') {
      parts.emplace_back();
    } else if (c == '~') {
      const char code = i + 1 < pointer.size() ? pointer[++i] : '?';
      if (code != '0' && code != '1') return std::nullopt;
      parts.back() += code == '0' ? '~' : '/';
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// `value` as JSON, or else as a string. Scene files' limit on depth holds for it too.
json value_of(std::string_view value) {
  Document document = read_document(value);
  if (!document.readable || !document.overflows.empty()) return std::string(value);
  return std::move(document.tree);
}

/// An index into `array`, or its size to append; nothing if `part` is no such index.
std::optional<std::size_t> index_of(const json& array, const std::string& part, bool may_append) {
  if (may_append && part == "-") return array.size();
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error != std::errc() || end != part.data() + part.size() ||
      index >= array.size() + (may_append ? 1 : 0)) {
    return std::nullopt;
  }
  return index;
}

}  // namespace

std::optional<Problem> apply_override(std::string_view text, json& document) {
  const std::size_t equals = text.find('=');
  const auto parts = equals == std::string_view::npos ? std::nullopt : parts_of(text.substr(0, equals));
  if (!parts) return Problem{"", "cannot set " + std::string(text) + ": must be /json/pointer=value"};
  json value = value_of(text.substr(equals + 1));
  json* at = &document;
  std::string path;
  for (std::size_t i = 0; i < parts->size(); ++i) {
    const std::string& part = (*parts)[i];
    const bool last = i + 1 == parts->size();
    path += pointer_token(part);
    if (at->is_array()) {
      const auto index = index_of(*at, part, last && !value.is_null());
      if (!index)
        return Problem{path, "cannot be set; the array has " + std::to_string(at->size()) + " elements"};
      if (last && value.is_null()) {
        at->erase(*index);
        return std::nullopt;
      }
      if (*index == at->size()) at->push_back(nullptr);
      at = &(*at)[*index];
    } else if (at->is_object()) {
      if (last && value.is_null()) {
        at->erase(part);
        return std::nullopt;
      }
      if (!last && !at->contains(part)) (*at)[part] = json::object();
      at = &(*at)[part];
    } else {
      return Problem{path, "cannot be set; what it is to be put into is neither an object nor an array"};
    }
  }
  *at = std::move(value);
  return std::nullopt;
}

}  // namespace weft::scene
