#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace weft::net {

/// The media type a file's name stands for; application/octet-stream where unknown.
std::string_view media_type(const std::filesystem::path& file);

/// The path below a site's root that a request's target names: without query, decoded, "index.html" for a
/// directory. Nothing for a target that could lead out of the root or to a hidden file.
std::optional<std::filesystem::path> path_of_target(std::string_view target);

/// The files of one directory, read on demand, kept in memory until they change on disk. Any thread may use
/// it.
class StaticFiles {
 public:
  struct File {
    std::shared_ptr<const std::string> content;
    std::string_view media_type;
    std::string etag;
  };

  explicit StaticFiles(std::filesystem::path root) : root_(std::move(root)) {}

  /// The file a request's target names, if there is one.
  std::optional<File> find(std::string_view target);

 private:
  struct Cached {
    std::filesystem::file_time_type changed;
    File file;
  };
  std::filesystem::path root_;
  std::mutex mutex_;  // of the cache
  std::map<std::filesystem::path, Cached> cache_;
};

}  // namespace weft::net
