#include "cli/run/summary.h"

#include <cinttypes>
#include <cstdio>

namespace weft::cli {
namespace {

using nlohmann::ordered_json;

template <class... Values>
void append_line(std::string& text, const char* format, Values... values) {
  const int length = std::snprintf(nullptr, 0, format, values...);
  std::string line(static_cast<std::size_t>(length) + 1, '\0');
  std::snprintf(line.data(), line.size(), format, values...);
  line.back() = '\n';
  text += line;
}

std::string hex(std::uint64_t number) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, number);
  return text;
}

ordered_json cloth_json(const Simulation<float>& simulation, std::size_t index) {
  const Cloth<float>& cloth = simulation.cloths()[index];
  const ClothReport report = simulation.report(index);
  return {{"name", cloth.description().name},
          {"level", report.level},
          {"rows", cloth.particles().grid().rows},
          {"cols", cloth.particles().grid().cols},
          {"substeps", report.substeps},
          {"max_strain", report.strain.max},
          {"max_compression", report.strain.max_compression},
          {"mean_strain", report.strain.mean},
          {"kinetic_energy", report.kinetic_energy},
          {"potential_energy", report.potential_energy},
          {"nodes_in_contact", report.nodes_in_contact},
          {"frozen", cloth.frozen()}};
}

}  // namespace

void StepTimes::add(int frame, double step_seconds) {
  ++steps;
  seconds += step_seconds;
  if (step_seconds > time_step) ++slow;
  if (step_seconds <= longest) return;
  longest = step_seconds;
  longest_frame = frame;
}

std::string RunSummary::text() const {
  std::string text;
  append_line(text, "%s: %d frames, %g s simulated in %.2f s, %.3f ms a frame, longest %.3f ms (frame %d)",
              scene.c_str(), times.steps, times.steps * simulation.description().time_step, times.seconds,
              times.mean_ms(), times.longest_ms(), times.longest_frame);
  if (times.slow > 0)
    append_line(text, "%d of %d frames took longer than real time, %.3f ms", times.slow, times.steps,
                1e3 * times.time_step);
  for (std::size_t i = 0; i < simulation.cloths().size(); ++i) {
    const ClothReport report = simulation.report(i);
    const Grid& grid = simulation.cloths()[i].particles().grid();
    append_line(
        text,
        "%s: level %d, %d x %d nodes, %d substeps a frame, stretched by %.2g %% and compressed by %.2g %% at "
        "most",
        simulation.cloths()[i].description().name.c_str(), report.level, grid.cols, grid.rows,
        report.substeps, 100 * report.strain.max, 100 * report.strain.max_compression);
  }
  if (hash) append_line(text, "%s", hex(*hash).c_str());
  return text;
}

ordered_json RunSummary::json() const {
  const auto counts = guard.counts();
  ordered_json told{{"scene", scene},
                    {"weft", WEFT_VERSION},
                    {"frames", times.steps},
                    {"time_step", simulation.description().time_step},
                    {"time", simulation.time()},
                    {"seconds", times.seconds},
                    {"mean_ms", times.mean_ms()},
                    {"longest_ms", times.longest_ms()},
                    {"longest_frame", times.longest_frame},
                    {"slow_frames", times.slow},
                    {"cloths", ordered_json::array()},
                    {"guard",
                     {{"redone", counts.redone},
                      {"frozen", counts.frozen},
                      {"balls_stopped", counts.balls_stopped},
                      {"crowded", counts.crowded}}},
                    {"files", files}};
  for (std::size_t i = 0; i < simulation.cloths().size(); ++i)
    told["cloths"].push_back(cloth_json(simulation, i));
  if (hash) told["hash"] = hex(*hash);
  return told;
}

}  // namespace weft::cli
