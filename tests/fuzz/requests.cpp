#include "net/request_rules.h"

#include <algorithm>
#include <boost/beast/http/parser.hpp>
#include <string>

#include "net/access.h"
#include "net/credentials.h"
#include "net/origin.h"
#include "net/static_files.h"
#include "targets.h"

namespace weft::fuzz {

namespace http = boost::beast::http;

// Whatever passes the rules has the form that the rest of the server counts on.
void requests(Input input) {
  http::request_parser<http::string_body> parser;
  parser.eager(true);
  parser.header_limit(8192);
  boost::beast::error_code error;
  parser.put(boost::asio::buffer(input.data(), input.size()), error);
  if (error || !parser.is_header_done()) return;
  net::HttpRequest& request = parser.get();
  net::join_lists(request);
  for (const http::field list :
       {http::field::connection, http::field::upgrade, http::field::sec_websocket_protocol})
    require(request.count(list) <= 1, "lists are joined");
  if (!net::header_fault(request).empty()) return;
  const std::string_view host = net::view(request[http::field::host]);
  const std::string_view origin = net::view(request[http::field::origin]);
  require(host.find_first_of(" \t/@") == std::string_view::npos, "a host is a name");
  net::host_allowed(host, {"weft.example"});
  require(net::host_allowed(host, {"*"}), "where all names are allowed, this one is");
  net::origin_allowed(origin, host, {"https://show.example"});
  require(net::origin_allowed(origin, host, {"*"}), "where all origins are allowed, this one is");
  const net::Credentials credentials = net::credentials_of(request);
  require(!credentials.token || credentials.fault.empty(), "a token with a fault is none");
  require(!credentials.token || net::is_token(*credentials.token), "a token is one");
  net::upgrade_fault(request);
  const auto path = net::path_of_target(net::view(request.target()));
  require(!path || (path->is_relative() &&
                    std::none_of(path->begin(), path->end(),
                                 [](const auto& part) { return part.native().starts_with('.'); })),
          "a file's path leads to nothing hidden and not out of the page's folder");
}

}  // namespace weft::fuzz
