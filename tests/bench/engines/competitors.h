#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engines/measure.h"

namespace weft::bench {

/// An engine with its settings, one row of each table.
struct Competitor {
  std::string engine, setting;
  double structural = 0;  ///< N/m; 0: the engine was asked for a sheet that does not stretch
  std::function<std::unique_ptr<Engine>(const EngineScene&)> make;
};

/// All of them, in the tables' order.
std::vector<Competitor> competitors();

inline constexpr double kStiff =
    50'000;  ///< N/m, the sheet that the engines' inextensible one is compared with
inline constexpr double kStiffest =
    500'000;                            ///< N/m, where others leave less strain than the stiff sheet has
inline constexpr double kSoft = 5'000;  ///< N/m, Weft's default

/// bdf2 in double with this many substeps, Newton's method and the linear solver carried to convergence.
std::unique_ptr<Engine> make_reference(const EngineScene& scene, int substeps);

}  // namespace weft::bench
