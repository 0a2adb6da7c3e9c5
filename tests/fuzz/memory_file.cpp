#include "memory_file.h"

#include <sys/mman.h>
#include <unistd.h>

namespace weft::fuzz {

MemoryFile::MemoryFile(Input content) : descriptor_(memfd_create("input", MFD_CLOEXEC)) {
  require(descriptor_ >= 0, "a file in memory can be made");
  const auto written = ::write(descriptor_, content.data(), content.size());
  require(written == static_cast<ssize_t>(content.size()), "a file in memory takes it all");
}

MemoryFile::~MemoryFile() { ::close(descriptor_); }

}  // namespace weft::fuzz
