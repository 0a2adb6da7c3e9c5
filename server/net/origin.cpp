#include "net/origin.h"

#include <arpa/inet.h>

#include <algorithm>
#include <cctype>

namespace weft::net {
namespace {

bool same_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// "host[:port]" of "scheme://host[:port]", empty if that is not its form.
std::string_view authority(std::string_view origin) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.size() > scheme.size() && same_ignoring_case(origin.substr(0, scheme.size()), scheme)) {
      const std::string_view rest = origin.substr(scheme.size());
      return rest.find_first_of("/@?# ") == std::string_view::npos ? rest : std::string_view{};
    }
  }
  return {};
}

std::string_view without_port(std::string_view authority) {
  // The colons of an address are within its brackets.
  const std::size_t begin = authority.starts_with('[') ? authority.find(']') : 0;
  return authority.substr(0, authority.find(':', begin));
}

/// "[::1]", "192.168.0.7".
bool is_address(std::string_view name) {
  in6_addr parsed;
  if (name.starts_with('[') && name.ends_with(']'))
    return inet_pton(AF_INET6, std::string(name.substr(1, name.size() - 2)).c_str(), &parsed) == 1;
  return inet_pton(AF_INET, std::string(name).c_str(), &parsed) == 1;
}

bool is_localhost(std::string_view name) {
  constexpr std::string_view kLocalhost = "localhost";
  if (name.size() < kLocalhost.size()) return false;
  const std::size_t begin = name.size() - kLocalhost.size();
  return same_ignoring_case(name.substr(begin), kLocalhost) && (begin == 0 || name[begin - 1] == '.');
}

}  // namespace

bool host_allowed(std::string_view host, const std::vector<std::string>& names) {
  std::string_view name = without_port(host);
  if (name.ends_with('.')) name.remove_suffix(1);
  return is_address(name) || is_localhost(name) ||
         std::any_of(names.begin(), names.end(), [&](const std::string& known) {
           return known == "*" || same_ignoring_case(known, name);
         });
}

bool origin_allowed(std::string_view origin, std::string_view host, const std::vector<std::string>& allowed) {
  if (origin.empty()) return true;
  for (const std::string& entry : allowed) {
    if (entry == "*" || same_ignoring_case(entry, origin)) return true;
  }
  const std::string_view from = authority(origin);
  if (from.empty()) return false;
  if (same_ignoring_case(from, host)) return true;
  const std::string_view name = without_port(from);
  return same_ignoring_case(name, "localhost") || name == "127.0.0.1" || name == "[::1]";
}

}  // namespace weft::net
