#pragma once
/// A file that says so when it could not be written.
#include <fstream>
#include <string>
#include <string_view>

namespace weft::cli {

class OutputFile {
 public:
  /// Throws std::runtime_error, with the path and the reason, if it cannot be created.
  explicit OutputFile(std::string path);

  void write(std::string_view bytes);
  /// Replaces bytes already written, from `offset`.
  void patch(std::streamoff offset, std::string_view bytes);
  /// Flushes and closes; throws std::runtime_error if anything since the start failed (a full disk).
  void close();

 private:
  std::string path_;
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

}  // namespace weft::cli
