#include "scene/object.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "scene/document.h"
#include "scene/nearest_name.h"

namespace weft::scene {
namespace {

using nlohmann::json;

/// Problems that one file may have: beyond it the list would help nobody, and nodes can be many.
constexpr std::size_t kMaxProblems = 1000;

/// `value` for a message: short whatever it is.
std::string shown(const json& value) {
  constexpr std::size_t kLongest = 60;
  if (value.is_array()) return "an array of " + std::to_string(value.size());
  if (value.is_object()) return "an object";
  if (value.is_number_float() && !std::isfinite(value.get<double>())) return "not finite";
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

std::string list(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Characters, not bytes: what JSON Schema's maxLength counts.
std::size_t length(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

std::string Range::text() const {
  char text[96];
  std::snprintf(text, sizeof text, "from %.16g to %.16g%s%s", min, max, *unit ? " " : "", unit);
  return text;
}

void Report::add(std::string path, std::string message) {
  if (problems_.size() == kMaxProblems) problems_.push_back({"", "more problems are not listed"});
  if (problems_.size() < kMaxProblems) problems_.push_back({std::move(path), std::move(message)});
}

void Report::refuse(const json& value, const std::string& path, const std::string& expected) {
  const auto overflow = overflows_.find(path);
  const bool overflowed = overflow != overflows_.end() && value.is_null();
  add(path, "is " + (overflowed ? overflow->second : shown(value)) + "; must be " + expected);
}

void Report::refuse_name(const json& value, const std::string& path, const std::string& expected,
                         const std::vector<std::string_view>& names) {
  const auto* given = value.get_ptr<const json::string_t*>();
  refuse(value, path, expected + (given != nullptr ? did_you_mean(*given, names) : ""));
}

std::string quoted_list(const std::vector<std::string_view>& names) {
  std::string text;
  for (const std::string_view name : names) {
    if (!text.empty()) text += ", ";
    text.append("\"").append(name).append("\"");
  }
  return text;
}

std::string element_path(const std::string& array, std::size_t index) {
  return array + pointer_token(std::to_string(index));
}

std::optional<double> read_number(const json& value, const std::string& path, const Range& range,
                                  Report& report) {
  if (value.is_number()) {
    const auto number = value.get<double>();
    if (number >= range.min && number <= range.max) return number;
  }
  report.refuse(value, path, "a number " + range.text());
  return std::nullopt;
}

bool read_string(const json& value, const std::string& path, std::size_t max_length, std::string& target,
                 Report& report) {
  if (value.is_string() && length(value.get_ref<const std::string&>()) <= max_length) {
    target = value.get<std::string>();
    return true;
  }
  report.refuse(value, path, "a string of at most " + std::to_string(max_length) + " characters");
  return false;
}

bool read_numbers(const json& value, const std::string& path, const Range& range, double* target,
                  std::size_t count, Report& report) {
  if (!value.is_array() || value.size() != count) {
    report.refuse(value, path, "an array of " + std::to_string(count) + " numbers, each " + range.text());
    return false;
  }
  bool good = true;
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = read_number(value[i], element_path(path, i), range, report);
    good = good && number;
    if (good) target[i] = *number;
  }
  return good;
}

Object::Object(const json& value, std::string path, Report& report)
    : value_(value.is_object() ? &value : nullptr), path_(std::move(path)), report_(report) {
  if (!value_) report_.refuse(value, path_, "an object");
}

Object::~Object() {
  if (!value_ || ignore_rest_) return;
  for (const auto& item : value_->items()) {
    if (std::find(known_.begin(), known_.end(), item.key()) == known_.end()) {
      report_.add(path(item.key()), "unknown key; known here: " + list(known_) +
                                        did_you_mean(item.key(), {known_.begin(), known_.end()}));
    }
  }
}

const json* Object::find(const char* key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  if (!value_) return nullptr;
  const auto found = value_->find(key);
  return found == value_->end() ? nullptr : &*found;
}

bool Object::require(const char* key, const std::string& expected) {
  if (find(key)) return true;
  if (value_) problem(key, "is missing; must be " + expected);
  return false;
}

std::string Object::path(std::string_view key) const { return path_ + pointer_token(key); }

bool Object::number(const char* key, double& target, const Range& range) {
  const json* value = find(key);
  if (!value) return false;
  const auto number = read_number(*value, path(key), range, report_);
  if (number) target = *number;
  return number.has_value();
}

bool Object::integer(const char* key, std::uint64_t& target, const Range& range) {
  const json* value = find(key);
  if (!value) return false;
  if (value->is_number_unsigned() || (value->is_number_integer() && value->get<std::int64_t>() >= 0)) {
    const auto number = value->get<std::uint64_t>();
    // No bound is above 2^53, up to which doubles hold each integer.
    if (static_cast<double>(number) >= range.min && static_cast<double>(number) <= range.max) {
      target = number;
      return true;
    }
  }
  report_.refuse(*value, path(key), "an integer " + range.text());
  return false;
}

bool Object::integer(const char* key, int& target, const Range& range) {
  std::uint64_t number = 0;
  if (!integer(key, number, range)) return false;
  target = static_cast<int>(number);
  return true;
}

bool Object::boolean(const char* key, bool& target) {
  const json* value = find(key);
  if (!value) return false;
  if (!value->is_boolean()) {
    report_.refuse(*value, path(key), "true or false");
    return false;
  }
  target = value->get<bool>();
  return true;
}

bool Object::string(const char* key, std::string& target, std::size_t max_length) {
  const json* value = find(key);
  return value && read_string(*value, path(key), max_length, target, report_);
}

int Object::choice(const char* key, const std::vector<const char*>& names) {
  const json* value = find(key);
  if (!value) return -1;
  if (value->is_string()) {
    const auto found = std::find(names.begin(), names.end(), value->get_ref<const std::string&>());
    if (found != names.end()) return static_cast<int>(found - names.begin());
  }
  const std::vector<std::string_view> known(names.begin(), names.end());
  report_.refuse_name(*value, path(key), (known.size() > 1 ? "one of " : "") + quoted_list(known), known);
  return -1;
}

bool Object::numbers(const char* key, double* target, std::size_t count, const Range& range) {
  const json* value = find(key);
  if (!value) return false;
  std::vector<double> read(count);
  if (!read_numbers(*value, path(key), range, read.data(), count, report_)) return false;
  std::copy(read.begin(), read.end(), target);
  return true;
}

const json* Object::find_array(const char* key, std::size_t min, std::size_t max) {
  const json* value = find(key);
  if (!value) return nullptr;
  if (value->is_array() && value->size() >= min && value->size() <= max) return value;
  report_.refuse(*value, path(key),
                 "an array of " + std::to_string(min) + " to " + std::to_string(max) + " elements");
  return nullptr;
}

}  // namespace weft::scene
