#include "host/scene_runner.h"

#include <pthread.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "host/arithmetic.h"
#include "host/scene_messages.h"

namespace weft::host {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kStatsPeriod = std::chrono::milliseconds(500);

std::uint32_t server_ms() {
  const auto now = Clock::now().time_since_epoch();
  return static_cast<std::uint32_t>(std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}

}  // namespace

SceneRunner::SceneRunner(scene::Scene scene, const protocol::Limits& limits)
    : name_(scene.name),
      title_(scene.title),
      cloths_(scene.simulation.cloths.size()),
      max_viewers_(limits.viewers),
      time_step_(scene.simulation.time_step),
      meshes_(mesh_texts(scene.simulation)),
      live_(std::move(scene), limits),
      clock_(time_step_),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

SceneRunner::~SceneRunner() = default;

bool SceneRunner::reserve() {
  int seated = viewers_;
  while (seated < max_viewers_) {
    if (viewers_.compare_exchange_weak(seated, seated + 1)) return true;
  }
  return false;
}

bool SceneRunner::submit(const std::shared_ptr<Viewer>& viewer, std::uint64_t visit,
                         const SceneRequest& request) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= kMaxWaiting) return false;
    waiting_.push_back({viewer, visit, request});
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
  while (!stop.stop_requested()) {
    for (Task& task : wait_for_work(stop)) carry_out(task);
    study_if_wanted();
    step_if_due();
    // Before the frame goes out: who has seen it must not be told an older step.
    frame_ = live_.simulation().step_count();
    live_.publish(server_ms());
    send_stats_if_due();
    encodes_ = live_.encoder().encodes();
  }
}

std::vector<SceneRunner::Task> SceneRunner::wait_for_work(const std::stop_token& stop) {
  const auto has_work = [this] { return !waiting_.empty(); };
  std::unique_lock lock(mutex_);
  if (live_.empty()) {
    work_.wait(lock, stop, has_work);
  } else {
    const auto until = live_.wants_step() && running_ ? std::min(clock_.next(), stats_due_) : stats_due_;
    work_.wait_until(lock, stop, live_.wants_step() && !running_ ? Clock::now() : until, has_work);
  }
  return std::exchange(waiting_, {});
}

void SceneRunner::carry_out(Task& task) {
  if (const auto* request = std::get_if<SceneRequest>(&task.what)) {
    live_.apply(task.viewer, task.visit, *request);
  } else if (auto* studied = std::get_if<Studied>(&task.what)) {
    if (studied->number == live_.study_number()) live_.take_study(std::move(studied->outcome));
  } else if (std::holds_alternative<Join>(task.what)) {
    if (live_.empty()) stats_due_ = Clock::now();
    live_.add_viewer(task.viewer, task.visit);
  } else {
    live_.remove_viewer(task.viewer.get(), task.visit);
  }
}

void SceneRunner::step_if_due() {
  if (!live_.wants_step()) {
    running_ = false;
    return;
  }
  if (!running_) clock_.start(Clock::now());
  running_ = true;
  if (Clock::now() < clock_.next()) return;
  live_.step();
  clock_.stepped(Clock::now());
  if (clock_.slow() != live_.slow()) {
    spdlog::warn("scene {}: clock {}", name_,
                 clock_.slow() ? "runs behind real time" : "is in real time again");
    live_.set_slow(clock_.slow());
  }
  for (const std::string& text : live_.take_guard_texts()) spdlog::warn("scene {}: {}", name_, text);
}

void SceneRunner::study_if_wanted() {
  const std::uint64_t number = live_.study_number();
  if (study_ && study_number_ != number) study_.reset();
  if (study_ || !live_.wants_study()) return;
  study_number_ = number;
  study_.emplace(live_.studied(), [this, number](StudyOutcome outcome) {
    post({nullptr, 0, Studied{number, std::move(outcome)}});
  });
}

void SceneRunner::send_stats_if_due() {
  const auto now = Clock::now();
  if (live_.empty() || now < stats_due_) return;
  live_.send_stats(clock_.rate());
  stats_due_ = std::max(stats_due_ + kStatsPeriod, now);
}

}  // namespace weft::host
