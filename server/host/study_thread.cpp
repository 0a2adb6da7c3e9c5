#include "host/study_thread.h"

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <utility>

#include "cloth/parallel.h"
#include "host/arithmetic.h"
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

struct GivenUp {};
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

StudyOutcome study_of(const SimulationDescription& description, const std::stop_token& stop) {
  // By processor time a busy machine makes a study later, not worse.
  const double deadline = study::thread_time() + kDeadline;
  const auto watch = [&] {
    if (stop.stop_requested()) throw GivenUp();
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

StudyThread::StudyThread(SimulationDescription description, std::function<void(StudyOutcome)> done)
    : thread_([description = std::move(description), done = std::move(done)](const std::stop_token& stop) {
        pthread_setname_np(pthread_self(), "weft study");
        setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);
        flush_subnormals();
        const Turn turn(stop);
        if (!turn.has()) return;
        try {
          // Whose processor time is what is measured; the scene's own threads stay with the scene.
          StudyOutcome outcome;
          call_alone([&] { outcome = study_of(description, stop); });
          done(std::move(outcome));
        } catch (const GivenUp&) {  // nobody is left to be told
        }
      }) {}

}  // namespace weft::host
