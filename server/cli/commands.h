#pragma once
#include <CLI/CLI.hpp>

namespace weft::cli {

// Each adds its subcommand, with options and callback, to `app`. A callback returns by setting `exit_code`.
void add_serve(CLI::App& app, int& exit_code);
void add_run(CLI::App& app, int& exit_code);
void add_cost(CLI::App& app, int& exit_code);
void add_fabric(CLI::App& app, int& exit_code);
void add_bench(CLI::App& app, int& exit_code);
void add_replay(CLI::App& app, int& exit_code);
void add_check(CLI::App& app, int& exit_code);
void add_skeleton(CLI::App& app, int& exit_code);
void add_client(CLI::App& app, int& exit_code);
void add_config(CLI::App& app, int& exit_code);
void add_version(CLI::App& app, int& exit_code);

}  // namespace weft::cli
