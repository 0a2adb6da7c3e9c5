#include "scene/nearest_name.h"

#include <algorithm>
#include <cctype>

namespace weft::scene {
namespace {

/// A longer one is no name that was mistyped, and the time grows with its length.
constexpr std::size_t kLongestName = 64;
/// Of what one name has of the other.
constexpr std::size_t kShortestPart = 4;

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::size_t distance(const std::string& a, const std::string& b) {
  // Rows of the table: of a's first i - 2, i - 1 and i characters to all beginnings of b.
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = std::move(last);
    last = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = a[i - 1] == b[j - 1];
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::string_view nearest_name(std::string_view given, const std::vector<std::string_view>& names) {
  if (given.size() > kLongestName || std::find(names.begin(), names.end(), given) != names.end()) return {};
  const std::string meant = lower(given);
  std::string_view nearest, part;
  std::size_t fewest = std::max<std::size_t>(1, given.size() / 3) + 1;
  int parts = 0;
  for (const std::string_view name : names) {
    const std::string known = lower(name);
    const std::size_t edits = distance(meant, known);
    if (edits < fewest) {
      fewest = edits;
      nearest = name;
    }
    const auto& [shorter, longer] = std::minmax(
        meant, known, [](const std::string& a, const std::string& b) { return a.size() < b.size(); });
    if (shorter.size() >= kShortestPart && longer.find(shorter) != std::string::npos) {
      part = name;
      ++parts;
    }
  }
  if (nearest.empty() && parts == 1) return part;
  return nearest;
}

std::string did_you_mean(std::string_view given, const std::vector<std::string_view>& names) {
  const std::string_view name = nearest_name(given, names);
  if (name.empty()) return {};
  return std::string("; did you mean \"").append(name).append("\"?");
}

}  // namespace weft::scene
