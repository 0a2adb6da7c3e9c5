#include "library/checks.h"

#include <cmath>
#include <cstdio>

namespace weft::library {
namespace {

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.16g", value);
  return text;
}

std::string message(const char* name, double value, const std::string& allowed) {
  std::string text = name;
  text.append(" is ").append(number_text(value)).append("; must be ").append(allowed);
  return text;
}

}  // namespace

double within(double value, const char* name, const scene::Range& range) {
  // A NaN is in no range.
  if (!(value >= range.min && value <= range.max)) throw Error(message(name, value, range.text()));
  return value;
}

int within(int value, const char* name, const scene::Range& range) {
  within(static_cast<double>(value), name, range);
  return value;
}

Vec3 within(const Vector& value, const char* name, const scene::Range& range) {
  constexpr const char* kAxes[] = {"x of ", "y of ", "z of "};
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string component = std::string(kAxes[i]).append(name);
    within(value[i], component.c_str(), range);
  }
  return {value[0], value[1], value[2]};
}

Quaternion unit_turn(const Turn& value, const char* name) {
  for (const double component : value) within(component, name, kTurn);
  const Quaternion turn(value[0], value[1], value[2], value[3]);
  constexpr double kShortest = 1e-9;
  if (turn.norm() < kShortest) throw Error(std::string(name).append(" is 0; must be of another length"));
  return turn.normalized();
}

void refuse_name(const char* name, std::string_view value, const std::vector<std::string>& known) {
  std::string text = name;
  text.append(" is \"").append(value).append("\"; must be ").append(known.empty() ? "left out" : "one of ");
  for (const std::string& each : known) text.append(&each == known.data() ? "" : ", ").append(each);
  throw Error(text);
}

}  // namespace weft::library
