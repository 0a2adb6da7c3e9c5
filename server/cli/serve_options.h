#pragma once
/// The options of `weft serve`, which `weft config` reads, too.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/serving.h"
#include "cli/threads.h"
#include "host/host.h"

namespace weft::cli {

struct ServeOptions : ServingOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> overrides;
  std::vector<int> split;  ///< levels at which each scene is served once more
  host::MakingLimits making;
  host::LogFolders folders;
  Threads threads;
  std::filesystem::path config;

  /// `this` must outlive the command.
  void add_to(CLI::App& command);
};

/// Loads the scenes asked for, or all presets, into `host`. False, with the problems printed, if any has
/// some.
bool load_scenes(const ServeOptions& options, host::Host& host);

}  // namespace weft::cli
