#include <cstdio>
#include <memory>

#include "cli/commands.h"
#include "cli/exit_codes.h"
#include "cli/serve_options.h"
#include "cli/settings.h"
#include "host/host.h"

namespace weft::cli {
namespace {

/// Whether `weft serve` would start, if it may listen where it is told to. What is wrong is printed, or
/// thrown.
int check(const ServeOptions& options) {
  host::Host host(options.limits);
  if (!load_scenes(options, host)) return kFailed;
  net::check_secrets(options.server);
  std::puts("ok");
  return 0;
}

/// `weft config NAME`, with the options of `weft serve`.
template <class Action>
void add_action(CLI::App& config, const char* name, const char* what, const Action& action) {
  auto options = std::make_shared<ServeOptions>();
  CLI::App* command = config.add_subcommand(name, what);
  options->add_to(*command);
  command->callback(
      [options, command, action] { action(*options, complete_settings(*command, options->config)); });
}

}  // namespace

void add_config(CLI::App& app, int& exit_code) {
  CLI::App* config =
      app.add_subcommand("config", "Tells with which options `weft serve` would run, or whether it would");
  config->require_subcommand(1);
  add_action(*config, "print", "Each option with its value, and where that comes from; a file for --config",
             [](const ServeOptions&, const std::vector<Setting>& settings) {
               std::printf("%s", to_text(settings).c_str());
             });
  add_action(
      *config, "check", "Reads what is named: scenes, tokens, certificate",
      [&exit_code](const ServeOptions& options, const std::vector<Setting>&) { exit_code = check(options); });
}

}  // namespace weft::cli
