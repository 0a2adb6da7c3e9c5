#pragma once
/// One value of a client's message: for each type that a member can have its reader, its writer and the words
/// for what is allowed.
#include <array>
#include <cmath>
#include <concepts>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "protocol/message.h"
#include "protocol/strict_json.h"

namespace weft::protocol {

using Fault = std::optional<JsonFault>;

/// Of a number, of each component of a vector, or of the characters of a text.
struct Bounds {
  double low = 0, high = 0;
  const char* unit = "";
};

/// "0..100 (m/s)".
std::string range_text(const Bounds& bounds);

/// A value as a message shows it: whole, or its first 60 bytes.
std::string shown(const nlohmann::json& value);

/// "/speed is 1000; allowed: 0..100 (m/s)".
JsonFault refuse(const char* code, std::string path, const nlohmann::json& value, const std::string& allowed);

// What is allowed, of each type: "a number 0..100 (m/s)". The first argument only tells the type.

std::string kind_of(const double&, const Bounds& bounds);
std::string kind_of(const std::string&, const Bounds& bounds);
std::string kind_of(const std::vector<std::string>&, const Bounds& bounds);
std::string kind_of(const Motion&, const Bounds&);
std::string kind_of(const Parameters&, const Bounds&);
std::string kind_of(const bool&, const Bounds&);

template <std::integral Integer>
std::string kind_of(const Integer&, const Bounds& bounds) {
  return "an integer " + range_text(bounds);
}

template <std::size_t kSize>
std::string kind_of(const std::array<double, kSize>&, const Bounds& bounds) {
  return "an array of " + std::to_string(kSize) + " numbers " + range_text(bounds);
}

template <class T>
std::string kind_of(const std::optional<T>&, const Bounds& bounds) {
  return kind_of(T{}, bounds);
}

// Checks a value, found at `path` of the message, and stores it in `to`; or says what is wrong with it
// (bad_type, range).

Fault read(const nlohmann::json& value, const Bounds& bounds, const std::string& path, double& to);
Fault read(const nlohmann::json& value, const Bounds& bounds, const std::string& path, std::string& to);
Fault read(const nlohmann::json& value, const Bounds& bounds, const std::string& path,
           std::vector<std::string>& to);
Fault read(const nlohmann::json& value, const Bounds& bounds, const std::string& path, Motion& to);
Fault read(const nlohmann::json& value, const Bounds& bounds, const std::string& path, bool& to);
/// What their names are, and their bounds, is not for this layer to tell.
Fault read(const nlohmann::json& value, const Bounds& bounds, const std::string& path, Parameters& to);

/// Any number without a fraction is an integer, however it is written: 7.0 and 7e0 too.
template <std::integral Integer>
Fault read(const nlohmann::json& value, const Bounds& bounds, const std::string& path, Integer& to) {
  const double number = value.is_number() ? value.get<double>() : 0.5;
  if (number != std::floor(number)) return refuse("bad_type", path, value, kind_of(to, bounds));
  if (!(number >= bounds.low && number <= bounds.high))
    return refuse("range", path, value, range_text(bounds));
  to = static_cast<Integer>(number);
  return {};
}

template <std::size_t kSize>
Fault read(const nlohmann::json& value, const Bounds& bounds, const std::string& path,
           std::array<double, kSize>& to) {
  if (!value.is_array() || value.size() != to.size())
    return refuse("bad_type", path, value, kind_of(to, bounds));
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (auto fault = read(value[i], bounds, pointer_to(path, std::to_string(i)), to[i])) return fault;
  }
  return {};
}

template <class T>
Fault read(const nlohmann::json& value, const Bounds& bounds, const std::string& path, std::optional<T>& to) {
  return read(value, bounds, path, to.emplace());
}

// The inverse. Leaves null where there is nothing to say: an empty text, an absent value.

void write(const Motion& motion, nlohmann::ordered_json& to);
void write(const std::string& from, nlohmann::ordered_json& to);
void write(const Parameters& from, nlohmann::ordered_json& to);

template <class T>
void write(const T& from, nlohmann::ordered_json& to) {
  to = from;
}

template <class T>
void write(const std::optional<T>& from, nlohmann::ordered_json& to) {
  if (from) to = *from;
}

}  // namespace weft::protocol
