#pragma once
/// Who may do what: bearer tokens and the roles that they give.
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "protocol/role.h"

namespace weft::net {

/// A token as a client shows it: letters, digits and "-._~", so that it stands unchanged in a header, in a
/// subprotocol's name and in a URL.
inline constexpr std::size_t kMinTokenLength = 16, kMaxTokenLength = 128;
bool is_token(std::string_view text);

class Access {
 public:
  /// Without tokens: everybody is an admin.
  Access() = default;
  /// Those of a file (server/docs/operations.md). Throws std::runtime_error, naming file, member, value and
  /// what is allowed, if it cannot be used.
  static Access read(const std::filesystem::path& file);

  /// The role of whoever shows this token, or none: `nullopt` where that is nobody.
  std::optional<protocol::Role> role_of(std::optional<std::string_view> token) const;

 private:
  using Digest = std::array<unsigned char, 32>;  ///< SHA-256
  struct Entry {
    Digest digest;
    protocol::Role role;
  };
  static Digest digest_of(std::string_view token);

  std::vector<Entry> entries_;
  std::optional<protocol::Role> without_token_ = protocol::Role::admin;
};

}  // namespace weft::net
