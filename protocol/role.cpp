#include "protocol/role.h"

#include <algorithm>
#include <array>

#include "protocol/operation.h"

namespace weft::protocol {
namespace {

constexpr std::array<std::string_view, 3> kNames{"view", "control", "admin"};

}  // namespace

std::string_view name_of(Role role) { return kNames[static_cast<std::size_t>(role)]; }

std::optional<Role> role_named(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<Role>(found - kNames.begin());
}

Role role_for(const Command& command) { return operations()[command.index()].role; }

}  // namespace weft::protocol
