#pragma once
/// The bearer token of a request: `Authorization: Bearer T` (RFC 6750), or for browsers, whose WebSockets can
/// set no header, a subprotocol `weft.token.T` beside `weft.v1` or `?token=T`.
#include <optional>
#include <string>

#include "net/request_rules.h"

namespace weft::net {

struct Credentials {
  std::optional<std::string> token;
  std::string fault;  ///< why they cannot be taken, for people; else empty
};

/// Lists of `request` are joined (join_lists).
Credentials credentials_of(const HttpRequest& request);

}  // namespace weft::net
