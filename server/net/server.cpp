#include "net/server.h"

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>
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
  // Event loops have three descriptors each.
  const std::size_t others =
      (kExtraConnections + 3) * static_cast<std::size_t>(std::max(1, options.network_threads)) +
      kOtherDescriptors;
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return options;
  const rlim_t wanted = options.max_connections + others;
  if (limit.rlim_cur < wanted) {
    limit.rlim_cur = std::min(wanted, limit.rlim_max);
    setrlimit(RLIMIT_NOFILE, &limit);
  }
  if (limit.rlim_cur < wanted) {
    options.max_connections = limit.rlim_cur > others ? limit.rlim_cur - others : 1;
    spdlog::warn("at most {} connections: the process may have {} descriptors (ulimit -n)",
                 options.max_connections, limit.rlim_cur);
  }
  return options;
}

/// Both or neither can be used.
Secrets read_secrets(const ServerOptions& options) {
  if (options.certificate.empty() != options.key.empty())
    throw std::runtime_error("a certificate and its key belong together: --tls-certificate and --tls-key");
  return {options.tokens.empty() ? Access() : Access::read(options.tokens),
          options.certificate.empty() ? nullptr : server_tls(options.certificate, options.key)};
}

}  // namespace

void check_secrets(const ServerOptions& options) { read_secrets(options); }

/// All but what is said otherwise on the first loop's thread.
struct Server::Impl {
  Impl(host::Host& host, ServerOptions options) : context(host, within_means(std::move(options))) {}

  void listen();
  void accept();
  void serve(TcpSocket socket, Berth berth);
  NetworkLoop& least_taken();
  void wait_for_signal();
  void read_secrets_anew();
  void stop();
  void end_if_all_gone();
  void end();

  Context context;
  asio::io_context& io = context.loops.front()->io();
  // Destroyed before the context, whose loops they are on.
  tcp::acceptor acceptor{io};
  asio::signal_set signals{io};
  asio::steady_timer pause{io};
  std::size_t told = 0;  ///< loops whose viewers know that the server stops
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

NetworkLoop& Server::Impl::least_taken() {
  return **std::min_element(
      context.loops.begin(), context.loops.end(),
      [](const auto& one, const auto& other) { return one->connections() < other->connections(); });
}

void Server::Impl::accept() {
  auto berth = std::make_shared<Berth>(least_taken());
  acceptor.async_accept(berth->loop().io().get_executor(),
                        [this, berth](boost::system::error_code error, TcpSocket socket) {
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
                          serve(std::move(socket), std::move(*berth));
                          accept();
                        });
}

/// On the thread of its loop, at once if that is this one.
void Server::Impl::serve(TcpSocket socket, Berth berth) {
  asio::io_context& loop = berth.loop().io();
  asio::dispatch(loop, [this, socket = std::move(socket), berth = std::move(berth)]() mutable {
    start_http_session(context, std::move(berth), std::move(socket));
  });
}

void Server::Impl::wait_for_signal() {
  signals.async_wait([this](boost::system::error_code error, int signal) {
    if (error) return;
    if (signal == SIGHUP) {
      try {
        read_secrets_anew();
        if (!context.options.tokens.empty() || !context.options.certificate.empty())
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

void Server::Impl::read_secrets_anew() { context.secrets.set(read_secrets(context.options)); }

void Server::Impl::stop() {
  if (context.stopping.exchange(true)) return;
  acceptor.close();
  pause.expires_after(kFarewellTime);
  pause.async_wait([this](boost::system::error_code) { end(); });
  // Who comes to a loop after this finds that the server stops.
  for (const auto& loop : context.loops) {
    asio::post(loop->io(), [this, &loop = *loop] {
      end_websocket_sessions(loop);
      asio::post(io, [this] {
        ++told;
        end_if_all_gone();
      });
    });
  }
}

void Server::Impl::end_if_all_gone() {
  if (told == context.loops.size() && context.viewers == 0) end();
}

void Server::Impl::end() {
  for (const auto& loop : context.loops) loop->io().stop();
}

Server::Server(host::Host& host, ServerOptions options)
    : impl_(std::make_unique<Impl>(host, std::move(options))) {
  impl_->read_secrets_anew();
  impl_->listen();
  impl_->context.on_viewers_gone = [impl = impl_.get()] {
    asio::post(impl->io, [impl] { impl->end_if_all_gone(); });
  };
  // Before anybody is told the address: from then on a signal must end it in order.
  impl_->signals.add(SIGINT);
  impl_->signals.add(SIGTERM);
  impl_->signals.add(SIGHUP);
  impl_->wait_for_signal();
}

Server::~Server() {
  impl_->context.makers.join();  // it posts to the loops
  // Scenes still run: they must not wake sessions of loops that are being destroyed.
  for (const auto& loop : impl_->context.loops) {
    for (WebsocketSession* viewer : loop->viewers) silence_websocket_session(*viewer);
  }
  // The sessions that are destroyed with them must not stop it.
  impl_->context.on_viewers_gone = [] {};
}

std::uint16_t Server::port() const { return impl_->acceptor.local_endpoint().port(); }

std::string Server::address() const {
  const auto address = impl_->acceptor.local_endpoint().address();
  std::string host = address.to_string();
  if (address.is_unspecified()) host = "127.0.0.1";
  if (host.find(':') != std::string::npos) host = "[" + host + "]";
  return (impl_->context.secrets.get()->tls ? "https://" : "http://") + host + ":" + std::to_string(port()) +
         "/";
}

void Server::run() {
  impl_->accept();
  const auto& loops = impl_->context.loops;
  std::vector<std::jthread> others;
  // Without one of its own a loop that has nothing to do ends.
  std::vector<asio::executor_work_guard<Executor>> work;
  for (std::size_t i = 1; i < loops.size(); ++i) {
    work.emplace_back(loops[i]->io().get_executor());
    others.emplace_back([&loop = *loops[i]] { loop.run(); });
  }
  // However the first one ends, the others do before they are waited for.
  struct EndOfAll {
    Impl& impl;
    ~EndOfAll() { impl.end(); }
  };
  const EndOfAll all{*impl_};
  loops.front()->run();
}

void Server::stop() {
  asio::post(impl_->io, [this] { impl_->stop(); });
}

}  // namespace weft::net
