#pragma once
/// The server's log, on standard error.
#include <string>

namespace weft::cli {

/// `format`: "text", a line for people, or "json", an object a line with `time` (ISO 8601), `level` and
/// `message`. `quiet`: warnings and errors alone.
void begin_log(const std::string& format, bool quiet);

}  // namespace weft::cli
