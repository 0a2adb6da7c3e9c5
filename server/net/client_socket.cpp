#include "net/client_socket.h"

#include <boost/asio/ssl/host_name_verification.hpp>

#include "net/resolve.h"
#include "protocol/message.h"

namespace weft::net {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::ip::tcp;

namespace {

/// A frame of section 6's largest records, for a scene of many cloths.
constexpr std::size_t kMessageBytes = 64 << 20;

void begin_tls(Transport& transport, TlsContext context, const Url& url, const ClientSecurity& security,
               AnyHandler done) {
  Transport::Tls& tls = transport.begin_tls(std::move(context));
  const std::string name = unbracketed(url.host);
  if (security.check_certificate) {
    tls.set_verify_callback(asio::ssl::host_name_verification(name));
  } else {
    tls.set_verify_mode(asio::ssl::verify_none);
  }
  SSL_set_tlsext_host_name(tls.native_handle(), name.c_str());
  transport.shake_hands(asio::ssl::stream_base::client, {}, std::move(done));
}

}  // namespace

void connect(Transport& transport, const tcp::resolver::results_type& where, const Url& url,
             const ClientSecurity& security, TlsContext tls, std::chrono::milliseconds limit,
             AnyHandler done) {
  transport.next_layer().expires_after(limit);
  transport.next_layer().async_connect(
      where, [&transport, &url, &security, tls = std::move(tls), done = std::move(done)](
                 beast::error_code error, const tcp::endpoint&) mutable {
        if (error || !tls) return done(error);
        begin_tls(transport, std::move(tls), url, security, std::move(done));
      });
}

std::string why_not_connected(const Transport& transport, const Url& url, beast::error_code error) {
  return (transport.has_tls() ? "no TLS with " : "cannot connect to ") + host_header(url) + ": " +
         error.message();
}

ClientSocket::ClientSocket(asio::io_context& io, const Url& url, const ClientSecurity& security,
                           TlsContext tls)
    : ws_(TcpStream(io)), url_(url), security_(security), tls_(std::move(tls)) {}

void ClientSocket::open(const tcp::resolver::results_type& where, std::chrono::milliseconds limit,
                        AnyHandler done) {
  connect(ws_.next_layer(), where, url_, security_, tls_, limit,
          [this, limit, done = std::move(done)](error_code error) mutable {
            if (error) return done(error);
            shake_hands(limit, std::move(done));
          });
}

void ClientSocket::shake_hands(std::chrono::milliseconds limit, AnyHandler done) {
  stage_ = Stage::shaking_hands;
  error_code ignored;
  beast::get_lowest_layer(ws_).socket().set_option(tcp::no_delay(true), ignored);
  beast::get_lowest_layer(ws_).expires_never();
  ws_.set_option(websocket::stream_base::timeout{limit, websocket::stream_base::none(), false});
  ws_.set_option(websocket::stream_base::decorator([this](websocket::request_type& request) {
    if (!security_.token.empty()) request.set(beast::http::field::authorization, "Bearer " + security_.token);
    request.set(beast::http::field::sec_websocket_protocol, protocol::kSubprotocol);
    request.set(beast::http::field::user_agent, "weft client");
  }));
  ws_.read_message_max(kMessageBytes);
  ws_.async_handshake(response_, host_header(url_), url_.target,
                      [this, done = std::move(done)](error_code error) mutable {
                        if (!error) stage_ = Stage::open;
                        done(error);
                      });
}

void ClientSocket::write(std::string_view text, AnyHandler done) {
  ws_.text(true);
  ws_.async_write(asio::buffer(text.data(), text.size()), std::move(done));
}

void ClientSocket::read(AnyHandler done) {
  incoming_.clear();
  ws_.async_read(incoming_, std::move(done));
}

std::span<const std::uint8_t> ClientSocket::received() const {
  const auto data = incoming_.data();
  return {static_cast<const std::uint8_t*>(data.data()), data.size()};
}

void ClientSocket::close(AnyHandler done) { ws_.async_close(websocket::close_code::normal, std::move(done)); }

void ClientSocket::drop() { beast::get_lowest_layer(ws_).close(); }

std::string ClientSocket::why(std::string_view doing, error_code error) const {
  if (stage_ == Stage::connecting) return why_not_connected(ws_.next_layer(), url_, error);
  if (error == websocket::error::upgrade_declined) {
    std::string words = response_.body();
    while (words.ends_with('\n')) words.pop_back();
    return "the server refused: " + std::to_string(response_.result_int()) + " " + words;
  }
  if (stage_ == Stage::shaking_hands)
    return "no WebSocket at " + host_header(url_) + url_.target + ": " + error.message();
  if (error == websocket::error::closed) {
    const auto& reason = ws_.reason();
    return "the server closed the connection: " + std::to_string(reason.code) + " " +
           std::string(reason.reason.data(), reason.reason.size());
  }
  return std::string(doing) + ": " + error.message();
}

}  // namespace weft::net
