#pragma once
/// What accuracy costs: one scene over levels, integrators and settings, each against the same converged
/// answer.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/candidate.h"
#include "study/reference.h"

namespace weft::study {

struct StudyPlan {
  std::vector<int> levels;  ///< ascending, not empty
  std::vector<std::string_view> integrators;
  int frames = 120;    ///< steps of the scene; at most kMaxFrames
  double budget = 60;  ///< wall time for everything else, s: three fifths for the references, then the runs.
                       ///< Two doublings a level and the run in hand are finished whatever they take.
  /// A reference is good enough when halving its steps moves it by less, in cloth sizes. The default is a
  /// tenth of what a single-precision run can be told apart by.
  double target = 1e-7;
  int followed_frames = 0;   ///< steps over which each level's best runs and the scene's own are followed
                             ///< besides, if more than `frames`
  double follow_budget = 0;  ///< wall time for that, s
};

/// One candidate at one level, in single precision, as in service.
struct Run {
  enum class Status {
    done,
    skipped,       ///< did not fit into what was left of the budget
    no_reference,  ///< not made: its level's reference, or the finest level's, went bad
    went_bad       ///< the step guard found a bad state: it does not do without smaller steps
  };
  Candidate candidate;
  Status status = Status::skipped;
  double milliseconds = 0;  ///< a frame, median of the steps alone
  int substeps = 0;         ///< a frame
  double max_strain = 0;    ///< largest stretch over all frames and springs
  double max_compression = 0;
  Errors time;   ///< against this level's reference: what the steps cost
  Errors total;  ///< against the finest level's reference, at the nodes shared: steps and grid
  /// Judged error over Study::followed_frames: how far it is then from the most accurate run followed at its
  /// level, and that one's own error, taken to grow in proportion to time. Absent if it was not followed.
  std::optional<double> followed;
  bool best = false;  ///< no other run of its level is at least as fast and at least as accurate
};

struct LevelStudy {
  int level = 0;
  Reference reference;
  Errors space;  ///< of this level's reference against the finest level's: what the grid costs
  std::vector<Run> runs;
};

struct Study {
  int frames = 0;
  int followed_frames = 0;  ///< 0: no run was followed
  double time_step = 0;     ///< s
  double seconds = 0;       ///< wall time of the whole study
  bool chaotic = false;     ///< at some level: then errors are judged by mean_shape, else by rms_position
  std::vector<LevelStudy> levels;

  double judged(const Errors& errors) const { return chaotic ? errors.mean_shape : errors.rms_position; }
  /// Errors below this say nothing: by so much the reference moved last, or rounding moves it. Judged as
  /// errors are.
  double floor(const Reference& reference) const;
  /// Some run stayed sound and could be compared.
  bool any_done() const;
};

/// `clock` gives seconds, never descending; a real study takes steady_clock. `watch` is called after every
/// frame of every run.
Study study_cost(const SimulationDescription& description, const StudyPlan& plan,
                 const std::function<double()>& clock, const std::function<void()>& watch);

/// Marks the Pareto front of a level's done runs. Errors below `floor` count as `floor`: what the reference
/// itself cannot tell apart is not rewarded.
void mark_best(const Study& study, double floor, std::vector<Run>& runs);

}  // namespace weft::study
