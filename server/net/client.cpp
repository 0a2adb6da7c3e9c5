#include "net/client.h"

#include <utility>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/stream.hpp>

#include "net/resolve.h"
#include "net/secure.h"
#include "net/transport.h"
#include "protocol/message.h"

namespace weft::net {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using beast::error_code;

namespace {

constexpr auto kSendTime = std::chrono::seconds(10);
constexpr auto kGoodbyeTime = std::chrono::seconds(2);
/// A frame of section 6's largest records, for a scene of many cloths.
constexpr std::size_t kMessageBytes = 64 << 20;

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

/// Begins TLS on a stream that is connected, with whom the URL names.
void secure(asio::io_context& io, Transport& stream, const Url& url, const ClientSecurity& security) {
  TlsContext context;
  try {
    context = client_tls(security.authorities);
  } catch (const std::runtime_error& error) {
    throw ConnectionError(error.what());
  }
  std::optional<error_code> result;
  begin_client_tls(stream, context, url, security, [&](error_code error) { result = error; });
  run_until(io, std::chrono::steady_clock::time_point::max(), [&] { return result.has_value(); });
  if (*result) throw ConnectionError("no TLS with " + host_header(url) + ": " + result->message());
}

/// Connects within `limit`; later operations have the same end of time.
void connect(asio::io_context& io, Transport& stream, const Url& url, std::chrono::milliseconds limit,
             const ClientSecurity& security) {
  const auto found = resolve(io, url);
  std::optional<error_code> result;
  TcpStream& tcp = stream.next_layer();
  tcp.expires_after(limit);
  tcp.async_connect(found, [&](error_code error, const tcp::endpoint&) { result = error; });
  run_until(io, std::chrono::steady_clock::time_point::max(), [&] { return result.has_value(); });
  if (*result) throw ConnectionError("cannot connect to " + host_header(url) + ": " + result->message());
  if (url.secure) secure(io, stream, url, security);
}

template <class Request>
void show_token(Request& request, const ClientSecurity& security) {
  if (!security.token.empty()) request.set(http::field::authorization, "Bearer " + security.token);
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
  connect(io, stream, url, limit, security);
  http::request<http::empty_body> request{http::verb::get, url.target, 11};
  request.set(http::field::host, host_header(url));
  request.set(http::field::connection, "close");
  show_token(request, security);
  beast::flat_buffer buffer;
  http::response<http::string_body> response;
  std::optional<error_code> result;
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
  void read();
  [[noreturn]] void fail(const char* doing, error_code error) const;

  asio::io_context io{1};
  websocket::stream<Transport> ws{TcpStream(io)};
  beast::flat_buffer incoming;
  bool reading = false;
  std::optional<error_code> read_result;
};

void Client::Impl::read() {
  reading = true;
  read_result.reset();
  ws.async_read(incoming, [this](error_code error, std::size_t) {
    reading = false;
    read_result = error;
  });
}

void Client::Impl::fail(const char* doing, error_code error) const {
  if (error == websocket::error::closed) {
    throw ConnectionError("the server closed the connection: " + std::to_string(ws.reason().code) + " " +
                          std::string(ws.reason().reason.data(), ws.reason().reason.size()));
  }
  throw ConnectionError(std::string(doing) + ": " + error.message());
}

Client::Client(const Url& url, std::chrono::milliseconds limit, const ClientSecurity& security)
    : impl_(std::make_unique<Impl>()) {
  auto& ws = impl_->ws;
  connect(impl_->io, ws.next_layer(), url, limit, security);
  beast::get_lowest_layer(ws).socket().set_option(tcp::no_delay(true));
  beast::get_lowest_layer(ws).expires_never();
  ws.set_option(websocket::stream_base::timeout{limit, websocket::stream_base::none(), false});
  ws.set_option(websocket::stream_base::decorator([&security](websocket::request_type& request) {
    show_token(request, security);
    request.set(http::field::sec_websocket_protocol, protocol::kSubprotocol);
    request.set(http::field::user_agent, "weft client");
  }));
  ws.read_message_max(kMessageBytes);
  std::optional<error_code> result;
  websocket::response_type response;
  ws.async_handshake(response, host_header(url), url.target, [&](error_code error) { result = error; });
  run_until(impl_->io, TimePoint::max(), [&] { return result.has_value(); });
  if (*result == websocket::error::upgrade_declined) {
    std::string words = response.body();
    while (!words.empty() && words.back() == '\n') words.pop_back();
    throw ConnectionError("the server refused: " + std::to_string(response.result_int()) + " " + words);
  }
  if (*result)
    throw ConnectionError("no WebSocket at " + host_header(url) + url.target + ": " + result->message());
}

Client::~Client() = default;

void Client::send(std::string_view text) {
  std::optional<error_code> result;
  impl_->ws.text(true);
  impl_->ws.async_write(asio::buffer(text.data(), text.size()),
                        [&](error_code error, std::size_t) { result = error; });
  if (!run_until(impl_->io, std::chrono::steady_clock::now() + kSendTime,
                 [&] { return result.has_value(); })) {
    // The handler refers to this call: it must have run before it ends.
    beast::get_lowest_layer(impl_->ws).close();
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
  const auto data = self.incoming.data();
  const auto* bytes = static_cast<const std::uint8_t*>(data.data());
  Message message{self.ws.got_binary(), {bytes, bytes + data.size()}};
  self.incoming.clear();
  self.read_result.reset();
  return message;
}

void Client::close() {
  Impl& self = *impl_;
  std::optional<error_code> result;
  self.ws.async_close(websocket::close_code::normal, [&](error_code error) { result = error; });
  if (!run_until(self.io, std::chrono::steady_clock::now() + kGoodbyeTime,
                 [&] { return result.has_value(); })) {
    beast::get_lowest_layer(self.ws).close();
    run_until(self.io, TimePoint::max(), [&] { return result.has_value(); });
  }
}

}  // namespace weft::net
