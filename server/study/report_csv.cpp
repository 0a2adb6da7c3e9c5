#include <charconv>

#include "study/report.h"

namespace weft::study {
namespace {

constexpr std::string_view kHeader =
    "scene,level,integrator,setting,present,status,best,ms_per_frame,substeps,max_strain,max_compression,rms_"
    "error,"
    "max_error,shape_error,strain_error,energy_error,frequency_error,total_rms_error,total_max_error,total_"
    "shape_error,"
    "space_rms_error,reference_substeps,reference_change,rounding_change\n";

/// Fields of one line, parted by commas.
class Line {
 public:
  void text(std::string_view value) {
    if (!line_.empty()) line_ += ',';
    const bool quoted = value.find(',') != std::string_view::npos;
    if (quoted) line_ += '"';
    line_ += value;
    if (quoted) line_ += '"';
  }
  /// In the shortest form that reads back to the same value, in any locale.
  template <class Number>
  void number(Number value) {
    char digits[32];
    text({digits, std::to_chars(digits, digits + sizeof digits, value).ptr});
  }
  void number_if(bool exists, double value) { exists ? number(value) : text(""); }
  std::string end() && { return std::move(line_) + "\n"; }

 private:
  std::string line_;
};

std::string line_of(const Heading& heading, const LevelStudy& level, const Run& run) {
  const bool done = run.status == Run::Status::done;
  const bool usable = level.reference.usable();
  Line line;
  line.text(heading.scene);
  line.number(level.level);
  line.text(name_of(run.candidate.integrator));
  line.text(setting_of(run.candidate.integrator));
  line.number(int{run.candidate.present});
  line.text(name_of(run.status));
  line.number(int{run.best});
  line.number_if(done, run.milliseconds);
  done ? line.number(run.substeps) : line.text("");
  line.number_if(done, run.max_strain);
  line.number_if(done, run.max_compression);
  for (const double error :
       {run.time.rms_position, run.time.max_position, run.time.mean_shape, run.time.strain}) {
    line.number_if(done, error);
  }
  line.number_if(run.time.energy.has_value(), run.time.energy.value_or(0));
  line.number_if(run.time.frequency.has_value(), run.time.frequency.value_or(0));
  for (const double error : {run.total.rms_position, run.total.max_position, run.total.mean_shape}) {
    line.number_if(done, error);
  }
  line.number_if(usable, level.space.rms_position);
  line.number(usable ? level.reference.rungs.back().substeps : 0);
  line.number_if(usable, usable ? level.reference.change().rms_position : 0);
  line.number_if(usable, level.reference.rounding.rms_position);
  return std::move(line).end();
}

}  // namespace

std::string csv(const Study& study, const Heading& heading) {
  std::string text(kHeader);
  for (const LevelStudy& level : study.levels) {
    for (const Run& run : level.runs) text += line_of(heading, level, run);
  }
  return text;
}

}  // namespace weft::study
