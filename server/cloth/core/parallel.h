#pragma once
#include <functional>
#include <memory>

/// Work spread over the threads of a task pool (oneTBB, which only parallel.cpp knows). Which thread does
/// what is chance; a simulation therefore gives every task results of its own to write, and puts them
/// together in an order that no thread has a say in.
namespace weft {

/// Threads that this process may run on at a time.
int hardware_threads();

/// As long as it lives, a thread that steps a simulation gets help from at most `threads` - 1 others; all
/// simulations of the process share these. Without one there are as many as hardware_threads(). Of several
/// the smallest counts.
class ThreadLimit {
 public:
  /// Throws std::invalid_argument unless threads >= 1.
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Calls work, and gives it no help: what it does stays on the calling thread, whatever others may do.
void call_alone(const std::function<void()>& work);

/// Calls task(work, i) as parallel_for does.
void parallel_call(int count, void (*task)(const void* work, int i), const void* work);

/// Calls work(i) once for every i of [0, count), on the calling thread and any others that are free, and
/// returns when all is done. The caller's rounding, subnormal numbers and interrupt.h hold for all of them.
/// One of the exceptions thrown, if any, goes on to the caller. May be called from within work.
template <class Work>
void parallel_for(int count, const Work& work) {
  parallel_call(
      count, [](const void* w, int i) { (*static_cast<const Work*>(w))(i); }, &work);
}

}  // namespace weft
