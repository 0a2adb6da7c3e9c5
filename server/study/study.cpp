#include "study/study.h"

#include <algorithm>
#include <cmath>

namespace weft::study {
namespace {

constexpr double kReferenceShare = 0.6;  // of the budget

/// A finer level takes about twice the share of the one below: more would leave the coarse ones unfinished.
double share_of(const std::vector<int>& levels, std::size_t at) {
  double sum = 0;
  for (std::size_t i = at; i < levels.size(); ++i) sum += std::ldexp(1.0, levels[i]);
  return std::ldexp(1.0, levels[at]) / sum;
}

class Runner {
 public:
  Runner(const SimulationDescription& description, int frames, Allowance allowance,
         const std::function<void()>& watch)
      : description_(description), frames_(frames), allowance_(std::move(allowance)), watch_(watch) {}

  void run(const Reference& reference, const Reference& finest, Run& run) const {
    if (allowance_.left() <= 0) return;
    SimulationDescription stepped = description_;
    stepped.integrator = run.candidate.integrator;
    const double begin = allowance_.now();
    const Trajectory trajectory =
        simulate<float>(std::move(stepped), {reference.level, frames_}, [&](int done) {
          watch_();
          return fits(begin, done);
        });
    if (!trajectory.sound) run.status = Run::Status::went_bad;
    if (!trajectory.complete) return;
    run.status = Run::Status::done;
    run.milliseconds = trajectory.milliseconds_per_frame();
    run.substeps = trajectory.substeps;
    for (const Frame& frame : trajectory.frames) run.max_strain = std::max(run.max_strain, frame.max_strain);
    run.time = errors_of(trajectory, reference.answer);
    run.total = errors_of(trajectory, finest.answer);
  }

 private:
  /// What the frames so far took tells whether the rest will fit.
  bool fits(double begin, int done) const {
    constexpr int kEnoughToTell = 3;
    if (done < kEnoughToTell) return true;
    const double each = (allowance_.now() - begin) / done;
    return each * (frames_ - done) <= allowance_.left();
  }

  const SimulationDescription& description_;
  int frames_;
  Allowance allowance_;
  const std::function<void()>& watch_;
};

}  // namespace

double Study::floor(const Reference& reference) const {
  return std::max(judged(reference.change()), judged(reference.rounding));
}

bool Study::any_done() const {
  return std::any_of(levels.begin(), levels.end(), [](const LevelStudy& level) {
    return std::any_of(level.runs.begin(), level.runs.end(),
                       [](const Run& run) { return run.status == Run::Status::done; });
  });
}

void mark_best(const Study& study, double floor, std::vector<Run>& runs) {
  const auto error = [&](const Run& run) { return std::max(study.judged(run.time), floor); };
  const auto beats = [&](const Run& other, const Run& run) {
    return other.status == Run::Status::done && other.milliseconds <= run.milliseconds &&
           error(other) <= error(run) && (other.milliseconds < run.milliseconds || error(other) < error(run));
  };
  for (Run& run : runs) {
    run.best = run.status == Run::Status::done &&
               std::none_of(runs.begin(), runs.end(), [&](const Run& other) { return beats(other, run); });
  }
}

Study study_cost(const SimulationDescription& description, const StudyPlan& plan,
                 const std::function<double()>& clock, const std::function<void()>& watch) {
  Study study;
  study.time_step = description.time_step;
  study.frames = plan.frames;
  const double begin = clock();

  for (std::size_t i = 0; i < plan.levels.size(); ++i) {
    LevelStudy& level = study.levels.emplace_back();
    level.level = plan.levels[i];
    const double left = begin + kReferenceShare * plan.budget - clock();
    const Allowance allowance{clock, clock() + left * share_of(plan.levels, i)};
    level.reference = find_reference(description, level.level, study.frames, plan.target, allowance, watch);
    study.chaotic = study.chaotic || level.reference.chaotic;
  }

  const Reference& finest = study.levels.back().reference;
  const Runner runner(description, study.frames, {clock, begin + plan.budget}, watch);
  const std::vector<Candidate> all = candidates(plan.integrators, description.integrator);
  for (const Candidate& candidate :
       all) {  // every level's first candidates come before any level's second ones
    for (LevelStudy& level : study.levels) {
      Run& run = level.runs.emplace_back();
      run.candidate = candidate;
      if (level.reference.usable() && finest.usable()) {
        runner.run(level.reference, finest, run);
      } else {
        run.status = Run::Status::no_reference;
      }
    }
  }
  for (LevelStudy& level : study.levels) {
    if (!level.reference.usable() || !finest.usable()) continue;
    level.space = errors_of(level.reference.answer, finest.answer);
    mark_best(study, study.floor(level.reference), level.runs);
  }
  study.seconds = clock() - begin;
  return study;
}

}  // namespace weft::study
