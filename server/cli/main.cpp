#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>

#include "cli/commands.h"
#include "cli/exit_codes.h"
#include "cli/settings.h"
#include "cli/suggestion.h"

namespace {

/// What `code` becomes once all of standard output is written: a result that could not be told is none.
int with_output_written(int code) {
  errno = 0;
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return code;
  std::fprintf(stderr, "weft: standard output: writing failed%s%s\n", errno != 0 ? ": " : "",
               errno != 0 ? std::strerror(errno) : "");
  return code != 0 ? code : weft::cli::kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Weft: cloth simulation with view-dependent detail", "weft"};
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::help);
  int exit_code = 0;
  weft::cli::add_serve(app, exit_code);
  weft::cli::add_run(app, exit_code);
  weft::cli::add_cost(app, exit_code);
  weft::cli::add_fabric(app, exit_code);
  weft::cli::add_check(app, exit_code);
  weft::cli::add_skeleton(app, exit_code);
  weft::cli::add_client(app, exit_code);
  weft::cli::add_bench(app, exit_code);
  weft::cli::add_replay(app, exit_code);
  weft::cli::add_config(app, exit_code);
  weft::cli::add_version(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // 0: help was asked for
    if (app.exit(error) == 0) return with_output_written(0);
    std::fputs(weft::cli::suggestion(app).c_str(), stderr);
    return with_output_written(weft::cli::kBadUsage);
  } catch (const weft::cli::BadSetting& error) {
    std::fprintf(stderr, "weft: %s\n", error.what());
    return weft::cli::kBadUsage;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "weft: %s\n", error.what());
    return weft::cli::kFailed;
  }
  return with_output_written(exit_code);
}
