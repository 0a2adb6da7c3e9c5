#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace weft::net {

/// Whether a page from `origin` (the request's Origin header) may command this server, whose Host header is
/// `host`. A request without one comes from no browser and may; so may the server's own pages and those of
/// this machine. Others must be listed in `allowed`, whole ("https://example.org") or all ("*"); `null` only
/// by "*".
bool origin_allowed(std::string_view origin, std::string_view host, const std::vector<std::string>& allowed);

}  // namespace weft::net
