#pragma once
/// What a connection may do: PROTOCOL.md section 1.
#include <optional>
#include <string_view>

#include "protocol/operations.h"

namespace weft::protocol {

/// Each may do what those before it may, too.
enum class Role {
  view,     ///< watch, and say from where
  control,  ///< change what a scene does
  admin     ///< change which scenes there are
};

/// "view", "control", "admin".
std::string_view name_of(Role role);
/// The inverse of name_of.
std::optional<Role> role_named(std::string_view name);

/// The least that may give the command.
Role role_for(const Command& command);

}  // namespace weft::protocol
