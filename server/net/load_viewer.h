#pragma once
/// One of the viewers that load() makes; for net's .cpp files only.
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
// Boost 1.74 needs <utility> before it.
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include "net/client.h"
#include "net/client_socket.h"
#include "protocol/message.h"

namespace weft::net {

/// What all viewers count in.
struct LoadTally {
  bool measuring = false;
  int joined = 0, settled = 0;  ///< settled: joined, or given up
  std::uint64_t frames = 0, bytes = 0;
  std::vector<double> ages;  ///< ms
  std::vector<std::string> failures;
};

/// Joins, tells its distance, acknowledges each frame when it would have shown it.
class LoadViewer : public std::enable_shared_from_this<LoadViewer> {
 public:
  /// To connect, and from then on to join.
  static constexpr auto kJoinTime = std::chrono::seconds(30);

  /// Where it is, m, and how many frames a second it takes; one only if `slow`.
  struct Manner {
    double distance = 0, rate = 0;
    bool slow = false;
  };

  /// With `tls` where the URL asks for it. All that is passed by reference must outlive it.
  LoadViewer(boost::asio::io_context& io, const Url& url, const ClientSecurity& security, TlsContext tls,
             const Manner& manner, LoadTally& tally);

  void join(const boost::asio::ip::tcp::resolver::results_type& where);
  void leave();

  bool slow() const { return manner_.slow; }
  bool joined() const { return joined_; }
  /// That came while it was measured.
  std::uint64_t frames() const { return frames_; }

 private:
  using error_code = boost::beast::error_code;

  void greet();
  /// Asks for no reply: as clients send what they send most.
  void say(const protocol::Command& command);
  void write();
  void read();
  void take(std::span<const std::uint8_t> bytes);
  /// It takes each frame as it comes.
  bool takes_all() const;
  double next_due() const { return takes_all() ? 0 : due_ms_ + 1e3 / manner_.rate; }
  void take_text(std::string_view text);
  void fail(const char* doing, error_code error);

  ClientSocket socket_;
  SteadyTimer pause_;
  const Manner manner_;
  LoadTally& tally_;
  std::deque<std::string> queue_;  ///< of what is being sent the first; one that is pushed moves none
  std::uint64_t frames_ = 0;
  std::uint32_t shown_ = 0;
  double asked_ms_ = 0, due_ms_ = 0;
  std::optional<double> clock_offset_;  ///< of the server's clock to this one's, ms
  bool joined_ = false, waits_ = false, leaving_ = false;
};

}  // namespace weft::net
