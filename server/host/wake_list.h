#pragma once
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace weft::host {

/// Those whom any thread has woken, until the one thread that serves them goes round: as many as are woken
/// meanwhile are one task for it, not one each. Any thread may use it.
template <class Sleeper>
class WakeList {
 public:
  /// True if nobody was on it: then somebody must go_round().
  bool add(std::weak_ptr<Sleeper> sleeper) {
    const std::lock_guard lock(mutex_);
    woken_.push_back(std::move(sleeper));
    return woken_.size() == 1;
  }
  /// Calls wake(sleeper) for each that still is, without holding a lock. By one thread at a time.
  template <class Wake>
  void go_round(const Wake& wake) {
    {
      const std::lock_guard lock(mutex_);
      std::swap(woken_, round_);
    }
    for (std::weak_ptr<Sleeper>& each : round_) {
      if (const auto sleeper = std::exchange(each, {}).lock()) wake(*sleeper);
    }
    round_.clear();
  }

 private:
  std::mutex mutex_;
  std::vector<std::weak_ptr<Sleeper>> woken_;  ///< guarded by mutex_
  std::vector<std::weak_ptr<Sleeper>> round_;  ///< those of the round that is under way
};

}  // namespace weft::host
