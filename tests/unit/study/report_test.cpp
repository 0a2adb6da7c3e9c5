#include "study/report.h"

#include <nlohmann/json.hpp>

#include "fixtures.h"

namespace weft::study::test {
namespace {

/// One level: a reference and a run done, one skipped.
Study small_study() {
  Study study;
  study.frames = 120;
  study.time_step = 1.0 / 60;
  LevelStudy& level = study.levels.emplace_back();
  level.level = 4;
  Errors change;
  change.rms_position = 1e-5;
  level.reference.rungs = {{2, 0.1, 0, {}}, {4, 0.2, 1e-4, change}};
  Run run;
  run.candidate = {Bdf2Description{}, true};
  run.status = Run::Status::done;
  run.milliseconds = 0.25;
  run.substeps = 1;
  run.max_strain = 0.5;
  run.max_compression = 0.25;
  run.best = true;
  run.time.rms_position = 0.001;
  run.time.energy = 0.125;
  level.runs.push_back(run);
  Run skipped;
  skipped.candidate = {XpbdDescription{5}};
  level.runs.push_back(skipped);
  return study;
}

const Heading kHeading{"sheet", "A </script> sheet", "weft cost sheet", "a processor"};

TEST(Csv, HasAHeaderAndALineARun) {
  EXPECT_EQ(
      csv(small_study(), kHeading),
      "scene,level,integrator,setting,present,status,best,ms_per_frame,substeps,max_strain,max_compression,"
      "rms_error,max_error,shape_error,strain_error,energy_error,frequency_error,total_rms_error,total_max_"
      "error,"
      "total_shape_error,space_rms_error,reference_substeps,reference_change,rounding_change\n"
      "sheet,4,bdf2,\"1 substep, tolerance 0.1, 2 "
      "Newton\",1,done,1,0.25,1,0.5,0.25,0.001,0,0,0,0.125,,0,0,0,0,4,1e-05,0\n"
      "sheet,4,xpbd,5 substeps,0,skipped: beyond the budget,0,,,,,,,,,,,,,,0,4,1e-05,0\n");
}

TEST(Table, MarksBestAndPresent) {
  const std::string text = table(small_study());
  EXPECT_NE(text.find("*> bdf2 "), std::string::npos) << text;
  EXPECT_NE(text.find("1 runs did not fit into the budget"), std::string::npos) << text;
}

TEST(Trust, SaysWhetherTheReferenceIsConverged) {
  Study study = small_study();
  EXPECT_NE(trust(study, study.levels[0]).find("Converged: a tenth of the smallest error here, 1.0e-03"),
            std::string::npos);
  study.levels[0].runs[0].time.rms_position = 5e-5;  // five times the reference's change
  EXPECT_NE(trust(study, study.levels[0]).find("Not converged"), std::string::npos);
  study.levels[0].reference.chaotic = true;
  EXPECT_NE(trust(study, study.levels[0]).find("Chaotic"), std::string::npos);
  study.levels[0].reference.rungs.clear();
  EXPECT_EQ(trust(study, study.levels[0]), "no reference: no step size was stable.");
}

TEST(Html, HoldsTheStudyAsDataThatCannotEndItsScript) {
  const std::string page = html(small_study(), kHeading);
  const auto begin = page.find("const study = ") + 14;
  const auto data = nlohmann::json::parse(page.substr(begin, page.find(";\n", begin) - begin));
  EXPECT_EQ(data["title"], "A </script> sheet");
  EXPECT_EQ(data["levels"][0]["runs"][0]["time"]["energy"], 0.125);
  EXPECT_TRUE(data["levels"][0]["runs"][0]["time"]["frequency"].is_null());
  EXPECT_EQ(data["levels"][0]["runs"][1]["done"], false);
  EXPECT_EQ(page.find("A </script>"), std::string::npos);
}

}  // namespace
}  // namespace weft::study::test
