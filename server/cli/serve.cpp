#include <memory>
#include <optional>

#include "cli/commands.h"
#include "cli/exit_codes.h"
#include "cli/serve_options.h"
#include "cli/settings.h"
#include "host/data_folder.h"

namespace weft::cli {
namespace {

int serve_scenes(const ServeOptions& options) {
  begin_serving(options);
  const ThreadLimit limit = options.threads.limit();
  std::optional<host::DataFolder> data;
  if (!options.folders.data.empty()) data.emplace(options.folders.data);
  host::Host host(options.limits, WEFT_VERSION, options.making, options.folders);
  if (!load_scenes(options, host)) return kFailed;
  if (data) host.restore_made();
  serve(host, options);
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
    exit_code = serve_scenes(*options);
  });
}

}  // namespace weft::cli
