#include <cstdio>

#include "cli/commands.h"
#include "protocol/message.h"

namespace weft::cli {

void add_version(CLI::App& app, int& exit_code) {
  app.add_subcommand("version", "Prints the version")->callback([&exit_code] {
    std::printf("weft %s, protocol %s\n", WEFT_VERSION, protocol::kSubprotocol);
    exit_code = 0;
  });
}

}  // namespace weft::cli
