#pragma once
/// What the server answers of itself over HTTP; HttpSession sends it.
#include <memory>
#include <string>
#include <string_view>
#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/beast/http/status.hpp>

#include "net/context.h"

namespace weft::net {

/// What is answered, but for the headers that every answer has.
struct Answer {
  boost::beast::http::status status = boost::beast::http::status::ok;
  std::shared_ptr<const std::string> content;
  std::string_view media_type = "text/plain; charset=utf-8";
  std::string etag = {};
  std::string location = {};
  bool last = false;  ///< the connection ends with it
};

Answer plain(boost::beast::http::status status, std::string text);
/// Of text that is JSON.
Answer json_answer(boost::beast::http::status status, std::string text);

/// Whether every scene steps in time; if not, which do not.
Answer health(const Context& context);
/// Whether another viewer should be sent here; if not, why.
Answer readiness(const Context& context);
/// What the server counts, as it is now.
Answer metrics(const Context& context);
/// Why there is no place for the connection.
Answer no_place(const Context& context, NoPlace why);
/// Why a client's scene was not made.
Answer not_made(const host::NotMade& no);

}  // namespace weft::net
