#include "protocol/member.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace weft::protocol {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxCapabilities = 16;
// Of an object of numbers.
constexpr Bounds kMembers{1, 16};
constexpr std::size_t kMaxNumbers = 3;
constexpr const char* kKinematic = "kinematic";
constexpr const char* kDynamic = "dynamic";

std::string number_text(double value) {
  std::array<char, 32> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 10);
  return {text.data(), end.ptr};
}

std::string kind_of_numbers() {
  return "a number or an array of 2.." + std::to_string(kMaxNumbers) + " numbers";
}

Fault read_numbers(const json& value, const std::string& path, Numbers& to) {
  if (value.is_number()) {
    to = {value.get<double>()};
    return {};
  }
  if (!value.is_array() || value.size() < 2 || value.size() > kMaxNumbers)
    return refuse("bad_type", path, value, kind_of_numbers());
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (!value[i].is_number())
      return refuse("bad_type", pointer_to(path, std::to_string(i)), value[i], "a number");
    to.push_back(value[i].get<double>());
  }
  return {};
}

}  // namespace

std::string range_text(const Bounds& bounds) {
  std::string text = number_text(bounds.low) + ".." + number_text(bounds.high);
  if (*bounds.unit != 0) text += std::string(" (") + bounds.unit + ")";
  return text;
}

std::string shown(const json& value) {
  constexpr std::size_t kShown = 60;
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() <= kShown) return text;
  std::size_t end = kShown;
  while ((static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;  // not within a character
  return text.substr(0, end) + "...";
}

JsonFault refuse(const char* code, std::string path, const json& value, const std::string& allowed) {
  std::string message = path + " is " + shown(value) + "; allowed: " + allowed;
  return {code, std::move(path), std::move(message)};
}

std::string kind_of(const double&, const Bounds& bounds) { return "a number " + range_text(bounds); }

Fault read(const json& value, const Bounds& bounds, const std::string& path, double& to) {
  if (!value.is_number()) return refuse("bad_type", path, value, kind_of(to, bounds));
  to = value.get<double>();
  if (!(to >= bounds.low && to <= bounds.high)) return refuse("range", path, value, range_text(bounds));
  return {};
}

std::string kind_of(const std::string&, const Bounds& bounds) {
  return "a string of " + range_text(bounds) + " characters";
}

Fault read(const json& value, const Bounds& bounds, const std::string& path, std::string& to) {
  if (!value.is_string()) return refuse("bad_type", path, value, kind_of(to, bounds));
  to = value.get<std::string>();
  const auto starts_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
  const auto characters = double(std::count_if(to.begin(), to.end(), starts_character));
  if (characters < bounds.low || characters > bounds.high)
    return refuse("range", path, value, range_text(bounds) + " characters");
  return {};
}

std::string kind_of(const std::vector<std::string>&, const Bounds& bounds) {
  return "an array of at most " + std::to_string(kMaxCapabilities) + " strings of " + range_text(bounds) +
         " characters";
}

Fault read(const json& value, const Bounds& bounds, const std::string& path, std::vector<std::string>& to) {
  if (!value.is_array()) return refuse("bad_type", path, value, kind_of(to, bounds));
  if (value.size() > kMaxCapabilities) return refuse("range", path, value, kind_of(to, bounds));
  to.resize(value.size());
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (auto fault = read(value[i], bounds, pointer_to(path, std::to_string(i)), to[i])) return fault;
  }
  return {};
}

std::string kind_of(const Motion&, const Bounds&) {
  return std::string("\"") + kKinematic + "\" or \"" + kDynamic + "\"";
}

Fault read(const json& value, const Bounds& bounds, const std::string& path, Motion& to) {
  if (!value.is_string()) return refuse("bad_type", path, value, kind_of(to, bounds));
  to = value == kDynamic ? Motion::dynamic : Motion::kinematic;
  if (to == Motion::kinematic && value != kKinematic)
    return refuse("range", path, value, kind_of(to, bounds));
  return {};
}

std::string kind_of(const bool&, const Bounds&) { return "true or false"; }

Fault read(const json& value, const Bounds& bounds, const std::string& path, bool& to) {
  if (!value.is_boolean()) return refuse("bad_type", path, value, kind_of(to, bounds));
  to = value.get<bool>();
  return {};
}

std::string kind_of(const Parameters&, const Bounds&) {
  return "an object of " + range_text(kMembers) + " members, each " + kind_of_numbers();
}

Fault read(const json& value, const Bounds& bounds, const std::string& path, Parameters& to) {
  if (!value.is_object()) return refuse("bad_type", path, value, kind_of(to, bounds));
  const auto members = static_cast<double>(value.size());
  if (members < kMembers.low || members > kMembers.high)
    return refuse("range", path, value, kind_of(to, bounds));
  for (const auto& [name, number] : value.items()) {
    if (auto fault = read_numbers(number, pointer_to(path, name), to[name])) return fault;
  }
  return {};
}

void write(const Motion& motion, nlohmann::ordered_json& to) {
  to = motion == Motion::dynamic ? kDynamic : kKinematic;
}

void write(const std::string& from, nlohmann::ordered_json& to) {
  if (!from.empty()) to = from;
}

void write(const Parameters& from, nlohmann::ordered_json& to) {
  for (const auto& [name, numbers] : from) {
    if (numbers.size() == 1) {
      to[name] = numbers[0];
    } else {
      to[name] = numbers;
    }
  }
}

}  // namespace weft::protocol
