#include "net/http_session.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/dispatch.hpp>
#include <boost/beast/core/detect_ssl.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/span_body.hpp>
#include <boost/beast/http/write.hpp>
#include <chrono>
#include <optional>
#include <utility>
#include <variant>

#include "net/answers.h"
#include "net/origin.h"
#include "net/request_rules.h"
#include "net/routes.h"
#include "net/websocket_session.h"

namespace weft::net {

namespace beast = boost::beast;
namespace http = beast::http;
using beast::error_code;

namespace {

/// For the first request's whole header, the TLS handshake before it included; and for each further one's,
/// the wait for it included.
constexpr auto kRequestTime = std::chrono::seconds(5);
constexpr auto kResponseTime = std::chrono::seconds(30);  // for the largest file
constexpr const char* kRetrySeconds = "5";
constexpr std::uint32_t kHeaderBytes = 8192;
constexpr unsigned kFirstError = 400;  // of HTTP's statuses

/// The page may load what it needs from here alone, and talk to any Weft server (its address is the page's
/// parameter).
constexpr const char* kContentPolicy =
    "default-src 'self'; connect-src 'self' http: https: ws: wss:; img-src 'self' data: blob:; style-src "
    "'self' 'unsafe-inline'; "
    "object-src 'none'; base-uri 'none'; frame-ancestors 'self'";

bool is_this_machine(const boost::asio::ip::address& address) {
  if (address.is_v6() && address.to_v6().is_v4_mapped())
    return boost::asio::ip::make_address_v4(boost::asio::ip::v4_mapped, address.to_v6()).is_loopback();
  return address.is_loopback();
}

}  // namespace

class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(Context& context, Berth berth, ConnectionPool::Place place, TcpSocket socket)
      : context_(context),
        berth_(std::move(berth)),
        place_(std::move(place)),
        stream_(TcpStream(std::move(socket))) {}

  void start() {
    const TlsContext certificate = context_.secrets.get()->tls;
    tcp().expires_after(kRequestTime);
    if (!certificate) return read();
    beast::async_detect_ssl(
        tcp(), buffer_, [self = shared_from_this(), certificate](error_code error, bool tls) {
          if (error) return self->end();
          if (!tls) return self->read();
          self->stream_.begin_tls(certificate);
          self->stream_.shake_hands(boost::asio::ssl::stream_base::server, self->buffer_.data(),
                                    [self](error_code failed, std::size_t used) {
                                      self->buffer_.consume(used);
                                      if (failed) return self->cut();
                                      self->read();
                                    });
        });
  }

  /// Ends it at once, whatever it does.
  void cut() { tcp().close(); }

 private:
  TcpStream& tcp() { return stream_.next_layer(); }

  void read() {
    // A parser reads one message.
    parser_.emplace();
    parser_->header_limit(kHeaderBytes);
    parser_->body_limit(context_.host.making().document_bytes);
    http::async_read_header(
        stream_, buffer_, *parser_,
        [self = shared_from_this()](error_code error, std::size_t) { self->on_read(error); });
  }

  void on_read(error_code error) {
    if (error == http::error::header_limit) {
      return write(
          plain(http::status::request_header_fields_too_large, "the header has more than 8192 bytes\n"),
          true);
    }
    if (error == http::error::body_limit)
      return write(plain(http::status::payload_too_large,
                         "the body has more than " + std::to_string(context_.host.making().document_bytes) +
                             " bytes (--scene-bytes)\n"),
                   true);
    if (error && error.category() == http::make_error_code(http::error::bad_target).category() &&
        error != http::error::end_of_stream && error != http::error::partial_message) {
      return write(plain(http::status::bad_request, "not a valid HTTP request\n"), true);
    }
    if (error) return end();
    respond();
  }

  void respond() {
    join_lists(parser_->get());
    // A body is of use to PUT alone; where it is not read the connection ends with the answer.
    const bool last =
        !parser_->get().keep_alive() || !parser_->is_done() || place_.refusal() != NoPlace::none;
    const Caller caller{must_be_secure(), place_.refusal(), buffer_.size() > 0};
    Outcome outcome = outcome_of(context_, parser_->get(), caller);
    if (const auto* answer = std::get_if<Answer>(&outcome)) return write(*answer, last || answer->last);
    if (auto* open = std::get_if<SceneToOpen>(&outcome)) {
      return start_websocket_session(context_, std::move(berth_), std::move(place_), std::move(stream_),
                                     parser_->get(), std::move(open->scene), open->role);
    }
    tcp().expires_after(kResponseTime);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this(), make = std::get<SceneToMake>(std::move(outcome))](
                         error_code error, std::size_t) {
                       if (error) return self->on_read(error);
                       self->make_scene(make.name);
                     });
  }

  /// Where there is a certificate, a token is shown to this machine alone without TLS.
  bool must_be_secure() {
    if (stream_.has_tls() || context_.options.insecure || !context_.secrets.get()->tls) return false;
    error_code error;
    const auto peer = tcp().socket().remote_endpoint(error).address();
    return !error && !is_this_machine(peer);
  }

  void make_scene(const std::string& name) {
    // The session goes back with the answer: were a maker's thread the last to hold it, it would end there,
    // beside the network's thread.
    boost::asio::post(context_.makers, [self = shared_from_this(), name]() mutable {
      std::optional<host::NotMade> no;
      try {
        no = self->context_.host.make(name, self->parser_->get().body());
      } catch (const std::exception& error) {  // most likely for want of memory
        no = host::NotMade{host::NotMade::Why::too_costly, error.what(), {}};
      }
      const auto network = self->stream_.get_executor();
      boost::asio::post(network, [self = std::move(self), name, no = std::move(no)] {
        if (!no) spdlog::info("scene {}: made by a client", name);
        self->write(no ? not_made(*no) : plain(http::status::created, "made\n"),
                    !self->parser_->get().keep_alive());
      });
    });
  }

  void write(const Answer& answer, bool last) {
    const HttpRequest& request = parser_->get();
    const bool head = request.method() == http::verb::head;
    content_ = answer.content ? answer.content : std::make_shared<const std::string>();
    response_.emplace(answer.status, 11);
    if (const unsigned status = response_->result_int(); status >= kFirstError)
      context_.host.metrics().refused_request(status);
    response_->set(http::field::server, "weft");
    response_->set(http::field::content_type,
                   beast::string_view(answer.media_type.data(), answer.media_type.size()));
    response_->set(http::field::cache_control, answer.etag.empty() ? "no-store" : "no-cache");
    if (!answer.etag.empty()) response_->set(http::field::etag, answer.etag);
    if (answer.status == http::status::method_not_allowed) response_->set(http::field::allow, "GET, HEAD");
    if (answer.status == http::status::unauthorized)
      response_->set(http::field::www_authenticate, "Bearer realm=\"weft\"");
    if (!answer.location.empty()) response_->set(http::field::location, answer.location);
    if (answer.status == http::status::upgrade_required) {
      response_->set(http::field::upgrade, "websocket");
      response_->set(http::field::sec_websocket_version, kWebsocketVersion);
    }
    if (answer.status == http::status::service_unavailable ||
        answer.status == http::status::too_many_requests)
      response_->set(http::field::retry_after, kRetrySeconds);
    response_->set("X-Content-Type-Options", "nosniff");
    response_->set("Referrer-Policy", "no-referrer");
    response_->set("Content-Security-Policy", kContentPolicy);
    allow_reading_from(view(request[http::field::origin]), view(request[http::field::host]));
    if (answer.status != http::status::not_modified) response_->content_length(content_->size());
    if (!head) response_->body() = {content_->data(), content_->size()};
    response_->keep_alive(!last);
    tcp().expires_after(kResponseTime);
    http::async_write(stream_, *response_, [self = shared_from_this(), last](error_code error, std::size_t) {
      if (error || last) return self->end();
      self->tcp().expires_after(kRequestTime);
      self->read();
    });
  }

  /// A page served elsewhere may ask for the list of scenes, and for meshes.
  void allow_reading_from(std::string_view origin, std::string_view host) {
    if (origin.empty() || !origin_allowed(origin, host, context_.options.allowed_origins)) return;
    response_->set(http::field::access_control_allow_origin,
                   beast::string_view(origin.data(), origin.size()));
    response_->set(http::field::vary, "Origin");
    if (parser_->get().method() != http::verb::options) return;
    response_->set(http::field::access_control_allow_headers, "Authorization, Content-Type");
    response_->set(http::field::access_control_allow_methods, "GET, PUT, DELETE");
  }

  void end() {
    stream_.async_end([self = shared_from_this()](error_code) {});
  }

  Context& context_;
  Berth berth_;
  ConnectionPool::Place place_;
  Transport stream_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  std::shared_ptr<const std::string> content_;  ///< what the response's body points into
  std::optional<http::response<http::span_body<const char>>> response_;
};

namespace {

/// What counts as one peer: an IPv4 address, or the /64 network of an IPv6 address, in which one has as many
/// addresses as one likes.
std::string peer_of(const TcpSocket& socket) {
  namespace ip = boost::asio::ip;
  error_code error;
  const ip::address address = socket.remote_endpoint(error).address();
  if (error) return {};  // it has gone already
  if (address.is_v4()) return address.to_string();
  const ip::address_v6 v6 = address.to_v6();
  if (v6.is_v4_mapped()) return ip::make_address_v4(ip::v4_mapped, v6).to_string();
  ip::address_v6::bytes_type network = v6.to_bytes();
  std::fill(network.begin() + 8, network.end(), std::uint8_t{0});
  return ip::address_v6(network).to_string();
}

}  // namespace

void start_http_session(Context& context, Berth berth, TcpSocket socket) {
  auto place = context.connections.take(peer_of(socket));
  const bool extra = place.refusal() != NoPlace::none;
  NetworkLoop& loop = berth.loop();
  const auto session =
      std::make_shared<HttpSession>(context, std::move(berth), std::move(place), std::move(socket));
  if (extra) {
    auto& slot = loop.extra[loop.next_extra++ % loop.extra.size()];
    if (const auto oldest = slot.lock()) oldest->cut();
    slot = session;
  }
  session->start();
}

}  // namespace weft::net
