#include "study/candidate.h"

#include <gtest/gtest.h>

#include <set>

namespace weft::study::test {
namespace {

std::vector<std::string> settings_of(std::string_view name) {
  std::vector<std::string> settings;
  for (const Candidate& each : candidates({name}, SymplecticEulerDescription{7, 0.9})) {
    if (!each.present) settings.push_back(setting_of(each.integrator));
  }
  return settings;
}

TEST(Candidates, XpbdHasTheSubstepsOfTheIssue) {
  EXPECT_EQ(settings_of("xpbd"), (std::vector<std::string>{"5 substeps", "10 substeps", "20 substeps",
                                                           "40 substeps", "80 substeps", "160 substeps"}));
}

TEST(Candidates, ImplicitOnesGoFromLooseToTight) {
  for (const std::string_view name : {"bdf2", "backward_euler"}) {
    const auto settings = settings_of(name);
    ASSERT_EQ(settings.size(), 13u);
    EXPECT_EQ(settings[0], "1 substep, tolerance 0.3");
    EXPECT_EQ(settings[2], "1 substep, tolerance 0.1, 2 Newton");  // description.h's defaults
    EXPECT_EQ(settings[4], "4 substeps, tolerance 0.1, 2 Newton");
    EXPECT_EQ(settings[5], "1 substep, tolerance 0.01, 2 Newton");
    EXPECT_EQ(settings[8], "1 substep, tolerance 0.001, 3 Newton");
    EXPECT_EQ(settings[12], "16 substeps, tolerance 0.001, 3 Newton");
  }
}

TEST(Candidates, SymplecticEulerGoesBelowTheStabilityLimit) {
  EXPECT_EQ(settings_of("symplectic_euler"),
            (std::vector<std::string>{"0.9 of the stability limit", "0.45 of the stability limit",
                                      "0.225 of the stability limit"}));
}

TEST(Candidates, SubstepsChosenByTheirLengthAreTold) {
  EXPECT_EQ(setting_of(XpbdDescription{}), "substeps of 417 us");
}

TEST(Candidates, TheScenesOwnComesFirstAndOnce) {
  const auto all = candidates(integrator_names(), XpbdDescription{40});
  EXPECT_EQ(all.size(), 13u + 13 + 6 + 3);
  EXPECT_TRUE(all[0].present);
  EXPECT_EQ(name_of(all[0].integrator), "xpbd");
  std::set<std::string> different;
  for (const Candidate& each : all) {
    different.insert(std::string(name_of(each.integrator)) + setting_of(each.integrator));
  }
  EXPECT_EQ(different.size(), all.size());
  EXPECT_EQ(candidates({"bdf2"}, XpbdDescription{41}).size(),
            14u);  // even where its integrator is not asked for
}

TEST(Candidates, TheFirstRoundHasSomethingOfEachIntegrator) {
  const auto all = candidates(integrator_names(), XpbdDescription{41});
  std::set<std::string_view> first;
  for (std::size_t i = 1; i <= 4; ++i) first.insert(name_of(all[i].integrator));
  EXPECT_EQ(first.size(), 4u);
}

}  // namespace
}  // namespace weft::study::test
