#include <cstdio>
#include <exception>

#include "cli/commands.h"
#include "cli/exit_codes.h"

int main(int argc, char** argv) {
  CLI::App app{"Weft: cloth simulation with view-dependent detail", "weft"};
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::help);
  int exit_code = 0;
  weft::cli::add_serve(app, exit_code);
  weft::cli::add_run(app, exit_code);
  weft::cli::add_cost(app, exit_code);
  weft::cli::add_check(app, exit_code);
  weft::cli::add_client(app, exit_code);
  weft::cli::add_version(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : weft::cli::kBadUsage;  // 0: help was asked for
  } catch (const std::exception& error) {
    std::fprintf(stderr, "weft: %s\n", error.what());
    return weft::cli::kFailed;
  }
  return exit_code;
}
