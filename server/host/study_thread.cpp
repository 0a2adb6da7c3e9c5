#include "host/study_thread.h"

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "cloth/core/interrupt.h"
#include "cloth/core/parallel.h"
#include "cloth/core/subnormals.h"
#include "study/thread_time.h"

namespace weft::host {
namespace {

constexpr double kHorizon = 2;                      // s of the scene in which every way to step it is tried
constexpr double kFollowed = 10;                    // s of it over which the best of them are followed
constexpr double kBudget = 40, kFollowBudget = 20;  // s of processor time
/// s of processor time: what is not known by then is too large a scene to be studied beside its viewers.
constexpr double kDeadline = 200;
constexpr double kTarget = 1e-4;  // of the references, in cloth sizes: 0.2 mm of a cloth of 2 m
constexpr int kNiceness = 10;     // viewers' frames come first

struct TooLong {};

/// One study at a time.
class Turn {
 public:
  /// Waits for its turn; has() is false if the stop came first.
  explicit Turn(const std::stop_token& stop) {
    std::unique_lock lock(mutex);
    has_ = freed.wait(lock, stop, [] { return !taken; });
    if (has_) taken = true;
  }
  ~Turn() {
    if (!has_) return;
    const std::lock_guard lock(mutex);
    taken = false;
    freed.notify_one();
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  bool has() const { return has_; }

 private:
  static inline std::mutex mutex;
  static inline std::condition_variable_any freed;
  static inline bool taken = false;
  bool has_ = false;
};

study::StudyPlan plan_of(const SimulationDescription& description) {
  study::StudyPlan plan;
  plan.levels = study::levels_of(description);
  plan.integrators = study::integrator_names();
  const auto frames = [&](double span) { return std::round(span / description.time_step); };
  plan.frames = static_cast<int>(std::clamp(frames(kHorizon), 1.0, double{study::kMaxFrames}));
  plan.followed_frames = static_cast<int>(std::max(frames(kFollowed), 1.0));
  plan.budget = kBudget;
  plan.follow_budget = kFollowBudget;
  plan.target = kTarget;
  return plan;
}

StudyOutcome study_of(const SimulationDescription& description) {
  // By processor time a busy machine makes a study later, not worse.
  const double deadline = study::thread_time() + kDeadline;
  const auto watch = [&] {
    check_interrupt(0);
    if (study::thread_time() > deadline) throw TooLong();
  };
  try {
    StudyOutcome outcome{
        study::choices_of(study::study_cost(description, plan_of(description), study::thread_time, watch)),
        {}};
    if (outcome.choices.levels.empty())
      outcome.why = "no way to step the scene stayed sound in the time there was";
    return outcome;
  } catch (const TooLong&) {
    return {{}, "the scene is too large to be measured while it is shown; weft cost takes its time"};
  } catch (const std::exception& error) {
    return {{}, error.what()};
  }
}

}  // namespace

StudyThread::StudyThread(std::function<void(std::uint64_t, StudyOutcome)> done)
    : done_(std::move(done)), thread_([this](const std::stop_token& end) { run(end); }) {}

StudyThread::~StudyThread() {
  thread_.request_stop();
  give_up();
}

void StudyThread::begin(std::uint64_t number, SimulationDescription description) {
  {
    const std::lock_guard lock(mutex_);
    in_hand_.request_stop();
    in_hand_ = std::stop_source();
    next_.emplace(Job{number, std::move(description), in_hand_});
  }
  work_.notify_one();
}

void StudyThread::give_up() {
  const std::lock_guard lock(mutex_);
  in_hand_.request_stop();
  next_.reset();
}

std::optional<StudyThread::Job> StudyThread::wait_for_job(const std::stop_token& end) {
  std::unique_lock lock(mutex_);
  work_.wait(lock, end, [this] { return next_.has_value(); });
  return std::exchange(next_, std::nullopt);
}

void StudyThread::run(const std::stop_token& end) {
  pthread_setname_np(pthread_self(), "weft study");
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);
  flush_subnormals();
  while (auto job = wait_for_job(end)) carry_out(*job);
}

void StudyThread::carry_out(Job& job) {
  const std::stop_token stop = job.stop.get_token();
  const Turn turn(stop);
  if (!turn.has()) return;
  try {
    const Interruptible interruptible(&stop);
    // Whose processor time is what is measured; the scene's own threads stay with the scene.
    StudyOutcome outcome;
    call_alone([&] { outcome = study_of(job.description); });
    done_(job.number, std::move(outcome));
  } catch (const Interrupted&) {  // nobody is left to be told
  }
}

}  // namespace weft::host
