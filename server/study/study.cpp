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
  Runner(const SimulationDescription& description, RunPlan plan, Allowance allowance,
         const std::function<void()>& watch)
      : description_(description), plan_(plan), allowance_(std::move(allowance)), watch_(watch) {}

  const Allowance& allowance() const { return allowance_; }

  /// Not complete if it went bad or does not fit into the allowance.
  Trajectory make(const Candidate& candidate, int level) const {
    if (allowance_.left() <= 0) return {};
    SimulationDescription stepped = description_;
    stepped.integrator = candidate.integrator;
    RunPlan plan = plan_;
    plan.level = level;
    const double begin = allowance_.now();
    return simulate<float>(std::move(stepped), plan, [&](int done) {
      watch_();
      return fits(begin, done);
    });
  }

 private:
  /// What the frames so far took tells whether the rest will fit.
  bool fits(double begin, int done) const {
    constexpr int kEnoughToTell = 3;
    if (done < kEnoughToTell) return true;
    const double each = (allowance_.now() - begin) / done;
    return each * (plan_.frames - done) <= allowance_.left();
  }

  const SimulationDescription& description_;
  RunPlan plan_;
  Allowance allowance_;
  const std::function<void()>& watch_;
};

void make_run(const Runner& runner, const Reference& reference, const Reference& finest, Run& run) {
  const Trajectory trajectory = runner.make(run.candidate, reference.level);
  if (!trajectory.sound) run.status = Run::Status::went_bad;
  if (!trajectory.complete) return;
  run.status = Run::Status::done;
  run.milliseconds = trajectory.milliseconds_per_frame();
  run.substeps = trajectory.substeps;
  for (const Frame& frame : trajectory.frames) {
    run.max_strain = std::max(run.max_strain, frame.max_strain);
    run.max_compression = std::max(run.max_compression, frame.max_compression);
  }
  run.time = errors_of(trajectory, reference.answer);
  run.total = errors_of(trajectory, finest.answer);
}

/// Follows a level's best runs and the scene's own: the most accurate one that takes at most half of what is
/// left, then those that are cheaper than it, the cheapest first.
void follow(const Study& study, const Runner& runner, LevelStudy& level) {
  std::vector<Run*> runs;
  for (Run& run : level.runs) {
    if (run.status == Run::Status::done && (run.best || run.candidate.present)) runs.push_back(&run);
  }
  const auto seconds = [&](const Run& run) { return run.milliseconds / 1e3 * study.followed_frames; };
  std::stable_sort(runs.begin(), runs.end(),
                   [](const Run* a, const Run* b) { return a->milliseconds < b->milliseconds; });
  Trajectory best;
  while (!runs.empty() && !best.complete) {
    Run& most_accurate = *runs.back();
    runs.pop_back();
    if (!most_accurate.best || seconds(most_accurate) > runner.allowance().left() / 2) continue;
    best = runner.make(most_accurate.candidate, level.level);
    if (!best.complete) continue;
    const double own = std::max(study.judged(most_accurate.time), study.floor(level.reference));
    const double growth = study.chaotic ? 1 : double(study.followed_frames) / study.frames;
    most_accurate.followed = growth * own;
    for (Run* run : runs) {
      const Trajectory trajectory = runner.make(run->candidate, level.level);
      if (trajectory.complete)
        run->followed = study.judged(errors_of(trajectory, best)) + *most_accurate.followed;
    }
  }
}

/// Each level within its share of the plan's time for it.
void follow_best(const SimulationDescription& description, const StudyPlan& plan,
                 const std::function<double()>& clock, const std::function<void()>& watch, Study& study) {
  constexpr int kKept = 120;  // frames, which bounds memory
  const int every = (plan.followed_frames + kKept - 1) / kKept;
  study.followed_frames = plan.followed_frames / every * every;
  const RunPlan followed{.frames = study.followed_frames, .kept_every = every};
  const double end = clock() + plan.follow_budget;
  for (std::size_t i = 0; i < study.levels.size(); ++i) {
    const double share = (end - clock()) * share_of(plan.levels, i);
    follow(study, Runner(description, followed, {clock, clock() + share}, watch), study.levels[i]);
  }
}

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
  const Runner runner(description, {.frames = study.frames}, {clock, begin + plan.budget}, watch);
  const std::vector<Candidate> all = candidates(plan.integrators, description.integrator);
  for (const Candidate& candidate :
       all) {  // every level's first candidates come before any level's second ones
    for (LevelStudy& level : study.levels) {
      Run& run = level.runs.emplace_back();
      run.candidate = candidate;
      if (level.reference.usable() && finest.usable()) {
        make_run(runner, level.reference, finest, run);
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
  if (plan.followed_frames > plan.frames) follow_best(description, plan, clock, watch, study);
  study.seconds = clock() - begin;
  return study;
}

}  // namespace weft::study
