#include "cloth/core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <stdexcept>
#include <string>

#include "cloth/core/interrupt.h"

#if defined(WEFT_THREAD_SANITIZER)
#include <sanitizer/tsan_interface.h>

/// What TBB itself frees is ordered by atomics that the sanitizer does not see. This concerns calls that TBB
/// makes, not the tasks it runs.
extern "C" const char* __tsan_default_suppressions() { return "called_from_lib:libtbb.so"; }
#endif

namespace weft {
namespace {

/// The thread sanitizer sees nothing of how TBB, which is built without it, orders threads; this file is
/// built without it too (CMakeLists.txt). So it is told what TBB guarantees, and no more: what was before the
/// call is before every task, and every task is before the return. Tasks stay unordered among themselves.
class Order {
 public:
#if defined(WEFT_THREAD_SANITIZER)
  void publish() { __tsan_release(&begin_); }
  void task_begins() { __tsan_acquire(&begin_); }
  void task_ends() { __tsan_release(&end_); }
  void gather() { __tsan_acquire(&end_); }

 private:
  char begin_ = 0, end_ = 0;
#else
  void publish() {}
  void task_begins() {}
  void task_ends() {}
  void gather() {}
#endif
};

}  // namespace

struct ThreadLimit::Impl {
  explicit Impl(int threads)
      : control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)) {}
  tbb::global_control control;
};

int hardware_threads() { return tbb::info::default_concurrency(); }

ThreadLimit::ThreadLimit(int threads) {
  if (threads < 1) throw std::invalid_argument("cannot work on " + std::to_string(threads) + " threads");
  impl_ = std::make_unique<Impl>(threads);
}
ThreadLimit::~ThreadLimit() = default;

void call_alone(const std::function<void()>& work) {
  tbb::task_arena(1).execute(work);  // an arena of one, which is the caller
}

void parallel_call(int count, void (*task)(const void* work, int i), const void* work) {
  if (count == 1) return task(work, 0);
  Order order;
  order.publish();
  // With the caller's floating-point mode: the pool's threads have one of their own otherwise.
  tbb::task_group_context context(
      tbb::task_group_context::isolated,
      tbb::task_group_context::default_traits | tbb::task_group_context::fp_settings);
  const std::stop_token* stop = Interruptible::current();
  const auto run = [&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, count, 1),
        [&](const tbb::blocked_range<int>& range) {
          order.task_begins();
          const Interruptible interruptible(stop);
          for (int i = range.begin(); i < range.end(); ++i) task(work, i);
          order.task_ends();
        },
        tbb::simple_partitioner(), context);
  };
  // Isolated: while it waits for the last of a cloth's rows a thread does not begin with another cloth.
  tbb::this_task_arena::isolate(run);
  order.gather();
}

}  // namespace weft
