#pragma once
/// An operation as the reader and the writer of commands see it.
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "protocol/member.h"
#include "protocol/message.h"
#include "protocol/role.h"

namespace weft::protocol {

enum class Presence { required, optional };

/// A member of an operation and the member of the command that holds it.
struct Field {
  const char* name;
  Presence presence;
  Bounds bounds;
  Fault (*read_into)(const Field& field, const nlohmann::json& value, Command& command);
  /// Leaves null where there is nothing to say.
  void (*write_from)(const Command& command, nlohmann::ordered_json& value);
  std::string (*kind)(const Bounds& bounds);
};

template <class C, class T>
C command_of(T C::*);

template <auto kMember>
constexpr Field field(const char* name, Presence presence, Bounds bounds) {
  using C = decltype(command_of(kMember));
  return {name,
          presence,
          bounds,
          [](const Field& self, const nlohmann::json& value, Command& command) {
            return read(value, self.bounds, pointer_to("", self.name), std::get<C>(command).*kMember);
          },
          [](const Command& command, nlohmann::ordered_json& value) {
            write(std::get<C>(command).*kMember, value);
          },
          [](const Bounds& own) { return kind_of(C{}.*kMember, own); }};
}

struct Operation {
  const char* name;
  Role role;  ///< the least that may give it
  Command blank;
  std::vector<Field> fields;
  /// What no single member can tell; nullptr: nothing.
  Fault (*finish)(const nlohmann::json& message, Command& command);
};

/// In the order of Command's alternatives.
const std::vector<Operation>& operations();

// Rules for several members of a message, by their names, whose values have been read.

Fault exactly_one(const nlohmann::json& message, const char* one, const char* other);
Fault at_most_one(const nlohmann::json& message, const char* one, const char* other);
/// Both or neither.
Fault together(const nlohmann::json& message, const char* one, const char* other);
/// Their values differ, if both are there.
Fault differ(const nlohmann::json& message, const char* one, const char* other);
/// None of the members stands beside `wrong`; they belong to `right`.
Fault beside(const nlohmann::json& message, std::initializer_list<const char*> members, const char* right,
             const char* wrong);
/// Scales the vector to unit length; a zero vector is refused: `allowed` says what is not.
Fault normalised(const nlohmann::json& message, const char* name, Vector& vector, const char* allowed);
/// The same of a turn, if it is there.
Fault normalised(const nlohmann::json& message, const char* name, std::optional<Turn>& turn,
                 const char* allowed);

}  // namespace weft::protocol
