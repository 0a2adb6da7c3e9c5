#include <algorithm>
#include <cmath>

#include "protocol/operation.h"

namespace weft::protocol {
namespace {

using nlohmann::json;

std::string pair_text(const char* one, const char* other) {
  return pointer_to("", one) + " and " + pointer_to("", other);
}

/// `member` stands where it must not.
JsonFault conflict(const char* member, const char* with, const std::string& allowed) {
  const std::string path = pointer_to("", member);
  return {"conflict", path, path + " is given beside " + pointer_to("", with) + "; allowed: " + allowed};
}

JsonFault missing(const char* member, const std::string& allowed) {
  const std::string path = pointer_to("", member);
  return {"missing", path, path + " is missing; allowed: " + allowed};
}

/// To unit length, by way of the largest component so that no square overflows or vanishes. False for zero.
template <std::size_t kSize>
bool normalise(std::array<double, kSize>& components) {
  double largest = 0;
  for (const double component : components) largest = std::max(largest, std::abs(component));
  if (largest == 0) return false;
  double square = 0;
  for (double& component : components) {
    component /= largest;
    square += component * component;
  }
  for (double& component : components) component /= std::sqrt(square);
  return true;
}

}  // namespace

Fault exactly_one(const json& message, const char* one, const char* other) {
  const std::string allowed = "exactly one of " + pair_text(one, other);
  if (message.contains(one) && message.contains(other)) return conflict(other, one, allowed);
  if (!message.contains(one) && !message.contains(other)) return missing(one, allowed);
  return {};
}

Fault at_most_one(const json& message, const char* one, const char* other) {
  if (!message.contains(one) || !message.contains(other)) return {};
  return conflict(other, one, "at most one of " + pair_text(one, other));
}

Fault together(const json& message, const char* one, const char* other) {
  if (message.contains(one) == message.contains(other)) return {};
  return missing(message.contains(one) ? other : one, "both " + pair_text(one, other) + " or neither");
}

Fault differ(const json& message, const char* one, const char* other) {
  if (!message.contains(one) || !message.contains(other) || message[one] != message[other]) return {};
  return refuse("range", pointer_to("", one), message[one], "any point but " + pointer_to("", other));
}

Fault beside(const json& message, std::initializer_list<const char*> members, const char* right,
             const char* wrong) {
  if (!message.contains(wrong)) return {};
  for (const char* member : members) {
    if (message.contains(member)) return conflict(member, wrong, "beside " + pointer_to("", right));
  }
  return {};
}

Fault normalised(const json& message, const char* name, Vector& vector, const char* allowed) {
  if (normalise(vector)) return {};
  return refuse("range", pointer_to("", name), message[name], allowed);
}

Fault normalised(const json& message, const char* name, std::optional<Turn>& turn, const char* allowed) {
  if (!turn || normalise(*turn)) return {};
  return refuse("range", pointer_to("", name), message[name], allowed);
}

}  // namespace weft::protocol
