/// What a second thread is worth: the same scene on one thread and on two, in one run, frame by frame in
/// turns.
///   bench_threads [SECONDS]
/// Prints a Markdown table. In the wall time counts what else the machine does, so its load stands above; not
/// in the CPU time of the thread that steps, which works or waits busily all the while.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "cloth/core/parallel.h"
#include "cloth/world/simulation.h"
#include "engines/many_cloths.h"
#include "timing.h"

namespace weft::bench {
namespace {

constexpr int kWarmUp = 60;          // frames
constexpr double kFrame = 1e3 / 60;  // ms

double wall_now() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::milli>(now).count();
}

/// A scene on so many threads, and what its frames took.
class Runner {
 public:
  Runner(const SimulationDescription& scene, int threads) : simulation_(scene), threads_(threads) {}

  void step() {
    const ThreadLimit limit(threads_);
    const double wall = wall_now(), cpu = now();
    simulation_.step();
    wall_.push_back(wall_now() - wall);
    cpu_.push_back(now() - cpu);
  }
  void forget_times() {
    wall_.clear();
    cpu_.clear();
  }
  std::size_t frames() const { return wall_.size(); }
  double wall() const { return median(wall_); }
  double least_wall() const { return *std::min_element(wall_.begin(), wall_.end()); }
  double cpu() const { return median(cpu_); }

 private:
  Simulation<float> simulation_;
  int threads_;
  std::vector<double> wall_, cpu_;  ///< ms
};

void print(const char* title, int cloths, int level, double seconds) {
  Runner one(flags(cloths, level), 1), two(flags(cloths, level), 2);
  const auto step = [&] {
    one.step();
    two.step();
  };
  for (int frame = 0; frame < kWarmUp; ++frame) step();
  one.forget_times();
  two.forget_times();
  for (const double end = wall_now() + seconds * 1e3; wall_now() < end;) step();
  std::printf("| %s | %zu | %.2f (%.2f) | %.2f (%.2f) | %.2f (%.2f) | %.2f | %d |\n", title, one.frames(),
              one.wall(), one.least_wall(), two.wall(), two.least_wall(), one.wall() / two.wall(),
              one.least_wall() / two.least_wall(), one.cpu() / two.cpu(),
              static_cast<int>(cloths * kFrame / two.wall()));
  std::fflush(stdout);
}

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 10;
  if (!(seconds > 0)) {
    std::cerr << "usage: bench_threads [SECONDS]\n";
    return EXIT_FAILURE;
  }
  std::string load;
  std::getline(std::ifstream("/proc/loadavg") >> std::ws, load);
  std::printf(
      "Wall ms a frame, median (minimum), bdf2; %d threads in the machine, load before: %s\n\n"
      "| scene | frames | 1 thread | 2 threads | ratio | of CPU time | cloths at 60 Hz on 2 |\n"
      "|---|---|---|---|---|---|---|\n",
      hardware_threads(), load.c_str());
  print("300 flags of 17 x 17 nodes", 300, 4, seconds);
  print("64 flags of 33 x 33 nodes", 64, 5, seconds);
  print("2 flags of 33 x 33 nodes", 2, 5, seconds);
  print("1 flag of 129 x 129 nodes", 1, 7, seconds);
  print("1 flag of 257 x 257 nodes", 1, 8, seconds);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace weft::bench

int main(int argc, char** argv) { return weft::bench::main(argc, argv); }
