#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "host/host.h"

namespace weft::net {

struct ServerOptions {
  std::string host = "127.0.0.1";  ///< address or name to listen at
  std::uint16_t port = 8080;       ///< 0: any free one
  std::filesystem::path web;       ///< the page's directory; empty: no page
  std::vector<std::string> allowed_origins;
  /// Names that a request may call this server by, besides localhost, `host` and addresses.
  std::vector<std::string> names;
  std::string version;                 ///< told in `welcome`: "0.1.0"
  std::size_t max_connections = 4096;  ///< of any kind; more are refused
  /// Of one address, or of one /64 network of IPv6; more are refused. 0: no limit.
  std::size_t max_connections_per_address = 128;
  /// Who may do what (Access); empty: everybody everything.
  std::filesystem::path tokens;
  /// The certificate chain and its key (PEM); both or neither. With them, TLS is spoken at the same port, and
  /// without it only with this machine.
  std::filesystem::path certificate, key;
  int network_threads = 1;  ///< among which connections are spread
  /// Listens to the network without tokens, and speaks to it without TLS where there is a certificate.
  bool insecure = false;
};

/// Reads tokens, certificate and key. Throws std::runtime_error, naming the file, if they cannot be used.
void check_secrets(const ServerOptions& options);

/// PROTOCOL.md on one TCP port: the page, the health check, the list of scenes, and the scenes' WebSockets.
class Server {
 public:
  /// Listens. Throws std::runtime_error, naming address and port, if it cannot, or must not: at an address
  /// that others reach, without tokens and not told `insecure`; or naming the file of tokens, the certificate
  /// or the key.
  Server(host::Host& host, ServerOptions options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::uint16_t port() const;
  /// Where the page is, for people on this machine: "http://127.0.0.1:8080/", "https:" with a certificate.
  std::string address() const;

  /// Serves, on the calling thread and ServerOptions::network_threads - 1 more, until stop() or SIGTERM or
  /// SIGINT. Viewers are told and have 3 seconds to go. A second signal ends the process at once. SIGHUP
  /// reads tokens and certificate anew, for connections that come after it; where one cannot be used, those
  /// of before stay.
  void run();
  /// May be called from any thread.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft::net
