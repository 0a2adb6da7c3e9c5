#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_codes.h"
#include "cli/problems.h"
#include "cli/threads.h"
#include "host/host.h"
#include "net/server.h"
#include "scene/scene.h"

namespace weft::cli {
namespace {

namespace fs = std::filesystem;

struct ServeOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> overrides;
  protocol::Limits limits;
  net::ServerOptions server;
  Threads threads;
  bool quiet = false;
};

/// The page beside the executable (build tree) or where it is installed; empty if it is in neither place.
fs::path find_page() {
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& place : {executable / "web", executable.parent_path() / "share" / "weft" / "web"}) {
    if (fs::is_regular_file(place / "index.html", error)) return place;
  }
  return {};
}

/// Those asked for; all presets if none was.
std::vector<std::string> wanted_scenes(const ServeOptions& options) {
  if (!options.scenes.empty()) return options.scenes;
  std::vector<std::string> all;
  for (const scene::Preset& preset : scene::presets()) all.emplace_back(preset.name);
  return all;
}

/// False, with the problems printed, if any scene has some.
bool load_scenes(const ServeOptions& options, host::Host& host) {
  bool good = true;
  for (const std::string& name : wanted_scenes(options)) {
    scene::Result result = scene::load(name, options.overrides);
    if (const auto* problems = std::get_if<std::vector<scene::Problem>>(&result)) {
      print_problems(name, *problems);
      good = false;
    } else {
      host.add(std::move(std::get<scene::Scene>(result)));
    }
  }
  return good;
}

/// For people and scripts. If nobody reads it, or the disk is full, the server serves all the same.
void print_address(const net::Server& server) {
  std::printf("Weft is at %s\n", server.address().c_str());
  if (std::fflush(stdout) != 0) {
    spdlog::warn("standard output: {}", std::strerror(errno));
    std::clearerr(stdout);
  }
}

int serve(ServeOptions options) {
  // A reader of the log that goes away, or a terminal that is closed, does not end what others watch.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGHUP, SIG_IGN);
  // Standard output has the address and nothing else, so that a script can read it.
  spdlog::set_default_logger(spdlog::stderr_color_mt("weft"));
  spdlog::set_pattern("%Y-%m-%dT%H:%M:%S.%e %^%l%$ %v");
  if (options.quiet) spdlog::set_level(spdlog::level::warn);

  const ThreadLimit limit = options.threads.limit();
  host::Host host(options.limits, WEFT_VERSION);
  if (!load_scenes(options, host)) return kFailed;
  if (options.server.web.empty()) options.server.web = find_page();
  options.server.version = WEFT_VERSION;
  net::Server server(host, options.server);
  if (options.server.web.empty())
    spdlog::warn("no page found beside the executable: only scenes are served (--web)");
  spdlog::info("{} scenes, page {}", host.scenes().size(), options.server.web.string());
  print_address(server);
  server.run();
  spdlog::info("stopped");
  return 0;
}

}  // namespace

void add_serve(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ServeOptions>();
  CLI::App* command =
      app.add_subcommand("serve", "Runs scenes in real time for viewers, and serves the page");
  command->add_option("SCENE", options->scenes,
                      "Presets or scene files; the first is shown first (default: all presets)");
  command->add_option("--host", options->server.host, "Address to listen at")->capture_default_str();
  command->add_option("--port", options->server.port, "TCP port; 0 takes a free one")->capture_default_str();
  command
      ->add_option("--web", options->server.web,
                   "The page's directory (default: found beside the executable)")
      ->check(CLI::ExistingDirectory);
  command
      ->add_option("--allow-origin", options->server.allowed_origins,
                   "Origin of pages that may connect besides this server's own and this machine's, as "
                   "https://example.org; * allows all; may be given several times")
      ->allow_extra_args(false);
  command->add_option("--viewers", options->limits.viewers, "Viewers that a scene may have at a time")
      ->capture_default_str()
      ->check(CLI::Range(1, static_cast<int>(options->server.max_connections)));
  command
      ->add_option(
          "--host-name", options->server.names,
          "Name that requests may call this server by (their Host header) besides localhost, --host and "
          "addresses, as weft.example; * allows all; may be given several times")
      ->allow_extra_args(false);
  command
      ->add_option("--connections", options->server.max_connections,
                   "Connections of any kind at a time; more are refused with 503")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command
      ->add_option(
          "--connections-per-address", options->server.max_connections_per_address,
          "Those of one IPv4 address, or one IPv6 /64 network; more are refused with 429. 0: no limit, as "
          "behind a proxy, through which all come from one address")
      ->check(CLI::Range(0, 1'000'000))
      ->capture_default_str();
  command
      ->add_option("--set", options->overrides,
                   "POINTER=VALUE changes a value of every scene, as /wind/speed=8")
      ->allow_extra_args(false);
  command
      ->add_option("--tokens", options->server.tokens,
                   "File of bearer tokens and what each may do: view, control or admin (JSON)")
      ->check(CLI::ExistingFile);
  CLI::Option* certificate =
      command
          ->add_option(
              "--tls-certificate", options->server.certificate,
              "Certificate chain (PEM): https and wss at the same port; without TLS this machine alone is "
              "served")
          ->check(CLI::ExistingFile);
  CLI::Option* key = command->add_option("--tls-key", options->server.key, "Its private key (PEM)")
                         ->check(CLI::ExistingFile)
                         ->needs(certificate);
  certificate->needs(key);
  command->add_flag(
      "--insecure", options->server.insecure,
      "Listens at an address that others reach although there are no --tokens; with a certificate, "
      "serves others without TLS, too");
  options->threads.add_to(*command);
  command->add_flag("--quiet", options->quiet, "Logs warnings and errors only");
  command->callback([options, &exit_code] { exit_code = serve(*options); });
}

}  // namespace weft::cli
