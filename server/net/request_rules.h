#pragma once
#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <string>
#include <string_view>

namespace weft::net {

using HttpRequest = boost::beast::http::request<boost::beast::http::string_body>;

/// Beast has a type of its own for what the standard has since C++17.
inline std::string_view view(boost::beast::string_view text) { return {text.data(), text.size()}; }

/// Joins the lines of each header that is a list into one (RFC 9110, section 5.3), so that whoever looks at
/// the first line sees them all.
void join_lists(HttpRequest& request);

/// What is wrong with the headers of any request, for people; empty if nothing is. Headers that must stand
/// once and stand twice are refused: two readers could choose different ones.
std::string header_fault(const HttpRequest& request);

/// The only version of the WebSocket protocol there is: RFC 6455.
inline constexpr const char* kWebsocketVersion = "13";

/// What is wrong with those of a request to upgrade to a WebSocket of this protocol (RFC 6455,
/// section 4.2.1), but for its version; empty if nothing is. Its lists are joined.
std::string upgrade_fault(const HttpRequest& request);

}  // namespace weft::net
