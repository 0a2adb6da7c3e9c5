/// What relevance saves: ten flags, of which the only viewer sees one, stepped and encoded as the server does
/// it.
///   bench_relevance [SECONDS]
/// Prints a Markdown table: the ways to deal with the nine, frame by frame in turns, on one thread.
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "cloth/core/parallel.h"
#include "engines/many_cloths.h"
#include "host/live_scene.h"
#include "timing.h"

namespace weft::bench {
namespace {

constexpr int kFlags = 10;
constexpr int kWarmUp = 120;  // frames: the viewer has turned away from the nine a second ago

/// Flags 10 m from one another, at level 6 however far away they are.
scene::Scene flags_of(Relevance::Unseen unseen) {
  scene::Scene scene;
  scene.name = "flags";
  scene.simulation = flags(kFlags, 6);
  scene.simulation.level_policy = {{}, {6}, 0};
  for (std::size_t i = 0; i < scene.simulation.cloths.size(); ++i) {
    ClothDescription& cloth = scene.simulation.cloths[i];
    cloth.position = {10.0 * static_cast<double>(i), 0, 0};
    cloth.min_level = 4;
    cloth.relevance.unseen = unseen;
  }
  return scene;
}

class Served {
 public:
  explicit Served(Relevance::Unseen unseen)
      : live_(flags_of(unseen), {}), viewer_(std::make_shared<host::Viewer>()) {
    const std::uint64_t visit = viewer_->enter();
    live_.add_viewer(viewer_, visit);
    // At the first one, from 4 m: the others are 68 degrees aside and more.
    const protocol::Camera camera{
        .eye = protocol::Vector{0, 0, 4}, .target = protocol::Vector{0, 0, 0}, .half_angle = 0.7};
    live_.apply(viewer_, visit, {std::nullopt, camera});
  }

  void frame() {
    const double begin = now();
    live_.step();
    live_.publish(0);
    times_.push_back(now() - begin);
    while (const auto next = viewer_->take()) {
      if (!next->frame) continue;
      for (const host::Record& record : next->frame->records) bytes_ += static_cast<double>(record->size());
    }
  }
  void forget() {
    times_.clear();
    bytes_ = 0;
  }
  std::size_t frames() const { return times_.size(); }
  double milliseconds() const { return median(times_); }
  double kilobytes() const { return bytes_ / 1e3 / static_cast<double>(frames()); }

 private:
  host::LiveScene live_;
  std::shared_ptr<host::Viewer> viewer_;
  std::vector<double> times_;  ///< ms
  double bytes_ = 0;
};

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 20;
  if (!(seconds > 0)) {
    std::cerr << "usage: bench_relevance [SECONDS]\n";
    return EXIT_FAILURE;
  }
  const ThreadLimit one_thread(1);
  Served step(Relevance::Unseen::step), coarse(Relevance::Unseen::coarse), sleep(Relevance::Unseen::sleep);
  const auto frame = [&] {
    for (Served* each : {&step, &coarse, &sleep}) each->frame();
  };
  for (int i = 0; i < kWarmUp; ++i) frame();
  for (Served* each : {&step, &coarse, &sleep}) each->forget();
  for (const double end = now() + seconds * 1e3; now() < end;) frame();

  std::printf(
      "| the nine that are not seen | ms a frame (median of %zu) | share | kB a frame |\n|---|---|---|---|\n",
      step.frames());
  const auto row = [&](const char* name, const Served& served) {
    std::printf("| %s | %.2f | %.3f | %.1f |\n", name, served.milliseconds(),
                served.milliseconds() / step.milliseconds(), served.kilobytes());
  };
  row("`step`", step);
  row("`coarse`", coarse);
  row("`sleep`", sleep);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace weft::bench

int main(int argc, char** argv) { return weft::bench::main(argc, argv); }
