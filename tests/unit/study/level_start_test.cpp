// Runs of a level answer one problem, whatever makes their steps: their errors are those that hold between
// runs that no change of level precedes.
#include "fixtures.h"

namespace weft::study::test {
namespace {

constexpr int kShortSpan = 3;
const auto kToItsEnd = [](int) { return true; };

/// The scene whose cloth is made at `level`, of the positions that splits lead to (Eq. 8).
SimulationDescription made_at(int level, SimulationDescription description) {
  const Simulation<double> split = at_level<double>(description, level);
  const Particles<double>& particles = split.cloths()[0].particles();
  ClothDescription& cloth = description.cloths[0];
  cloth.min_level = cloth.max_level = cloth.initial_level = level;
  cloth.nodes.clear();
  for (int r = 0; r < particles.grid().rows; ++r) {
    for (int c = 0; c < particles.grid().cols; ++c) cloth.nodes.push_back(particles.position_at(r, c));
  }
  return description;
}

class Levels : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Slow, Levels, ::testing::Values(4, 5));
INSTANTIATE_TEST_SUITE_P(Nightly, Levels, ::testing::Values(6));

/// The preset whose first level is 4 and whose pleats hold 24 J at the start.
TEST_P(Levels, AStudysErrorsAreThoseOfOneProblem) {
  const SimulationDescription curtain = std::get<scene::Scene>(scene::load("curtain")).simulation;
  const int level = GetParam();
  // A second a frame: 21 s for a reference of 2 to 64 substeps, then a run of the scene's own and this one.
  // Level 6 needs a finer reference: with as much it has not converged, and the error told is 1.3 times off.
  double seconds = 0;
  const StudyPlan plan{{level}, {SymplecticEulerDescription::kName}, kShortSpan, level < 6 ? 35.0 : 70.0, 0};
  const Study study = study_cost(
      curtain, plan, [&] { return seconds; }, [&] { seconds += 1; });
  ASSERT_TRUE(study.levels[0].reference.usable());
  const auto told =
      std::find_if(study.levels[0].runs.begin(), study.levels[0].runs.end(), [](const auto& run) {
        return std::holds_alternative<SymplecticEulerDescription>(run.candidate.integrator);
      });
  SimulationDescription by_hand = made_at(level, curtain);
  by_hand.integrator = told->candidate.integrator;
  const Trajectory run = simulate<float>(by_hand, {level, kShortSpan}, kToItsEnd);
  by_hand.integrator = SymplecticEulerDescription{16 * run.substeps, 0.9};
  const Trajectory converged = simulate<double>(by_hand, {level, kShortSpan}, kToItsEnd);
  const double error = errors_of(run, converged).rms_position;
  EXPECT_NEAR(told->time.rms_position / error, 1, 0.2) << "by hand " << error;
}

}  // namespace
}  // namespace weft::study::test
