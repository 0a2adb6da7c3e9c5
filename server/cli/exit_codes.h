#pragma once

namespace weft::cli {

// What the subcommands end with when all is not well.
constexpr int kFailed = 1;
constexpr int kBadUsage = 2;
constexpr int kBadState = 3;  ///< of the simulation: a cloth could not be stepped

}  // namespace weft::cli
