// What is chosen from a study, from studies made by hand.
#include "study/quality.h"

#include "fixtures.h"

namespace weft::study::test {
namespace {

Run done(int substeps, double milliseconds, double error, bool present = false) {
  Run run;
  run.candidate = {XpbdDescription{substeps}, present};
  run.status = Run::Status::done;
  run.milliseconds = milliseconds;
  run.time.rms_position = error;
  run.time.mean_shape = 10 * error;
  return run;
}

/// A level whose reference moved by `moved` last, and lies `space` from the finest.
LevelStudy level_of(int level, double moved, double space, std::vector<Run> runs) {
  LevelStudy made;
  made.level = level;
  made.reference.rungs.resize(2);
  made.reference.rungs.back().change.rms_position = moved;
  made.reference.rungs.back().change.mean_shape = moved;
  made.space.rms_position = space;
  made.space.mean_shape = space / 2;
  made.runs = std::move(runs);
  return made;
}

/// Level 5 with three best choices of four, and one run that was skipped.
Study study_of_one_level() {
  Study study;
  study.frames = 30;
  study.levels.push_back(
      level_of(5, 1e-4, 0.02,
               {done(40, 4, 0.001, true), done(5, 1, 0.1), done(10, 2, 0.01), done(20, 3, 0.05), Run{}}));
  LevelStudy& level = study.levels.back();
  mark_best(study, study.floor(level.reference), level.runs);
  return study;
}

std::vector<double> costs(const std::vector<Choice>& choices) {
  std::vector<double> all;
  for (const Choice& choice : choices) all.push_back(choice.milliseconds);
  return all;
}

TEST(QualityChoices, AreTheBestRunsFromCheapToAccurate) {
  const Choices choices = choices_of(study_of_one_level());
  ASSERT_EQ(choices.levels.size(), 1u);
  EXPECT_EQ(choices.frames, 30);
  const LevelChoices& level = choices.levels[0];
  EXPECT_EQ(costs(level.front), (std::vector<double>{1, 2, 4}));
  EXPECT_EQ(costs(level.all), (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(level.front[1].error, 0.01);
  EXPECT_EQ(level.front[1].level, 5);
  EXPECT_EQ(std::get<XpbdDescription>(level.front[1].integrator).substeps, 10);
  EXPECT_EQ(level.space, 0.02);
  ASSERT_TRUE(level.own);
  EXPECT_EQ(level.own->milliseconds, 4);
}

// Over 60 steps the run of 2 ms is ten times as far off as over 30, that of 1 ms was not followed, and that
// of 4 ms is known over 30 alone.
TEST(QualityChoices, AreKnownOverTheSpanThatTheyWereFollowedFor) {
  Study study = study_of_one_level();
  study.time_step = 0.5;
  study.followed_frames = 60;
  study.levels[0].runs[2].followed = 0.1;
  const LevelChoices level = choices_of(study).levels[0];
  EXPECT_EQ(costs(level.front), (std::vector<double>{2, 4}));
  EXPECT_EQ(level.front[0].error, 0.1);
  EXPECT_EQ(level.front[0].span, 30);
  EXPECT_EQ(level.front[1].error, 0.001);
  EXPECT_EQ(level.front[1].span, 15);
  EXPECT_EQ(level.all[0].span, 15);
}

TEST(QualityChoices, WhichAreNoBetterOverALongerSpanAreLeftOut) {
  Study study = study_of_one_level();
  study.followed_frames = 60;
  for (const std::size_t run : {0U, 1U, 2U}) study.levels[0].runs[run].followed = 0.02;
  EXPECT_EQ(costs(choices_of(study).levels[0].front), std::vector<double>{1});
}

TEST(QualityChoices, OfAChaoticSceneAreJudgedByMeanShape) {
  Study study = study_of_one_level();
  study.chaotic = true;
  const Choices choices = choices_of(study);
  EXPECT_TRUE(choices.chaotic);
  EXPECT_EQ(choices.levels[0].front[1].error, 0.1);
  EXPECT_EQ(choices.levels[0].space, 0.01);
}

TEST(QualityChoices, PromiseNoMoreThanTheReferenceCanTell) {
  Study study;
  study.levels.push_back(level_of(5, 0.02, 0, {done(5, 1, 0.1), done(10, 2, 0.01)}));
  mark_best(study, 0.02, study.levels[0].runs);
  const Choices choices = choices_of(study);
  EXPECT_EQ(choices.levels[0].front[1].error, 0.02);
  EXPECT_EQ(choices.levels[0].floor, 0.02);
}

TEST(QualityChoices, HaveOneOfEquals) {
  Study study;
  study.levels.push_back(level_of(5, 0, 0, {done(5, 1, 0.1), done(10, 1, 0.1)}));
  mark_best(study, 0, study.levels[0].runs);
  EXPECT_EQ(choices_of(study).levels[0].front.size(), 1u);
}

TEST(QualityChoices, LeaveOutLevelsOfWhichNothingIsKnown) {
  Study study = study_of_one_level();
  study.levels.push_back(level_of(6, 0, 0, {study::Run{}}));
  study.levels.emplace_back().level = 7;  // its reference was not found
  const Choices choices = choices_of(study);
  ASSERT_EQ(choices.levels.size(), 1u);
  EXPECT_EQ(choices_of(Study{}).at(5), nullptr);
}

TEST(QualityChoices, OfALevelNotStudiedAreTheNearestOnesCoarserFirst) {
  Choices choices;
  for (const int level : {4, 6}) choices.levels.emplace_back().level = level;
  EXPECT_EQ(choices.at(3)->level, 4);
  EXPECT_EQ(choices.at(4)->level, 4);
  EXPECT_EQ(choices.at(5)->level, 4);
  EXPECT_EQ(choices.at(6)->level, 6);
  EXPECT_EQ(choices.at(8)->level, 6);
}

TEST(CheapestWithin, IsTheCheapestThatIsAccurateEnough) {
  const LevelChoices level = choices_of(study_of_one_level()).levels[0];
  EXPECT_EQ(cheapest_within(level, 0.5).choice.milliseconds, 1);
  EXPECT_EQ(cheapest_within(level, 0.1).choice.milliseconds, 1);  // just enough is enough
  EXPECT_EQ(cheapest_within(level, 0.05).choice.milliseconds, 2);
  EXPECT_EQ(cheapest_within(level, 0.002).choice.milliseconds, 4);
  EXPECT_TRUE(cheapest_within(level, 0.002).met);
}

TEST(CheapestWithin, IsTheMostAccurateWhereNoneIsAccurateEnough) {
  const Pick pick = cheapest_within(choices_of(study_of_one_level()).levels[0], 1e-5);
  EXPECT_EQ(pick.choice.milliseconds, 4);
  EXPECT_FALSE(pick.met);
}

TEST(MostAccurateWithin, IsTheMostAccurateThatIsFastEnough) {
  const LevelChoices level = choices_of(study_of_one_level()).levels[0];
  EXPECT_EQ(most_accurate_within(level, 100).choice.milliseconds, 4);
  EXPECT_EQ(most_accurate_within(level, 4).choice.milliseconds, 4);
  EXPECT_EQ(most_accurate_within(level, 3.9).choice.milliseconds, 2);
  EXPECT_EQ(most_accurate_within(level, 1).choice.milliseconds, 1);
  EXPECT_TRUE(most_accurate_within(level, 1).met);
}

TEST(MostAccurateWithin, CountsHowMuchSlowerThingsAreNow) {
  const LevelChoices level = choices_of(study_of_one_level()).levels[0];
  EXPECT_EQ(most_accurate_within(level, 4, 2).choice.milliseconds, 2);
  EXPECT_EQ(most_accurate_within(level, 4, 0.5).choice.milliseconds, 4);
}

TEST(MostAccurateWithin, IsTheCheapestWhereNoneIsFastEnough) {
  const Pick pick = most_accurate_within(choices_of(study_of_one_level()).levels[0], 0.9);
  EXPECT_EQ(pick.choice.milliseconds, 1);
  EXPECT_FALSE(pick.met);
}

TEST(LevelsOf, AreThoseOfAllItsCloths) {
  SimulationDescription description;
  description.cloths.resize(2);
  description.cloths[0].min_level = 5;
  description.cloths[0].max_level = 6;
  description.cloths[1].min_level = 3;
  description.cloths[1].max_level = 3;
  EXPECT_EQ(levels_of(description), (std::vector<int>{3, 4, 5, 6}));
}

}  // namespace
}  // namespace weft::study::test
