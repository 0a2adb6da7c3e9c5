#include "cli/writers/spill_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace weft::cli {
namespace {

[[noreturn]] void spill_failed(const std::string& path, const char* what) {
  throw std::runtime_error(path + what + (errno != 0 ? std::strerror(errno) : "the reason is not known"));
}

}  // namespace

SpillFile::SpillFile(const std::string& path) : path_(path) {
  // Several may be for one file: each has lost its name before the next one gets it.
  const std::string name = path + ".spill";
  errno = 0;
  stream_.open(name, std::ios::binary | std::ios::in | std::ios::out | std::ios::trunc);
  if (!stream_) spill_failed(path, ": cannot be written: ");
  std::filesystem::remove(name);
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
