#include "net/server.h"

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "net/http_session.h"
#include "net/websocket_session.h"

namespace weft::net {

namespace asio = boost::asio;
using asio::ip::tcp;

namespace {

constexpr auto kFarewellTime = std::chrono::seconds(3);
/// After accept() failed, most often for want of file descriptors.
constexpr auto kAcceptPause = std::chrono::milliseconds(100);

/// Descriptors that are no connection's: standard streams, event loop, listener, files being read.
constexpr std::size_t kOtherDescriptors = 32;

/// `options` with the name it listens at as one of its own, and with no more connections than the process may
/// have descriptors, once it may have as many as it is allowed to ask for.
ServerOptions within_means(ServerOptions options) {
  options.names.push_back(options.host);
  constexpr std::size_t kOthers = kExtraConnections + kOtherDescriptors;
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return options;
  const rlim_t wanted = options.max_connections + kOthers;
  if (limit.rlim_cur < wanted) {
    limit.rlim_cur = std::min(wanted, limit.rlim_max);
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  if (limit.rlim_cur < wanted) {
    options.max_connections = limit.rlim_cur > kOthers ? limit.rlim_cur - kOthers : 1;
    spdlog::warn("at most {} connections: the process may have {} descriptors (ulimit -n)",
                 options.max_connections, limit.rlim_cur);
  }
  return options;
}

/// Both or neither can be used.
std::pair<Access, TlsContext> secrets(const ServerOptions& options) {
  if (options.certificate.empty() != options.key.empty())
    throw std::runtime_error("a certificate and its key belong together: --tls-certificate and --tls-key");
  return {options.tokens.empty() ? Access() : Access::read(options.tokens),
          options.certificate.empty() ? nullptr : server_tls(options.certificate, options.key)};
}

}  // namespace

void check_secrets(const ServerOptions& options) { secrets(options); }

struct Server::Impl {
  Impl(host::Host& host, ServerOptions options) : context(host, within_means(std::move(options))) {}

  void listen();
  void accept();
  void wait_for_signal();
  void read_secrets();
  void stop();

  Context context;
  // Destroyed before the context, with the sessions that its handlers hold and that use it.
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::signal_set signals{io};
  asio::steady_timer pause{io};
};

void Server::Impl::listen() {
  const ServerOptions& options = context.options;
  const std::string where = options.host + ":" + std::to_string(options.port);
  boost::system::error_code error;
  tcp::resolver resolver(io);
  const auto found = resolver.resolve(options.host, std::to_string(options.port),
                                      tcp::resolver::passive | tcp::resolver::numeric_service, error);
  if (error) throw std::runtime_error("cannot listen at " + where + ": " + error.message());
  const tcp::endpoint endpoint = found.begin()->endpoint();
  if (!endpoint.address().is_loopback() && options.tokens.empty() && !options.insecure)
    throw std::runtime_error(
        "will not listen at " + where +
        ", which others reach, where anybody may do anything: give --tokens, or --insecure");
  acceptor.open(endpoint.protocol(), error);
  // So that a server can follow at once on one that just ended.
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) throw std::runtime_error("cannot listen at " + where + ": " + error.message());
}

void Server::Impl::accept() {
  acceptor.async_accept([this](boost::system::error_code error, tcp::socket socket) {
    if (!acceptor.is_open()) return;
    if (error) {
      if (const auto more = context.refusals.admit(std::chrono::steady_clock::now()))
        spdlog::warn("accept: {}{}", error.message(), *more);
      pause.expires_after(kAcceptPause);
      pause.async_wait([this](boost::system::error_code cancelled) {
        if (!cancelled) accept();
      });
      return;
    }
    start_http_session(context, std::move(socket));
    accept();
  });
}

void Server::Impl::wait_for_signal() {
  signals.async_wait([this](boost::system::error_code error, int signal) {
    if (error) return;
    if (signal == SIGHUP) {
      try {
        read_secrets();
        if (!context.options.tokens.empty() || context.tls)
          spdlog::info("signal {}: tokens and certificate read anew", signal);
      } catch (const std::runtime_error& unusable) {
        spdlog::error("signal {}: {}; those of before stay", signal, unusable.what());
      }
      return wait_for_signal();
    }
    if (context.stopping) std::_Exit(128 + signal);
    spdlog::info("signal {}: stopping", signal);
    stop();
    wait_for_signal();
  });
}

void Server::Impl::read_secrets() { std::tie(context.access, context.tls) = secrets(context.options); }

void Server::Impl::stop() {
  if (context.stopping) return;
  context.stopping = true;
  context.on_viewers_gone = [this] { io.stop(); };
  acceptor.close();
  pause.expires_after(kFarewellTime);
  pause.async_wait([this](boost::system::error_code) { io.stop(); });
  if (context.viewers.empty()) return io.stop();
  // A copy: a session that ends takes itself out of the set.
  const std::vector<WebsocketSession*> viewers(context.viewers.begin(), context.viewers.end());
  for (WebsocketSession* viewer : viewers) end_websocket_session(*viewer);
}

Server::Server(host::Host& host, ServerOptions options)
    : impl_(std::make_unique<Impl>(host, std::move(options))) {
  impl_->read_secrets();
  impl_->listen();
  // Before anybody is told the address: from then on a signal must end it in order.
  impl_->signals.add(SIGINT);
  impl_->signals.add(SIGTERM);
  impl_->signals.add(SIGHUP);
  impl_->wait_for_signal();
}

Server::~Server() {
  impl_->context.makers.join();  // it posts to the io_context
  // Scenes still run: they must not post to an io_context that is being destroyed.
  for (WebsocketSession* viewer : impl_->context.viewers) silence_websocket_session(*viewer);
  // The sessions that are destroyed with it must not stop it.
  impl_->context.on_viewers_gone = [] {};
}

std::uint16_t Server::port() const { return impl_->acceptor.local_endpoint().port(); }

std::string Server::address() const {
  const auto address = impl_->acceptor.local_endpoint().address();
  std::string host = address.to_string();
  if (address.is_unspecified()) host = "127.0.0.1";
  if (host.find(':') != std::string::npos) host = "[" + host + "]";
  return (impl_->context.tls ? "https://" : "http://") + host + ":" + std::to_string(port()) + "/";
}

void Server::run() {
  impl_->accept();
  impl_->io.run();
}

void Server::stop() {
  asio::post(impl_->io, [this] { impl_->stop(); });
}

}  // namespace weft::net
