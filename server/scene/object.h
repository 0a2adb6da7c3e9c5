#pragma once
/// Reading a JSON object field by field: the pointer is known, problems are collected, unknown keys are
/// found.
#include <Eigen/Core>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace weft::scene {

/// Allowed values of a number, both ends included.
struct Range {
  double min = 0, max = 0;
  const char* unit = "";
  std::string text() const;  ///< "from 0.0001 to 10000 kg/m2"
};

/// Collects what is wrong with a document while it is read.
class Report {
 public:
  /// `overflows`: see Document.
  Report(std::vector<Problem> found, std::map<std::string, std::string> overflows)
      : problems_(std::move(found)), overflows_(std::move(overflows)) {}

  void add(std::string path, std::string message);
  /// "is VALUE; must be EXPECTED".
  void refuse(const nlohmann::json& value, const std::string& path, const std::string& expected);
  /// The same of what must be one of the names, and which of them was probably meant.
  void refuse_name(const nlohmann::json& value, const std::string& path, const std::string& expected,
                   const std::vector<std::string_view>& names);
  /// What is told of a scene that has no problems.
  void note(std::string text) { notes_.push_back(std::move(text)); }
  std::size_t count() const { return problems_.size(); }
  std::vector<Problem> take() { return std::move(problems_); }
  std::vector<std::string> take_notes() { return std::move(notes_); }

 private:
  std::vector<Problem> problems_;
  std::vector<std::string> notes_;
  std::map<std::string, std::string> overflows_;
};

/// The names as a message lists them: "a", "b", "c".
std::string quoted_list(const std::vector<std::string_view>& names);

/// The pointer of an array's element.
std::string element_path(const std::string& array, std::size_t index);

/// The number at `path`, or nothing and a problem.
std::optional<double> read_number(const nlohmann::json& value, const std::string& path, const Range& range,
                                  Report& report);
/// Takes the string at `path` into `target` if it has at most `max_length` characters.
bool read_string(const nlohmann::json& value, const std::string& path, std::size_t max_length,
                 std::string& target, Report& report);
/// Fills `target` from an array of `count` numbers; false, with all problems reported, if it is not one.
bool read_numbers(const nlohmann::json& value, const std::string& path, const Range& range, double* target,
                  std::size_t count, Report& report);

/// One JSON object. Each reader takes a field if it is there and leaves the target as it was (the default) if
/// not or if the value is wrong, which is reported. When the cursor goes, the keys nobody asked for are
/// reported.
class Object {
 public:
  /// A `value` that is not an object is reported, and read as an empty one.
  Object(const nlohmann::json& value, std::string path, Report& report);
  ~Object();
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;

  /// The field's value or nullptr; the key counts as known from now on.
  const nlohmann::json* find(const char* key);
  bool has(const char* key) { return find(key) != nullptr; }
  /// Reports the key if it is missing. `expected` says what belongs there.
  bool require(const char* key, const std::string& expected);
  bool require(const char* key, const Range& range) { return require(key, "a number " + range.text()); }
  std::string path(std::string_view key) const;
  void problem(const char* key, std::string message) { report_.add(path(key), std::move(message)); }
  Report& report() { return report_; }

  // True if the field was there and right.
  bool number(const char* key, double& target, const Range& range);
  bool integer(const char* key, int& target, const Range& range);
  bool integer(const char* key, std::uint64_t& target, const Range& range);
  bool boolean(const char* key, bool& target);
  bool string(const char* key, std::string& target, std::size_t max_length);
  /// An array of `count` numbers.
  bool numbers(const char* key, double* target, std::size_t count, const Range& range);
  template <int count>
  bool vector(const char* key, Eigen::Matrix<double, count, 1>& target, const Range& range) {
    return numbers(key, target.data(), count, range);
  }
  /// A vector whose length does not matter but must not be zero; `target` is normalised.
  template <int count>
  bool direction(const char* key, Eigen::Matrix<double, count, 1>& target, const Range& range) {
    Eigen::Matrix<double, count, 1> read;
    if (!vector(key, read, range)) return false;
    constexpr double kShortest = 1e-6;
    if (read.norm() < kShortest) {
      problem(key, "has length 0; must not be zero");
      return false;
    }
    target = read.normalized();
    return true;
  }
  /// Index of the field's string among `names`, or -1.
  int choice(const char* key, const std::vector<const char*>& names);
  /// Calls read(value, path) for each element of an array of `min` to `max` elements.
  template <class Read>
  void each(const char* key, std::size_t min, std::size_t max, Read read) {
    const nlohmann::json* array = find_array(key, min, max);
    if (!array) return;
    for (std::size_t i = 0; i < array->size(); ++i) read((*array)[i], element_path(path(key), i));
  }
  /// Unknown keys are not reported: after a `type` that decides which ones there are turned out wrong.
  void ignore_rest() { ignore_rest_ = true; }

 private:
  const nlohmann::json* find_array(const char* key, std::size_t min, std::size_t max);

  const nlohmann::json* value_;  ///< nullptr if it is not an object
  std::string path_;
  Report& report_;
  std::vector<std::string> known_;
  bool ignore_rest_ = false;
};

}  // namespace weft::scene
