#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include "study/report.h"

namespace weft::study {
namespace {

#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
std::string
format(const char* form, ...) {
  char text[400];
  std::va_list values;
  va_start(values, form);
  std::vsnprintf(text, sizeof text, form, values);
  va_end(values);
  return text;
}

const char* judged_name(const Study& study) { return study.chaotic ? "mean shape" : "rms position"; }

std::string share(const std::optional<double>& value) {
  return value ? format("%9.2g", *value) : "        -";
}

std::string line_of(const Run& run) {
  const std::string name(name_of(run.candidate.integrator));
  std::string line = format("%c%c %-17s %-34s", run.best ? '*' : ' ', run.candidate.present ? '>' : ' ',
                            name.c_str(), setting_of(run.candidate.integrator).c_str());
  if (run.status != Run::Status::done) return line + "  " + std::string(name_of(run.status));
  line += format(" %8.3f %9.2g %9.2g %9.2g %9.2g", run.milliseconds, run.time.rms_position,
                 run.time.max_position, run.time.mean_shape, run.time.strain);
  return line + " " + share(run.time.energy) + " " + share(run.time.frequency) +
         format(" %9.2g", run.total.rms_position);
}

}  // namespace

std::string_view name_of(Run::Status status) {
  switch (status) {
    case Run::Status::done:
      return "done";
    case Run::Status::skipped:
      return "skipped: beyond the budget";
    case Run::Status::no_reference:
      return "not made: nothing to compare it with";
    case Run::Status::went_bad:
      return "went bad: the steps are too long for it";
  }
  return "";
}

std::string trust(const Study& study, const LevelStudy& level) {
  const Reference& reference = level.reference;
  if (!reference.usable()) return "no reference: no step size was stable.";
  const double moved = study.judged(reference.change());
  const int substeps = reference.rungs.back().substeps;
  std::string text = "reference: BDF2 in double precision, ";
  text += reference.chaotic ? format("%d substeps", substeps)
                            : format("extrapolated from %d and %d substeps", substeps / 2, substeps);
  text += format("; the last doubling moved it by %.1e (%s)", moved, judged_name(study));
  if (const double reduction = reference.reduction(); reduction > 0 && !study.chaotic) {
    text += format("; runs of half the step come %.1f times closer each time", reduction);
  }
  double smallest = 0;
  for (const Run& run : level.runs) {
    if (run.status != Run::Status::done) continue;
    const double error = study.judged(run.time);
    smallest = smallest == 0 ? error : std::min(smallest, error);
  }
  if (reference.chaotic) {
    text +=
        format(". Chaotic: starts that differ by rounding part by %.1e, so that only statistics are compared",
               reference.rounding.rms_position);
  }
  if (const auto swings = frequency(reference.answer))
    text += format(". Its centre swings at %.4g Hz", *swings);
  if (smallest > 0) {
    text +=
        moved <= smallest / 10
            ? format(". Converged: a tenth of the smallest error here, %.1e, or less", smallest)
            : format(
                  ". Not converged beyond doubt: the smallest error here is %.1e, and what is near %.1e or "
                  "below may be the reference's own; %s",
                  smallest, moved,
                  study.chaotic ? "a longer --duration averages more" : "a larger --budget takes it further");
  }
  return text + ".";
}

std::string table(const Study& study) {
  std::string text;
  int skipped = 0;
  for (const LevelStudy& level : study.levels) {
    text += format("level %d: ", level.level) + trust(study, level) + "\n";
    if (&level != &study.levels.back() && level.reference.usable()) {
      text += format("grid: %.1e from level %d's answer (%s)\n", study.judged(level.space),
                     study.levels.back().level, judged_name(study));
    }
    text += format("   %-17s %-34s %8s %9s %9s %9s %9s %9s %9s %9s\n", "integrator", "setting", "ms/frame",
                   "rms", "max", "shape", "strain", "energy", "frequency", "total rms");
    std::vector<const Run*> runs;
    for (const Run& run : level.runs) runs.push_back(&run);
    std::stable_sort(runs.begin(), runs.end(), [](const Run* a, const Run* b) {
      if (a->status != b->status) return a->status < b->status;
      return a->milliseconds < b->milliseconds;
    });
    for (const Run* run : runs) {
      if (run->status == Run::Status::skipped) ++skipped;
      if (run->status == Run::Status::done || run->status == Run::Status::went_bad) {
        text += line_of(*run) + "\n";
      }
    }
    text += "\n";
  }
  text +=
      "* no other run of the level is at least as fast and as accurate   > the scene's own choice\n"
      "positions in cloth sizes, over all nodes and frames; energy as a share of what is exchanged\n";
  if (skipped > 0) {
    text += format("%d runs did not fit into the budget (listed in the CSV and HTML files)\n", skipped);
  }
  return text;
}

}  // namespace weft::study
