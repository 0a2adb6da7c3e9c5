#pragma once
#include <filesystem>

namespace weft::host {

/// A folder of data that is this process' alone for as long as this is there.
class DataFolder {
 public:
  /// Made if it is not there. Throws std::runtime_error, with the folder and what is wrong, if it cannot be
  /// written to or another server has it.
  explicit DataFolder(const std::filesystem::path& folder);
  ~DataFolder();
  DataFolder(const DataFolder&) = delete;
  DataFolder& operator=(const DataFolder&) = delete;

 private:
  int lock_;  ///< a descriptor
};

}  // namespace weft::host
