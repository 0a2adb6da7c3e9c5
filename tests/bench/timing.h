#pragma once
/// How the benchmarks take time.
#include <time.h>

#include <algorithm>
#include <vector>

namespace weft::bench {

/// CPU time of this thread, ms: everything measured runs in one thread, and other programs on the machine do
/// not count.
inline double now() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace weft::bench
