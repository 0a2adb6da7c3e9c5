#include "net/request_rules.h"

#include <algorithm>
#include <array>
#include <boost/beast/http/rfc7230.hpp>
#include <iterator>
#include <string_view>

#include "protocol/message.h"

namespace weft::net {

namespace http = boost::beast::http;
using http::field;

namespace {

constexpr std::array kLists{field::connection, field::upgrade, field::sec_websocket_protocol};
constexpr std::array kSingle{field::host, field::origin, field::authorization, field::sec_websocket_key,
                             field::sec_websocket_version};

/// A nonce of 16 bytes in base64: 22 digits, of which the last has but two bits, and two of padding.
bool is_websocket_key(boost::beast::string_view key) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  constexpr std::size_t kDigitCount = 22;
  return key.size() == kDigitCount + 2 && key.ends_with("==") &&
         std::string_view("AQgw").find(key[kDigitCount - 1]) != std::string_view::npos &&
         std::all_of(key.begin(), key.begin() + kDigitCount,
                     [&](char digit) { return kDigits.find(digit) != std::string_view::npos; });
}

/// Names of subprotocols are case-sensitive (RFC 6455, section 4.1).
bool offers(boost::beast::string_view list, std::string_view subprotocol) {
  const http::token_list tokens(list);
  return std::any_of(tokens.begin(), tokens.end(), [&](boost::beast::string_view token) {
    return std::string_view(token.data(), token.size()) == subprotocol;
  });
}

}  // namespace

void join_lists(HttpRequest& request) {
  for (const field name : kLists) {
    const auto [begin, end] = request.equal_range(name);
    if (begin == end || std::next(begin) == end) continue;
    std::string joined;
    for (auto line = begin; line != end; ++line)
      joined.append(joined.empty() ? "" : ", ").append(line->value().data(), line->value().size());
    request.set(name, joined);
  }
}

std::string header_fault(const HttpRequest& request) {
  for (const field name : kSingle) {
    if (request.count(name) > 1) return http::to_string(name).to_string() + " is given more than once";
  }
  constexpr unsigned kHttp11 = 11;
  if (request.version() >= kHttp11 && request.count(field::host) == 0) return "Host is missing";
  if (request[field::host].find_first_of(" \t,/@?#\\") != boost::beast::string_view::npos)
    return "Host is not a name or an address, with or without a port";
  return {};
}

std::string upgrade_fault(const HttpRequest& request) {
  if (!is_websocket_key(request[field::sec_websocket_key]))
    return "Sec-WebSocket-Key must be 16 bytes in base64";
  if (!offers(request[field::sec_websocket_protocol], protocol::kSubprotocol))
    return "Sec-WebSocket-Protocol must offer " + std::string(protocol::kSubprotocol);
  return {};
}

}  // namespace weft::net
