#include "table.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <tuple>

namespace weft::stability {
namespace {

constexpr const char* kHeader =
    "case,method,level,hz,verdict,stretch,stretch_limit,worst_stretch,energy,penetration_m,guard_events,rest_"
    "s,"
    "ms_per_frame,why\n";

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

std::string line(const Row& row) {
  std::ostringstream out;
  out << row.name << ',' << row.method << ',' << row.level << ',' << row.hz << ',' << row.verdict << ','
      << row.stretch << ',' << row.stretch_limit << ',' << row.worst_stretch << ',' << row.energy_rise << ','
      << row.penetration << ',' << row.guard_events << ',' << row.rest_seconds << ',' << row.milliseconds
      << ",\"" << row.why << "\"\n";
  return out.str();
}

/// The row that line() wrote.
Row read_line(const std::string& text) {
  std::istringstream in(text);
  std::array<std::string, 13> fields;
  for (std::string& field : fields) std::getline(in, field, ',');
  std::string why;
  std::getline(in, why);
  const auto number = [&](std::size_t i) { return std::strtod(fields[i].c_str(), nullptr); };
  Row row{fields[0], fields[1], fields[4], why.substr(1, why.size() - 2)};
  row.level = static_cast<int>(number(2));
  row.hz = static_cast<int>(number(3));
  row.stretch = number(5);
  row.stretch_limit = number(6);
  row.worst_stretch = number(7);
  row.energy_rise = number(8);
  row.penetration = number(9);
  row.guard_events = static_cast<int>(number(10));
  row.rest_seconds = number(11);
  row.milliseconds = number(12);
  return row;
}

/// S2 before S10.
std::tuple<long, std::string, std::string, int, int> order(const Row& row) {
  return {std::strtol(row.name.c_str() + 1, nullptr, 10), row.name, row.method, row.level, -row.hz};
}

}  // namespace

Row row_of(const Case& hard_case, const Setup& setup, const Result& result) {
  Row row{hard_case.name, name_of(setup.method), name_of(result.verdict), {}, setup.level, setup.hz};
  for (const std::string& complaint : result.complaints) row.why += (row.why.empty() ? "" : "; ") + complaint;
  row.stretch = result.stretch;
  row.stretch_limit = result.stretch_limit;
  row.worst_stretch = result.worst_stretch;
  row.energy_rise = result.energy_rise;
  row.penetration = result.penetration;
  row.guard_events = result.guard_events;
  row.rest_seconds = result.rest_seconds;
  row.milliseconds = result.milliseconds;
  return row;
}

void keep(const Row& row, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const std::string name =
      row.name + "-" + row.method + "-" + std::to_string(row.level) + "-" + std::to_string(row.hz);
  std::ofstream(folder / (name + ".csv")) << line(row);
}

std::vector<Row> kept(const std::filesystem::path& folder) {
  std::vector<Row> rows;
  if (!std::filesystem::is_directory(folder)) return rows;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream in(entry.path());
    std::string text;
    if (std::getline(in, text)) rows.push_back(read_line(text));
  }
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return order(a) < order(b); });
  return rows;
}

std::string csv(const std::vector<Row>& rows) {
  std::string text = kHeader;
  for (const Row& row : rows) text += line(row);
  return text;
}

std::string markdown(const std::vector<Row>& rows) {
  std::ostringstream out;
  out << "Stretch: largest of a structural spring, from the time on that the case states; limit: what the "
         "case "
         "allows it to be; worst: largest of all steps. A run that stretches holds all but that limit, which "
         "XPBD "
         "does not claim there; of one that is pierced a solid thinner than a cell is drawn wide holds it "
         "open. Energy: largest rise above the start's, as a share of what the case allows. "
         "Guard: how often the step guard stepped in. Rest: s from the last event on until it slept.\n\n"
         "| case | method | level | Hz | verdict | stretch | limit | worst | energy | penetration, m | guard "
         "| "
         "rest, s | ms a frame | why |\n"
         "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::map<std::string, std::map<std::string, int>> counts;
  for (const Row& row : rows) {
    out << "| " << row.name << " | " << row.method << " | " << row.level << " | " << row.hz << " | "
        << row.verdict << " | " << short_number(row.stretch) << " | " << short_number(row.stretch_limit)
        << " | " << short_number(row.worst_stretch) << " | " << short_number(row.energy_rise) << " | "
        << short_number(row.penetration) << " | " << row.guard_events << " | "
        << short_number(row.rest_seconds) << " | " << short_number(row.milliseconds) << " | " << row.why
        << " |\n";
    ++counts[row.method][row.verdict];
  }
  out << "\n| method | pass | stretches | pierced | limit | fail |\n|---|---|---|---|---|---|\n";
  for (auto& [method, verdicts] : counts) {
    out << "| " << method << " | " << verdicts["pass"] << " | " << verdicts["stretches"] << " | "
        << verdicts["pierced"] << " | " << verdicts["limit"] << " | " << verdicts["fail"] << " |\n";
  }
  return out.str();
}

}  // namespace weft::stability
