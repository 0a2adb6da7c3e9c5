// The hard cases (case.h), one test a run: Stability/* and Slow/* have each case once, Nightly/* all runs in
// full length; under a sanitizer, whose affair is the code, Nightly/* has the coarsest levels alone.
#include <gtest/gtest.h>

#include "open_failures.h"
#include "runs.h"
#include "table.h"

namespace weft::stability {
namespace {

class HardCase : public ::testing::TestWithParam<HardRun> {};

TEST_P(HardCase, Survives) {
  const auto& [hard_case, setup] = GetParam();
  const bool nightly = std::string_view(::testing::UnitTest::GetInstance()->current_test_suite()->name())
                           .starts_with("Nightly");
  const Result result = run(*hard_case, setup, nightly);
  keep(row_of(*hard_case, setup, result), std::filesystem::path(WEFT_STABILITY_REPORT) / "rows");
  const bool open = is_open(name_of(GetParam()));
  if (result.verdict != Verdict::fail) {
    EXPECT_FALSE(open && !result.cut_short) << "passes now: take it off open_failures.txt";
    return;
  }
  std::string complaints;
  for (const std::string& complaint : result.complaints) complaints += "\n" + complaint;
  if (open) GTEST_SKIP() << "known to fail: " << hard_case->what << complaints;
  ADD_FAILURE() << hard_case->what << complaints;
}

std::string test_name(const ::testing::TestParamInfo<HardRun>& info) { return name_of(info.param); }

#ifdef WEFT_SANITIZED
std::vector<HardRun> nightly_runs() { return coarsest_runs(); }
#else
std::vector<HardRun> nightly_runs() { return all_runs(); }
#endif

INSTANTIATE_TEST_SUITE_P(Stability, HardCase, ::testing::ValuesIn(every_fifth(sample_runs())), test_name);
INSTANTIATE_TEST_SUITE_P(Slow, HardCase, ::testing::ValuesIn(all_but_every_fifth(sample_runs())), test_name);
INSTANTIATE_TEST_SUITE_P(Nightly, HardCase, ::testing::ValuesIn(nightly_runs()), test_name);

}  // namespace
}  // namespace weft::stability
