#include "engines/frame_cost.h"

#include <string_view>

#include "cloth/world/simulation.h"
#include "engines/engine_scene.h"
#include "timing.h"

namespace weft::bench {

double frame_cost(const char* integrator, int level) {
  constexpr double kLeastTime = 200;  // ms of measuring
  constexpr int kWarmUp = 20, kLeastFrames = 10;
  IntegratorDescription method = SymplecticEulerDescription{};
  if (integrator == std::string_view(XpbdDescription::kName)) method = XpbdDescription{};
  if (integrator == std::string_view(Bdf2Description::kName)) method = Bdf2Description{};
  Simulation<float> simulation(describe({'H', level, 2.0}, 50'000, method));
  for (int i = 0; i < kWarmUp; ++i) simulation.step();
  std::vector<double> times;
  for (double spent = 0; spent < kLeastTime || times.size() < kLeastFrames; spent += times.back()) {
    const double begin = now();
    simulation.step();
    times.push_back(now() - begin);
  }
  return median(times);
}

}  // namespace weft::bench
