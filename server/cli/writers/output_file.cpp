#include "cli/writers/output_file.h"

#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <system_error>

namespace weft::cli {
namespace {

template <class Number>
void append_shortest(std::string& text, Number value) {
  std::array<char, 32> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), result.ptr);
}

void append_word(std::string& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8)
    bytes += static_cast<char>(static_cast<unsigned char>(word >> shift));
}

void append_word_big(std::string& bytes, std::uint32_t word) {
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes += static_cast<char>(static_cast<unsigned char>(word >> shift));
}

template <class Word>
void append_all(std::string& bytes, std::span<const Word> values) {
  if constexpr (std::endian::native == std::endian::little) {
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  } else {
    for (const Word value : values) append_word(bytes, std::bit_cast<std::uint32_t>(value));
  }
}

[[noreturn]] void refuse(const std::filesystem::path& path) {
  throw std::runtime_error(path.string() + ": cannot be written: " + std::strerror(errno));
}

}  // namespace

OutputFile::OutputFile(const std::string& path) : path_(path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_type present = fs::symlink_status(path_, error).type();
  if (present == fs::file_type::not_found || present == fs::file_type::regular) {
    part_ = path + ".part";
    // Putting one file in another's place asks for no right to write that one.
    if (present == fs::file_type::regular && access(path_.c_str(), W_OK) != 0) refuse(path_);
  }
  stream_.open(part_.empty() ? path_ : part_, std::ios::binary);
  if (!stream_) refuse(path_);
}

OutputFile::~OutputFile() {
  if (!stream_.is_open()) return;
  stream_.close();
  discard();
}

void OutputFile::write(std::string_view bytes) {
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream_) fail();
}

void OutputFile::patch(std::streamoff offset, std::string_view bytes) {
  stream_.seekp(offset);
  write(bytes);
  stream_.seekp(0, std::ios::end);
}

void OutputFile::close() {
  stream_.close();
  const bool good = stream_ && (part_.empty() || std::rename(part_.c_str(), path_.c_str()) == 0);
  if (good) return;
  const int reason = errno;
  discard();
  errno = reason;
  fail();
}

void OutputFile::discard() const {
  std::error_code ignored;
  if (!part_.empty()) std::filesystem::remove(part_, ignored);
}

void OutputFile::fail() const {
  const std::string reason = errno != 0 ? std::strerror(errno) : "the reason is not known";
  throw std::runtime_error(path_.string() + ": writing failed: " + reason);
}

void append_number(std::string& text, float value) { append_shortest(text, value); }
void append_number(std::string& text, double value) { append_shortest(text, value); }
void append_number(std::string& text, int value) { append_shortest(text, value); }
void append_coordinate(std::string& text, double value) {
  const auto single = static_cast<float>(value);
  if (double(single) == value) {
    append_shortest(text, single);
  } else {
    append_shortest(text, value);
  }
}

void append_bytes(std::string& bytes, float value) {
  append_word(bytes, std::bit_cast<std::uint32_t>(value));
}
void append_bytes(std::string& bytes, int value) { append_word(bytes, static_cast<std::uint32_t>(value)); }
void append_bytes(std::string& bytes, std::uint32_t value) { append_word(bytes, value); }
void append_bytes(std::string& bytes, std::span<const float> values) { append_all(bytes, values); }
void append_bytes(std::string& bytes, std::span<const std::uint32_t> values) { append_all(bytes, values); }
void append_bytes_big(std::string& bytes, float value) {
  append_word_big(bytes, std::bit_cast<std::uint32_t>(value));
}
void append_bytes_big(std::string& bytes, int value) {
  append_word_big(bytes, static_cast<std::uint32_t>(value));
}

}  // namespace weft::cli
