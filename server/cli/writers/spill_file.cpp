#include "cli/writers/spill_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace weft::cli {
namespace {

[[noreturn]] void spill_failed(const std::string& path, const char* what) {
  throw std::runtime_error(path + what + (errno != 0 ? std::strerror(errno) : "the reason is not known"));
}

}  // namespace

SpillFile::SpillFile(const std::string& path) : path_(path) {
  // A name that no file has: nothing that is there is lost.
  std::string name = path + ".spill-XXXXXX";
  errno = 0;
  const int made = mkstemp(name.data());
  if (made < 0) spill_failed(path, ": cannot be written: ");
  stream_.open(name, std::ios::binary | std::ios::in | std::ios::out);
  const bool opened = stream_.is_open();
  const int why = errno;
  close(made);
  unlink(name.c_str());
  errno = why;
  if (!opened) spill_failed(path, ": cannot be written: ");
}

void SpillFile::write(std::string_view bytes) {
  errno = 0;
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream_) spill_failed(path_, ": writing failed: ");
  size_ += bytes.size();
}

void SpillFile::copy_to(OutputFile& file) {
  errno = 0;
  stream_.flush();
  stream_.seekg(0);
  if (!stream_) spill_failed(path_, ": writing failed: ");
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  std::vector<char> block(kBlock);
  for (std::uint64_t left = size_; left > 0;) {
    stream_.read(block.data(), static_cast<std::streamsize>(std::min<std::uint64_t>(left, kBlock)));
    const auto got = static_cast<std::size_t>(stream_.gcount());
    if (got == 0) spill_failed(path_, ": reading back what was put aside failed: ");
    file.write({block.data(), got});
    left -= got;
  }
}

}  // namespace weft::cli
