#include "host/scene_runner.h"

#include <pthread.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "cloth/core/interrupt.h"
#include "cloth/core/subnormals.h"
#include "host/live_scene.h"
#include "host/scene_messages.h"
#include "host/server_clock.h"
#include "host/study_thread.h"

namespace weft::host {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kStatsPeriod = std::chrono::milliseconds(500);
/// Between what is published without a step in real time.
constexpr auto kPublishPeriod = std::chrono::milliseconds(16);

struct Join {};
struct Leave {
  bool lost;
};
struct Studied {
  std::uint64_t number;  ///< LiveScene::study_number()
  StudyOutcome outcome;
};

}  // namespace

struct SceneRunner::Task {
  std::shared_ptr<Viewer> viewer;
  std::uint64_t visit;
  std::variant<Join, Leave, SceneRequest, Call, Studied> what;
};

SceneRunner::SceneRunner(scene::Scene scene, const protocol::Limits& limits, Metrics& metrics,
                         const LogPlaces& places, const std::optional<Playing>& playing)
    : name_(scene.name),
      title_(scene.title),
      cloths_(scene.simulation.cloths.size()),
      max_viewers_(limits.viewers),
      time_step_(scene.simulation.time_step),
      meshes_(mesh_texts(scene.simulation)),
      metrics_(metrics),
      scene_metrics_(metrics.of_scene(scene.name)),
      log_(places.empty() ? nullptr : std::make_unique<SceneLog>(scene, places, scene_metrics_)),
      live_(std::make_unique<LiveScene>(std::move(scene), limits, playing)),
      clock_(time_step_),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

SceneRunner::~SceneRunner() = default;

Clock::duration SceneRunner::busy_for() const {
  const Clock::rep since = busy_since_;
  return since == 0 ? Clock::duration(0) : Clock::now().time_since_epoch() - Clock::duration(since);
}

bool SceneRunner::reserve() {
  int seated = viewers_;
  while (seated < max_viewers_) {
    if (viewers_.compare_exchange_weak(seated, seated + 1)) return true;
  }
  return false;
}

void SceneRunner::join(std::shared_ptr<Viewer> viewer, std::uint64_t visit) {
  post({std::move(viewer), visit, Join{}});
}

void SceneRunner::leave(std::shared_ptr<Viewer> viewer, std::uint64_t visit, bool lost) {
  post({std::move(viewer), visit, Leave{lost}});
}

bool SceneRunner::submit(const std::shared_ptr<Viewer>& viewer, std::uint64_t visit,
                         std::variant<SceneRequest, Call> what) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= kMaxWaiting) return false;
    viewer->command_given();
    std::visit([&](auto& each) { waiting_.push_back({viewer, visit, std::move(each)}); }, what);
  }
  work_.notify_one();
  return true;
}

void SceneRunner::post(Task task) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(task));
  }
  work_.notify_one();
}

void SceneRunner::run(const std::stop_token& stop) {
  pthread_setname_np(pthread_self(), ("weft " + name_).substr(0, 15).c_str());
  flush_subnormals();
  const Interruptible interruptible(&stop);
  try {
    if (log_) log_->begin(*live_);
    frame_ = live_->simulation().step_count();
    while (!stop.stop_requested()) {
      std::vector<Task> tasks = wait_for_work(stop);
      busy_since_ = Clock::now().time_since_epoch().count();
      for (Task& task : tasks) carry_out(task);
      live_->release_lost(Clock::now());
      study_if_wanted();
      const bool stepped = step_if_due();
      // Before the frame goes out, so that hardly anything that was seen is forgotten.
      if (log_) log_->tend(*live_, !tasks.empty());
      // Before the frame goes out: who has seen it must not be told an older step.
      frame_ = live_->simulation().step_count();
      publish_if_due(stepped);
      send_stats_if_due();
      busy_since_ = 0;
    }
    if (log_) log_->end(*live_);
  } catch (const Interrupted&) {  // the scene ends in the midst of a step
  }
  live_->record({});
  if (log_ && forgotten_) log_->forget();
  log_.reset();  // writes what waits
  study_.reset();
}

std::vector<SceneRunner::Task> SceneRunner::wait_for_work(const std::stop_token& stop) {
  const auto has_work = [this] { return !waiting_.empty(); };
  std::unique_lock lock(mutex_);
  if (live_->empty()) {
    work_.wait(lock, stop, has_work);
  } else {
    work_.wait_until(lock, stop, next_work(), has_work);
  }
  return std::exchange(waiting_, {});
}

StepClock::TimePoint SceneRunner::next_work() const {
  if (live_->wants_step()) return running_ ? std::min(clock_.next(), stats_due_) : Clock::now();
  return live_->has_news() ? std::min(publish_due_, stats_due_) : stats_due_;
}

void SceneRunner::carry_out(Task& task) {
  if (const auto* request = std::get_if<SceneRequest>(&task.what)) {
    if (const auto code = live_->apply(task.viewer, task.visit, *request)) metrics_.refused_command(*code);
    task.viewer->command_answered();
  } else if (const auto* call = std::get_if<Call>(&task.what)) {
    (*call)();
    task.viewer->command_answered();
  } else if (auto* studied = std::get_if<Studied>(&task.what)) {
    if (studied->number == live_->study_number()) live_->take_study(std::move(studied->outcome));
  } else if (std::holds_alternative<Join>(task.what)) {
    if (live_->empty()) stats_due_ = Clock::now();
    live_->add_viewer(task.viewer, task.visit);
  } else {
    if (std::get<Leave>(task.what).lost) {
      live_->lose_viewer(task.viewer.get(), task.visit, Clock::now() + kSeatKept);
    } else {
      live_->remove_viewer(task.viewer.get(), task.visit);
    }
    scene_metrics_.viewers(live_->viewers_by_level());
    scene_metrics_.limited(live_->limited_viewers());
    if (live_->empty()) scene_metrics_.rate(0);
  }
}

bool SceneRunner::step_if_due() {
  const bool in_real_time = live_->wants_step() && !live_->paused();
  if (in_real_time && !running_) clock_.start(Clock::now());
  running_ = in_real_time;
  if (!live_->wants_step() || (running_ && Clock::now() < clock_.next())) return false;
  live_->step();
  count_step();
  for (const std::string& text : live_->take_warnings()) spdlog::warn("scene {}: {}", name_, text);
  if (!running_) {
    ++steps_made_;
    return true;
  }
  clock_.stepped(Clock::now());
  if (clock_.slow() != live_->slow()) {
    spdlog::warn("scene {}: clock {}", name_,
                 clock_.slow() ? "runs behind real time" : "is in real time again");
    live_->set_slow(clock_.slow());
  }
  return true;
}

void SceneRunner::count_step() {
  const Simulation<float>& simulation = live_->simulation();
  SceneMetrics::Step step{simulation.profile().total, running_ ? time_step_ : 0};
  for (std::size_t i = 0; i < simulation.cloths().size(); ++i) {
    step.energy_lost += simulation.last_advance(i).energy_lost;
    step.energy_given_back += simulation.last_advance(i).energy_given_back;
  }
  scene_metrics_.stepped(step);
  scene_metrics_.guarded(live_->guard_counts());
}

void SceneRunner::publish_if_due(bool stepped) {
  const auto now = Clock::now();
  // A step in real time is shown at once, and so is the last of those asked for. What changes more often, by
  // commands or steps asked for, is shown so many times a second.
  const bool shown_at_once = stepped && (running_ || !live_->wants_step());
  if (!shown_at_once && now < publish_due_) return;
  if (live_->frame_due() || !running_) live_->tell_events();
  live_->publish(server_ms());
  scene_metrics_.encoded(live_->encoder().encodes() - encodes_);
  encodes_ = live_->encoder().encodes();
  publish_due_ = now + kPublishPeriod;
}

void SceneRunner::study_if_wanted() {
  const std::uint64_t number = live_->study_number();
  if (study_number_ && *study_number_ != number) {
    study_->give_up();
    study_number_.reset();
  }
  if (study_number_ || !live_->wants_study()) return;
  if (!study_) {
    study_ = std::make_unique<StudyThread>([this](std::uint64_t of, StudyOutcome outcome) {
      post({nullptr, 0, Studied{of, std::move(outcome)}});
    });
  }
  study_number_ = number;
  study_->begin(number, live_->studied());
}

void SceneRunner::send_stats_if_due() {
  const auto now = Clock::now();
  if (live_->empty() || now < stats_due_) return;
  scene_metrics_.viewers(live_->viewers_by_level());
  const StepClock::Seconds since = now - stats_sent_;
  const double made = static_cast<double>(std::exchange(steps_made_, 0)) * time_step_ / since.count();
  const double rate = running_ ? clock_.rate() : made;
  scene_metrics_.rate(rate);
  live_->send_stats(rate);
  scene_metrics_.limited(live_->limited_viewers());
  stats_sent_ = now;
  stats_due_ = std::max(stats_due_ + kStatsPeriod, now);
}

}  // namespace weft::host
