#include "net/static_files.h"

#include <array>
#include <charconv>
#include <fstream>
#include <iterator>
#include <utility>

namespace weft::net {
namespace fs = std::filesystem;
namespace {

/// "%2e" -> "."; nothing if a % is not followed by two hexadecimal digits.
std::optional<std::string> percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i];
      continue;
    }
    unsigned value = 0;
    const std::string_view digits = text.substr(i + 1, 2);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (error != std::errc{} || digits.size() != 2 || end != digits.data() + 2) return std::nullopt;
    decoded += static_cast<char>(value);
    i += 2;
  }
  return decoded;
}

}  // namespace

std::string_view media_type(const fs::path& file) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kTypes{{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".map", "application/json"},
      {".wasm", "application/wasm"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
      {".ico", "image/vnd.microsoft.icon"},
      {".woff2", "font/woff2"},
      {".txt", "text/plain; charset=utf-8"},
      {".md", "text/plain; charset=utf-8"},
  }};
  const std::string extension = file.extension().string();
  for (const auto& [known, type] : kTypes) {
    if (known == extension) return type;
  }
  return "application/octet-stream";
}

std::optional<fs::path> path_of_target(std::string_view target) {
  target = target.substr(0, target.find_first_of("?#"));
  const auto decoded = percent_decoded(target);
  if (!decoded || !decoded->starts_with('/')) return std::nullopt;
  if (decoded->find_first_of(std::string_view("\\\0", 2)) != std::string::npos) return std::nullopt;
  fs::path path;
  std::size_t begin = 1;
  while (begin <= decoded->size()) {
    const std::size_t end = std::min(decoded->find('/', begin), decoded->size());
    const std::string part = decoded->substr(begin, end - begin);
    // Also ".." and ".": no name of the site begins with a dot.
    if (part.starts_with('.')) return std::nullopt;
    if (part.empty() && end != decoded->size()) return std::nullopt;
    path /= part.empty() ? "index.html" : part;
    begin = end + 1;
  }
  return path;
}

std::optional<StaticFiles::File> StaticFiles::find(std::string_view target) {
  const auto relative = path_of_target(target);
  if (!relative || root_.empty()) return std::nullopt;
  const fs::path path = root_ / *relative;
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  const auto changed = fs::last_write_time(path, error);
  if (error) return std::nullopt;
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = cache_.find(path); known != cache_.end() && known->second.changed == changed)
      return known->second.file;
  }
  std::ifstream stream(path, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) return std::nullopt;
  File file;
  file.etag =
      '"' + std::to_string(changed.time_since_epoch().count()) + '-' + std::to_string(content.size()) + '"';
  file.media_type = media_type(path);
  file.content = std::make_shared<const std::string>(std::move(content));
  const std::lock_guard lock(mutex_);
  cache_[path] = {changed, file};
  return file;
}

}  // namespace weft::net
