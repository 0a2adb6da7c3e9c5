#pragma once
/// The suite's report. Every run writes its row into a file of its own, so that runs may go on side by side;
/// what is there when they have ended is one table, as CSV, Markdown and text.
#include <filesystem>
#include <string>
#include <vector>

#include "runner.h"

namespace weft::stability {

struct Row {
  std::string name, method, verdict, why;
  int level = 0, hz = 0, guard_events = 0;
  double stretch = 0, stretch_limit = 0, worst_stretch = 0, energy_rise = 0, penetration = 0,
         rest_seconds = 0, milliseconds = 0;
};
Row row_of(const Case& hard_case, const Setup& setup, const Result& result);

/// Writes the row into `folder`, which is made if it is not there.
void keep(const Row& row, const std::filesystem::path& folder);
/// The rows kept in `folder`, by case, method, level and step rate.
std::vector<Row> kept(const std::filesystem::path& folder);

std::string csv(const std::vector<Row>& rows);
/// A line a run, then the verdicts' counts by method.
std::string markdown(const std::vector<Row>& rows);

}  // namespace weft::stability
