#pragma once
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

#include "cli/writers/output_file.h"

namespace weft::cli {

/// Bytes put aside beside a file until those before them are known. It has no name, so nothing is left of it
/// however the process ends.
class SpillFile {
 public:
  /// `path`: of the file that it is for; messages name that one. Throws as OutputFile.
  explicit SpillFile(const std::string& path);

  void write(std::string_view bytes);
  std::uint64_t size() const { return size_; }
  /// Appends all to the file; nothing is written from then on.
  void copy_to(OutputFile& file);

 private:
  std::string path_;
  std::fstream stream_;
  std::uint64_t size_ = 0;
};

}  // namespace weft::cli
