#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace weft::net {

/// Whether `host`, a request's Host header, is a name of this server. A page whose own name an attacker lets
/// resolve to this machine (DNS rebinding) sends that name: only those in `names` ("weft.example", "*" for
/// all) and localhost are known. Addresses need no name and are always right.
bool host_allowed(std::string_view host, const std::vector<std::string>& names);

/// Whether a page from `origin` (the request's Origin header) may command this server, which it calls `host`
/// (the Host header, of which host_allowed holds). A request without one comes from no browser and may; so
/// may the server's own pages and those of this machine. Others must be listed in `allowed`, whole
/// ("https://example.org") or all ("*"); `null` only by "*".
bool origin_allowed(std::string_view origin, std::string_view host, const std::vector<std::string>& allowed);

}  // namespace weft::net
