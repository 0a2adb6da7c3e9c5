#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <utility>
#include <variant>

#include "net/context.h"
#include "net/http_session.h"
#include "targets.h"

namespace weft::fuzz {
namespace {

using namespace std::chrono_literals;

constexpr auto kLongest = 10s;
constexpr const char* kScene = R"({
  "cloths": [{ "size": [1, 1], "levels": { "min": 3, "max": 3 }, "pins": [{ "u": 0, "v": 0 }] }],
  "effects": [{ "type": "gravity" }, { "type": "damping" }]
})";

/// So high that nothing waits, and so low that what is asked takes milliseconds.
protocol::Limits message_limits() {
  protocol::Limits limits;
  limits.messages_per_second = 1000;
  limits.balls = limits.grabs = 4;
  return limits;
}
host::MakingLimits making_limits() {
  host::MakingLimits limits;
  limits.nodes = 300;
  limits.colliders = 4;
  limits.work = 1e5;
  return limits;
}

/// The client's end of a connection, which is a pair of sockets and no network.
class Client {
 public:
  explicit Client(int socket) : socket_(socket) { ::fcntl(socket_, F_SETFL, O_NONBLOCK); }
  ~Client() { ::close(socket_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Those that find room now; how many.
  std::size_t send(Input bytes) {
    const auto sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    return sent > 0 ? static_cast<std::size_t>(sent) : 0;
  }
  /// Nothing more is sent.
  void end() { ::shutdown(socket_, SHUT_WR); }
  /// Takes what has come.
  void take() {
    std::array<char, 65536> bytes;
    while (::recv(socket_, bytes.data(), bytes.size(), 0) > 0) continue;
  }

 private:
  int socket_;
};

/// The first request's head, which the server answers before a client may go on to speak WebSocket.
Input head_of(Input input) {
  constexpr std::array<std::uint8_t, 4> kEnd{'\r', '\n', '\r', '\n'};
  const auto end = std::search(input.begin(), input.end(), kEnd.begin(), kEnd.end());
  return end == input.end() ? input
                            : input.first(static_cast<std::size_t>(end - input.begin()) + kEnd.size());
}

void run_until_idle(boost::asio::io_context& io) {
  do io.restart();
  while (io.poll() > 0);
  io.restart();
}

}  // namespace

// Whatever is sent, the connection ends soon after its client.
void connection(Input input) {
  spdlog::set_level(spdlog::level::off);
  host::Host host(message_limits(), "", making_limits());
  host.add(std::get<scene::Scene>(scene::parse(kScene, "fuzz")));
  net::ServerOptions options;
  options.version = "0";
  net::Context context(host, options);
  net::NetworkLoop& loop = *context.loops.front();
  boost::asio::io_context& io = loop.io();
  std::array<int, 2> ends{};
  require(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) == 0, "there are sockets");
  Client client(ends[0]);
  net::TcpSocket socket(io);
  socket.assign(boost::asio::ip::tcp::v4(), ends[1]);
  net::start_http_session(context, net::Berth(loop), std::move(socket));

  const Input head = head_of(input);
  Input rest = input.subspan(head.size());
  client.send(head);
  run_until_idle(io);
  bool ended = false;
  const auto deadline = std::chrono::steady_clock::now() + kLongest;
  while (context.connections.taken() > 0) {
    require(std::chrono::steady_clock::now() < deadline, "a connection ends soon after its client");
    client.take();
    rest = rest.subspan(client.send(rest));
    if (rest.empty() && !ended) {
      client.end();
      ended = true;
    }
    run_until_idle(io);
    io.run_one_for(1ms);
  }
  require(loop.connections() == 0, "the loop has as many connections as there are");
  context.makers.join();
}

}  // namespace weft::fuzz
