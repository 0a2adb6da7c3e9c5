#include "net/client.h"

#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/io_context.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>

#include "net/client_socket.h"
#include "net/resolve.h"

namespace weft::net {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using beast::error_code;

namespace {

constexpr auto kSendTime = std::chrono::seconds(10);
constexpr auto kGoodbyeTime = std::chrono::seconds(2);

/// Runs `io` until `done`, at most until `until`; whether it is done.
template <class Done>
bool run_until(asio::io_context& io, std::chrono::steady_clock::time_point until, const Done& done) {
  while (!done()) {
    if (io.stopped()) io.restart();
    // First what is ready already: run_one_until does nothing when the time is over.
    if (io.poll_one() > 0) continue;
    if (io.run_one_until(until) == 0 && std::chrono::steady_clock::now() >= until) return false;
  }
  return true;
}

/// Null where the URL asks for none. Throws ConnectionError where no certificate can be read.
TlsContext tls_of(const Url& url, const ClientSecurity& security) {
  if (!url.secure) return nullptr;
  try {
    return client_tls(security.authorities);
  } catch (const std::runtime_error& error) {
    throw ConnectionError(error.what());
  }
}

}  // namespace

Url Url::parse(std::string_view text) {
  const auto refuse = [&] {
    return std::invalid_argument("not a URL like ws://HOST:PORT/v1/scenes/NAME or http://HOST:PORT/: " +
                                 std::string(text));
  };
  Url url;
  const auto colons = text.find("://");
  const std::string_view scheme = text.substr(0, colons);
  url.secure = scheme == "wss" || scheme == "https";
  if (colons == std::string_view::npos || (!url.secure && scheme != "ws" && scheme != "http")) throw refuse();
  if (url.secure) url.port = "443";
  const std::string_view rest = text.substr(colons + 3);
  const auto slash = rest.find('/');
  std::string_view authority = rest.substr(0, slash);
  if (slash != std::string_view::npos) url.target = std::string(rest.substr(slash));
  const auto colon = authority.rfind(':');
  if (colon != std::string_view::npos && authority.find(']', colon) == std::string_view::npos) {
    url.port = std::string(authority.substr(colon + 1));
    authority = authority.substr(0, colon);
  }
  url.host = std::string(authority);
  const bool digits = url.port.find_first_not_of("0123456789") == std::string::npos;
  if (url.host.empty() || url.port.empty() || url.port.size() > 5 || !digits) throw refuse();
  return url;
}

HttpReply http_get(const Url& url, std::chrono::milliseconds limit, const ClientSecurity& security) {
  asio::io_context io{1};
  Transport stream{TcpStream(io)};
  std::optional<error_code> result;
  connect(stream, resolve(io, url), url, security, tls_of(url, security), limit,
          [&](error_code error) { result = error; });
  run_until(io, std::chrono::steady_clock::time_point::max(), [&] { return result.has_value(); });
  if (*result) throw ConnectionError(why_not_connected(stream, url, *result));
  http::request<http::empty_body> request{http::verb::get, url.target, 11};
  request.set(http::field::host, host_header(url));
  request.set(http::field::connection, "close");
  if (!security.token.empty()) request.set(http::field::authorization, "Bearer " + security.token);
  beast::flat_buffer buffer;
  http::response<http::string_body> response;
  result.reset();
  http::async_write(stream, request, [&](error_code error, std::size_t) {
    if (error) {
      result = error;
      return;
    }
    http::async_read(stream, buffer, response,
                     [&](error_code read_error, std::size_t) { result = read_error; });
  });
  run_until(io, std::chrono::steady_clock::time_point::max(), [&] { return result.has_value(); });
  if (*result) throw ConnectionError(host_header(url) + ": " + result->message());
  return {response.result_int(), std::move(response.body())};
}

struct Client::Impl {
  Impl(const Url& to, const ClientSecurity& with) : url(to), security(with) {}
  void read();
  [[noreturn]] void fail(std::string_view doing, error_code error) const {
    throw ConnectionError(socket.why(doing, error));
  }

  const Url url;
  const ClientSecurity security;
  asio::io_context io{1};
  ClientSocket socket{io, url, security, tls_of(url, security)};
  bool reading = false;
  std::optional<error_code> read_result;
};

void Client::Impl::read() {
  reading = true;
  read_result.reset();
  socket.read([this](error_code error) {
    reading = false;
    read_result = error;
  });
}

Client::Client(const Url& url, std::chrono::milliseconds limit, const ClientSecurity& security)
    : impl_(std::make_unique<Impl>(url, security)) {
  std::optional<error_code> result;
  impl_->socket.open(resolve(impl_->io, url), limit, [&](error_code error) { result = error; });
  run_until(impl_->io, TimePoint::max(), [&] { return result.has_value(); });
  if (*result) impl_->fail("connecting", *result);
}

Client::~Client() = default;

void Client::send(std::string_view text) {
  std::optional<error_code> result;
  impl_->socket.write(text, [&](error_code error) { result = error; });
  if (!run_until(impl_->io, std::chrono::steady_clock::now() + kSendTime,
                 [&] { return result.has_value(); })) {
    // The handler refers to this call: it must have run before it ends.
    impl_->socket.drop();
    run_until(impl_->io, TimePoint::max(), [&] { return result.has_value(); });
    throw ConnectionError("the server does not read");
  }
  if (*result) impl_->fail("sending", *result);
}

std::optional<Client::Message> Client::receive(TimePoint until) {
  Impl& self = *impl_;
  if (!self.reading && !self.read_result) self.read();
  if (!run_until(self.io, until, [&] { return self.read_result.has_value(); })) return std::nullopt;
  if (*self.read_result) self.fail("receiving", *self.read_result);
  const auto bytes = self.socket.received();
  self.read_result.reset();
  return Message{!self.socket.is_text(), {bytes.begin(), bytes.end()}};
}

void Client::close() {
  Impl& self = *impl_;
  std::optional<error_code> result;
  self.socket.close([&](error_code error) { result = error; });
  if (!run_until(self.io, std::chrono::steady_clock::now() + kGoodbyeTime,
                 [&] { return result.has_value(); })) {
    self.socket.drop();
    run_until(self.io, TimePoint::max(), [&] { return result.has_value(); });
  }
}

}  // namespace weft::net
