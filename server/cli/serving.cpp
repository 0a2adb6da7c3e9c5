#include "cli/serving.h"

#include <spdlog/spdlog.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "cli/log.h"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

/// The page beside the executable (build tree) or where it is installed; empty if it is in neither place.
fs::path find_page() {
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& place : {executable / "web", executable.parent_path() / "share" / "weft" / "web"}) {
    if (fs::is_regular_file(place / "index.html", error)) return place;
  }
  return {};
}

/// For people and scripts. If nobody reads it, or the disk is full, the server serves all the same.
void print_address(const net::Server& server) {
  std::printf("Weft is at %s\n", server.address().c_str());
  if (std::fflush(stdout) != 0) {
    spdlog::warn("standard output: {}", std::strerror(errno));
    std::clearerr(stdout);
  }
}

}  // namespace

void ServingOptions::add_to(CLI::App& command) {
  command.add_option("--host", server.host, "Address to listen at")->capture_default_str();
  command.add_option("--port", server.port, "TCP port; 0 takes a free one")->capture_default_str();
  command.add_option("--web", server.web, "The page's directory (default: found beside the executable)")
      ->check(CLI::ExistingDirectory);
  command
      .add_option("--allow-origin", server.allowed_origins,
                  "Origin of pages that may connect besides this server's own and this machine's, as "
                  "https://example.org; * allows all; may be given several times")
      ->allow_extra_args(false);
  command.add_option("--viewers", limits.viewers, "Viewers that a scene may have at a time")
      ->capture_default_str()
      ->check(CLI::Range(1, static_cast<int>(server.max_connections)));
  command
      .add_option(
          "--host-name", server.names,
          "Name that requests may call this server by (their Host header) besides localhost, --host and "
          "addresses, as weft.example; * allows all; may be given several times")
      ->allow_extra_args(false);
  command
      .add_option("--connections", server.max_connections,
                  "Connections of any kind at a time; more are refused with 503")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command
      .add_option(
          "--connections-per-address", server.max_connections_per_address,
          "Those of one IPv4 address, or one IPv6 /64 network; more are refused with 429. 0: no limit, as "
          "behind a proxy, through which all come from one address")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  constexpr int kMostNetworkThreads = 64;
  command
      .add_option("--network-threads", server.network_threads,
                  "Threads that connections are spread among: one more where "
                  "weft_network_cpu_seconds_total says that one is full")
      ->check(CLI::Range(1, kMostNetworkThreads))
      ->capture_default_str();
  command
      .add_option("--tokens", server.tokens,
                  "File of bearer tokens and what each may do: view, control or admin (JSON)")
      ->check(CLI::ExistingFile);
  command
      .add_option(
          "--tls-certificate", server.certificate,
          "Certificate chain (PEM): https and wss at the same port; without TLS this machine alone is "
          "served")
      ->check(CLI::ExistingFile);
  command.add_option("--tls-key", server.key, "Its private key (PEM)")->check(CLI::ExistingFile);
  command.add_flag(
      "--insecure", server.insecure,
      "Listens at an address that others reach although there are no --tokens; with a certificate, "
      "serves others without TLS, too");
  command.add_option("--log", log, "Form of the log: text or json, an object a line")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
  command.add_flag("--quiet", quiet, "Logs warnings and errors only");
}

void begin_serving(const ServingOptions& options) {
  // A reader of the log that goes away, or a terminal that is closed, does not end what others watch.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGHUP, SIG_IGN);
  begin_log(options.log, options.quiet);
}

void serve(host::Host& host, const ServingOptions& options) {
  net::ServerOptions with_page = options.server;
  if (with_page.web.empty()) with_page.web = find_page();
  with_page.version = WEFT_VERSION;
  net::Server server(host, with_page);
  if (with_page.web.empty())
    spdlog::warn("no page found beside the executable: only scenes are served (--web)");
  spdlog::info("{} scenes, page {}", host.scenes().size(), with_page.web.string());
  print_address(server);
  server.run();
  spdlog::info("stopped");
}

}  // namespace weft::cli
