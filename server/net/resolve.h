#pragma once
#include <string>
#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "net/client.h"

namespace weft::net {

/// "host:port" of the Host header.
inline std::string host_header(const Url& url) { return url.host + ":" + url.port; }

/// In the URL an IPv6 address stands in brackets.
inline std::string unbracketed(const std::string& host) {
  return host.starts_with('[') && host.ends_with(']') ? host.substr(1, host.size() - 2) : host;
}

/// Where the URL's host is. Throws ConnectionError if nobody knows.
inline boost::asio::ip::tcp::resolver::results_type resolve(boost::asio::io_context& io, const Url& url) {
  boost::system::error_code error;
  boost::asio::ip::tcp::resolver resolver(io);
  auto found = resolver.resolve(unbracketed(url.host), url.port, error);
  if (error) throw ConnectionError(host_header(url) + ": " + error.message());
  return found;
}

}  // namespace weft::net
