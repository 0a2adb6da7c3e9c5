#pragma once
#include <string>

#include "targets.h"

namespace weft::fuzz {

/// A file with this content for as long as it lives, on no disk: for code that reads files by their path.
class MemoryFile {
 public:
  explicit MemoryFile(Input content);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

}  // namespace weft::fuzz
