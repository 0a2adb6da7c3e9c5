#include <nlohmann/json.hpp>

#include "study/report.h"
#include "study/report_page.h"

namespace weft::study {
namespace {

using nlohmann::json;

json json_of(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }

json json_of(const Errors& errors) {
  return {{"rms", errors.rms_position},       {"max", errors.max_position},
          {"shape", errors.mean_shape},       {"strain", errors.strain},
          {"energy", json_of(errors.energy)}, {"frequency", json_of(errors.frequency)}};
}

json json_of(const Run& run) {
  const bool done = run.status == Run::Status::done;
  json all = {{"integrator", name_of(run.candidate.integrator)},
              {"setting", setting_of(run.candidate.integrator)},
              {"present", run.candidate.present},
              {"status", name_of(run.status)},
              {"done", done}};
  if (!done) return all;
  all["best"] = run.best;
  all["ms"] = run.milliseconds;
  all["substeps"] = run.substeps;
  all["max_strain"] = run.max_strain;
  all["max_compression"] = run.max_compression;
  all["time"] = json_of(run.time);
  all["total"] = json_of(run.total);
  return all;
}

json json_of(const Study& study, const LevelStudy& level) {
  json all = {{"level", level.level}, {"trust", trust(study, level)}, {"runs", json::array()}};
  for (const Run& run : level.runs) all["runs"].push_back(json_of(run));
  if (!level.reference.usable()) return all;
  all["change"] = json_of(level.reference.change());
  all["rounding"] = json_of(level.reference.rounding);
  all["space"] = json_of(level.space);
  return all;
}

}  // namespace

std::string html(const Study& study, const Heading& heading) {
  json data = {
      {"scene", heading.scene},       {"title", heading.title},   {"command", heading.command},
      {"machine", heading.machine},   {"seconds", study.seconds}, {"frames", study.frames},
      {"time_step", study.time_step}, {"chaotic", study.chaotic}, {"integrators", integrator_names()},
      {"levels", json::array()}};
  for (const LevelStudy& level : study.levels) data["levels"].push_back(json_of(study, level));
  std::string text = data.dump();
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) {
    text.replace(at, 1, "\\u003c");  // no name ends the script
  }
  std::string page(report_page());
  constexpr std::string_view kPlace = "/*study*/null";
  return page.replace(page.find(kPlace), kPlace.size(), text);
}

}  // namespace weft::study
