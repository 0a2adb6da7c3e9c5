#pragma once
/// From a study to what a server may choose from, and the choice that meets a wish.
#include <optional>
#include <string>
#include <vector>

#include "study/study.h"

namespace weft::study {

/// One way to step a scene at one level, with what it was measured to cost and give.
struct Choice {
  int level = 0;
  IntegratorDescription integrator;
  double milliseconds = 0;  ///< a frame, of processor time on one thread
  double error = 0;         ///< of the steps, as Study judges it; never below what the reference can tell
  double span = 0;          ///< s from the scene's start, over which that was measured
};

/// What there is at one level.
struct LevelChoices {
  int level = 0;
  double space = 0;  ///< error of the grid itself, against the finest level studied
  double floor = 0;  ///< smaller errors than this cannot be told apart
  /// The best choices, from cheap to accurate: error falls strictly. Where runs were followed over a longer
  /// span none is here whose error is known over the shorter one alone, but what is dearer than all of them.
  std::vector<Choice> front;
  std::optional<Choice> own;  ///< the scene's own integrator, if it stayed sound
  std::vector<Choice> all;    ///< every run that was done, those above included, from cheap to dear
};

struct Choices {
  bool chaotic = false;              ///< see Study
  int frames = 0;                    ///< that were studied
  std::vector<LevelChoices> levels;  ///< ascending; only those with a front

  /// What is known of `level`: itself or, if it is not there, the nearest one, the coarser of two. nullptr if
  /// there are no levels.
  const LevelChoices* at(int level) const;
};

Choices choices_of(const Study& study);

/// What was chosen, and whether it meets what was asked for; if nothing does, it is what comes nearest.
struct Pick {
  Choice choice;
  bool met = false;
};

/// The cheapest of a level's front whose error is at most `max_error`; else the most accurate. The front must
/// not be empty.
Pick cheapest_within(const LevelChoices& level, double max_error);

/// The most accurate of a level's front that takes at most `max_ms`, each taking `slowness` times what was
/// measured; else the cheapest. The front must not be empty.
Pick most_accurate_within(const LevelChoices& level, double max_ms, double slowness = 1);

/// The levels that some cloth of the scene can have, ascending.
std::vector<int> levels_of(const SimulationDescription& description);

}  // namespace weft::study
