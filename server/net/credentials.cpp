#include "net/credentials.h"

#include <algorithm>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <string_view>
#include <vector>

#include "net/access.h"

namespace weft::net {

namespace beast = boost::beast;
namespace http = beast::http;

namespace {

constexpr std::string_view kScheme = "Bearer ", kSubprotocol = "weft.token.", kParameter = "token=";

bool is_bearer(const HttpRequest& request) {
  return beast::iequals(request[http::field::authorization].substr(0, kScheme.size()),
                        {kScheme.data(), kScheme.size()});
}

/// All that are shown, wherever.
std::vector<std::string_view> shown_by(const HttpRequest& request) {
  std::vector<std::string_view> tokens;
  if (is_bearer(request)) tokens.push_back(view(request[http::field::authorization]).substr(kScheme.size()));
  for (const beast::string_view subprotocol :
       http::token_list(request[http::field::sec_websocket_protocol])) {
    if (view(subprotocol).starts_with(kSubprotocol))
      tokens.push_back(view(subprotocol).substr(kSubprotocol.size()));
  }
  std::string_view query = view(request.target());
  query.remove_prefix(std::min(query.find('?'), query.size()));
  while (!query.empty()) {
    query.remove_prefix(1);
    const std::string_view parameter = query.substr(0, query.find('&'));
    query.remove_prefix(parameter.size());
    if (parameter.starts_with(kParameter)) tokens.push_back(parameter.substr(kParameter.size()));
  }
  return tokens;
}

}  // namespace

Credentials credentials_of(const HttpRequest& request) {
  if (request.count(http::field::authorization) > 0 && !is_bearer(request))
    return {{}, "Authorization must be \"Bearer TOKEN\""};
  Credentials credentials;
  for (const std::string_view token : shown_by(request)) {
    if (!is_token(token)) return {{}, "the token must be 16..128 letters, digits or any of -._~"};
    if (credentials.token && *credentials.token != token) return {{}, "two tokens are given that differ"};
    credentials.token = token;
  }
  return credentials;
}

}  // namespace weft::net
