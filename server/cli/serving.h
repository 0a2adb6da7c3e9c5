#pragma once
/// How scenes are served, whatever they are.
#include <CLI/CLI.hpp>
#include <string>

#include "host/host.h"
#include "net/server.h"

namespace weft::cli {

struct ServingOptions {
  protocol::Limits limits;
  net::ServerOptions server;
  std::string log = "text";
  bool quiet = false;

  /// Address, page, who may connect, and the log. `this` must outlive the command.
  void add_to(CLI::App& command);
};

/// Signals and log as a server has them. Standard output has the address and nothing else, so that a script
/// can read it.
void begin_serving(const ServingOptions& options);
/// Serves the host's scenes and the page until the server is stopped.
void serve(host::Host& host, const ServingOptions& options);

}  // namespace weft::cli
