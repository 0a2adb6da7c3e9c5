#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace weft::cli {

/// For a command line that was not understood: `weft: --frame is unknown; did you mean "--frames"?` and a
/// line's end, of the first word that is near a command or an option of the command; empty if none is.
std::string suggestion(const CLI::App& app);

}  // namespace weft::cli
