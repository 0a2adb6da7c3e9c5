#pragma once
/// A file that is whole or not there, and says so when it could not be written.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>

namespace weft::cli {

/// Written beside its place, as PATH.part, and put there by close(): what is at `path` is never a part of a
/// file, and what was there stays until then. A link, a pipe or a device is written itself.
class OutputFile {
 public:
  /// Throws std::runtime_error, with the path and the reason, if it cannot be created.
  explicit OutputFile(const std::string& path);
  OutputFile(OutputFile&&) = default;
  OutputFile& operator=(OutputFile&&) = delete;
  /// Without close() nothing is left.
  ~OutputFile();

  /// Throws std::runtime_error if it, or anything before, failed (a full disk).
  void write(std::string_view bytes);
  /// Replaces bytes already written, from `offset`; throws as write().
  void patch(std::streamoff offset, std::string_view bytes);
  /// Flushes, closes and puts the file in its place; throws std::runtime_error if anything since the start
  /// failed.
  void close();

 private:
  [[noreturn]] void fail() const;
  void discard() const;

  std::filesystem::path path_;
  std::filesystem::path part_;  ///< empty: `path_` itself is written
  std::ofstream stream_;
};

/// Appends a number in the shortest form that reads back to the same value, in any locale.
void append_number(std::string& text, float value);
void append_number(std::string& text, double value);
void append_number(std::string& text, int value);
/// The same; what a float holds is written as one.
void append_coordinate(std::string& text, double value);

/// Appends a value's bytes, little endian.
void append_bytes(std::string& bytes, float value);
void append_bytes(std::string& bytes, int value);
void append_bytes(std::string& bytes, std::uint32_t value);
void append_bytes(std::string& bytes, std::span<const float> values);
void append_bytes(std::string& bytes, std::span<const std::uint32_t> values);
/// The same, big endian.
void append_bytes_big(std::string& bytes, float value);
void append_bytes_big(std::string& bytes, int value);

}  // namespace weft::cli
