// Norms of hand-made runs, worked out by hand.
#include "study/errors.h"

#include "fixtures.h"

namespace weft::study::test {
namespace {

/// A centre that swings along y by `amplitude` about `middle`.
Trajectory swinging(double frequency_hz, double amplitude, double middle, double seconds) {
  constexpr double kStep = 0.01;
  Trajectory run = still(static_cast<int>(seconds / kStep), kStep);
  for (std::size_t f = 0; f < run.frames.size(); ++f) {
    const double time = kStep * static_cast<double>(f);
    run.frames[f].centre = Vec3(0.1 * time, middle + amplitude * std::cos(2 * M_PI * frequency_hz * time), 0);
  }
  return run;
}

TEST(Errors, EqualRunsHaveNone) {
  const Errors errors = errors_of(still(3), still(3));
  EXPECT_EQ(errors.rms_position, 0);
  EXPECT_EQ(errors.max_position, 0);
  EXPECT_EQ(errors.mean_shape, 0);
  EXPECT_EQ(errors.strain, 0);
  EXPECT_FALSE(errors.energy);  // nothing is exchanged
  EXPECT_FALSE(errors.frequency);
}

TEST(Errors, PositionsAreInClothSizesOverNodesAndFrames) {
  Trajectory run = still(2);
  run.frames[1].positions[0] += 0.6;  // one of four nodes, one of two frames: 0.3 of the 2 m side
  run.frames[2].positions[4] += 0.8;  // another: 0.4
  const Errors errors = errors_of(run, still(2));
  EXPECT_DOUBLE_EQ(errors.rms_position, std::sqrt((0.09 + 0.16) / 8));
  EXPECT_DOUBLE_EQ(errors.max_position, 0.4);
  // Means over the frames: 0.15 and 0.2.
  EXPECT_DOUBLE_EQ(errors.mean_shape, std::sqrt((0.0225 + 0.04) / 4));
}

TEST(Errors, TheStartDoesNotCount) {
  Trajectory run = still(2);
  run.frames[0].positions[0] += 1;
  run.frames[0].mean_strain = 1;
  const Errors errors = errors_of(run, still(2));
  EXPECT_EQ(errors.rms_position, 0);
  EXPECT_EQ(errors.strain, 0);
}

TEST(Errors, ErrorsThatAlternateLeaveTheMeanShape) {
  Trajectory run = still(2);
  run.frames[1].positions[2] = 0.5;
  run.frames[2].positions[2] = -0.5;
  const Errors errors = errors_of(run, still(2));
  EXPECT_GT(errors.rms_position, 0.05);
  EXPECT_EQ(errors.mean_shape, 0);
}

TEST(Errors, LevelsAreComparedAtTheNodesTheyShare) {
  Trajectory fine = still(1);
  fine.sheets = {{3, 3, 2.0}};
  for (Frame& frame : fine.frames) {
    frame.positions = {0, 0, 0, 9, 9, 9, 2, 0, 0, 9, 9, 9, 9, 9, 9, 9, 9, 9, 0, 2, 0, 9, 9, 9, 2, 2, 0};
  }
  EXPECT_EQ(errors_of(still(1), fine).rms_position, 0);
  EXPECT_EQ(errors_of(fine, still(1)).rms_position, 0);
  fine.frames[1].positions[24] = 3;  // the last corner, off by half a side
  EXPECT_DOUBLE_EQ(errors_of(still(1), fine).rms_position, 0.25);
}

TEST(Errors, GridsThatAreNotNestedAndOtherLengthsAreRefused) {
  Trajectory three = still(1), four = still(1);
  three.sheets = {{3, 3, 2.0}};
  four.sheets = {{4, 4, 2.0}};
  for (Frame& frame : three.frames) frame.positions.assign(27, 0);
  for (Frame& frame : four.frames) frame.positions.assign(48, 0);
  EXPECT_THROW(errors_of(three, four), std::invalid_argument);
  EXPECT_THROW(errors_of(still(1), still(2)), std::invalid_argument);
  EXPECT_THROW(errors_of(still(0), still(0)), std::invalid_argument);
}

TEST(Errors, StrainIsTheMeansDifference) {
  Trajectory run = still(2);
  run.frames[1].mean_strain = 0.03;
  run.frames[2].mean_strain = 0.04;
  EXPECT_DOUBLE_EQ(errors_of(run, still(2)).strain, std::sqrt((0.0009 + 0.0016) / 2));
}

TEST(Errors, EnergyIsAShareOfWhatIsExchanged) {
  Trajectory reference = still(2);
  reference.frames[1].kinetic_energy = 4;  // 4 J to and fro; 3 J of potential energy
  reference.frames[1].potential_energy = -3;
  EXPECT_EQ(energy_exchanged(reference), 4);
  Trajectory run = reference;
  run.frames[1].kinetic_energy = 3;
  EXPECT_DOUBLE_EQ(*errors_of(run, reference).energy, std::sqrt(1.0 / 2) / 4);
}

TEST(Frequency, OfACosineAboutAnyLevel) {
  EXPECT_NEAR(*frequency(swinging(1.3, 0.2, 5, 3)), 1.3,
              0.005);                                   // linear between frames of a 77th of a period
  EXPECT_FALSE(frequency(swinging(1.3, 0.2, 5, 0.7)));  // two crossings
  EXPECT_FALSE(frequency(still(100)));
}

TEST(Frequency, AThirdOfTheIntervalsTwiceAsLongIsNoOscillation) {
  Trajectory run = still(5, 1);
  const double heights[] = {1, -1, 1, -1, -1, 1};
  for (std::size_t f = 0; f < run.frames.size(); ++f) run.frames[f].centre.y() = heights[f];
  EXPECT_FALSE(frequency(run));
}

TEST(Frequency, ATremorAboutTheLevelDoesNotCount) {
  Trajectory run = swinging(1, 1, 0, 3);
  for (std::size_t f = 0; f < run.frames.size(); ++f) run.frames[f].centre.y() += f % 2 == 0 ? 0.04 : -0.04;
  EXPECT_NEAR(*frequency(run), 1, 0.02);
}

TEST(Errors, FrequencyIsRelative) {
  const auto error = errors_of(swinging(1.05, 1, 0, 4), swinging(1, 1, 0, 4)).frequency;
  ASSERT_TRUE(error);
  EXPECT_NEAR(*error, 0.05, 0.01);  // the mean of four seconds is not quite the middle of 1.05 Hz
}

}  // namespace
}  // namespace weft::study::test
