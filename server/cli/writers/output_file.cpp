#include "cli/writers/output_file.h"

#include <array>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <utility>

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

}  // namespace

OutputFile::OutputFile(std::string path) : path_(std::move(path)), stream_(path_, std::ios::binary) {
  if (!stream_) throw std::runtime_error(path_ + ": cannot be written: " + std::strerror(errno));
}

void OutputFile::write(std::string_view bytes) {
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void OutputFile::patch(std::streamoff offset, std::string_view bytes) {
  stream_.seekp(offset);
  write(bytes);
  stream_.seekp(0, std::ios::end);
}

void OutputFile::close() {
  stream_.close();
  if (!stream_) throw std::runtime_error(path_ + ": writing failed: " + std::strerror(errno));
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

}  // namespace weft::cli
