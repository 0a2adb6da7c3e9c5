#include <spdlog/spdlog.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_codes.h"
#include "cli/log.h"
#include "cli/serve_options.h"
#include "cli/settings.h"
#include "host/data_folder.h"

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

int serve(ServeOptions options) {
  // A reader of the log that goes away, or a terminal that is closed, does not end what others watch.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGHUP, SIG_IGN);
  // Standard output has the address and nothing else, so that a script can read it.
  begin_log(options.log, options.quiet);

  const ThreadLimit limit = options.threads.limit();
  std::optional<host::DataFolder> data;
  if (!options.folders.data.empty()) data.emplace(options.folders.data);
  host::Host host(options.limits, WEFT_VERSION, options.making, options.folders);
  if (!load_scenes(options, host)) return kFailed;
  if (data) host.restore_made();
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
  options->add_to(*command);
  command->callback([options, command, &exit_code] {
    complete_settings(*command, options->config);
    exit_code = serve(*options);
  });
}

}  // namespace weft::cli
