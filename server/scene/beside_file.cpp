#include "scene/beside_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace weft::scene {
namespace {

namespace fs = std::filesystem;

/// The file's place, which no scene can make one outside its own folder.
fs::path place_of(const fs::path& folder, const std::string& file, std::size_t max_bytes) {
  const auto refuse = [](const std::string& what) { throw std::invalid_argument(what); };
  const fs::path relative(file);
  const bool upwards = std::find(relative.begin(), relative.end(), fs::path("..")) != relative.end();
  if (file.empty() || relative.is_absolute() || upwards) {
    refuse("must be a path within the scene file's folder, without \"..\"");
  }
  std::error_code error;
  const fs::path home = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
  fs::path place = fs::canonical(home / relative, error);
  if (error) refuse("cannot be read: " + error.message());
  if (std::mismatch(home.begin(), home.end(), place.begin(), place.end()).first != home.end()) {
    refuse("is a link out of the scene file's folder");
  }
  if (!fs::is_regular_file(place, error)) refuse("is not a file");
  if (fs::file_size(place, error) > max_bytes) {
    refuse("has " + std::to_string(fs::file_size(place, error)) + " bytes; at most " +
           std::to_string(max_bytes) + " are allowed");
  }
  return place;
}

}  // namespace

std::string read_beside(const fs::path& folder, const std::string& file, std::size_t max_bytes) {
  std::ifstream opened(place_of(folder, file, max_bytes), std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(opened), {}};
  if (!opened) throw std::invalid_argument(std::string("cannot be read: ") + std::strerror(errno));
  return bytes;
}

}  // namespace weft::scene
