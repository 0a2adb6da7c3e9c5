#pragma once
#include <CLI/CLI.hpp>
#include <optional>

#include "cloth/core/parallel.h"

namespace weft::cli {

/// --threads; without it as many as the machine has.
class Threads {
 public:
  void add_to(CLI::App& command) {
    constexpr int kMost = 1024;
    command
        .add_option(
            "--threads", asked_,
            "Threads that simulate at a time; results do not depend on it (default: all of this machine)")
        ->check(CLI::Range(1, kMost));
  }
  /// To be held while simulating.
  ThreadLimit limit() const { return ThreadLimit(asked_.value_or(hardware_threads())); }

 private:
  std::optional<int> asked_;
};

}  // namespace weft::cli
