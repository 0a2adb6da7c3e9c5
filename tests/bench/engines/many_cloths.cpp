#include "engines/many_cloths.h"

#include <stdexcept>

#include "cloth/world/simulation.h"
#include "scene/scene.h"
#include "timing.h"

namespace weft::bench {

SimulationDescription flags(int count, int level) {
  const scene::Result result = scene::load("flag");
  const auto* flag = std::get_if<scene::Scene>(&result);
  if (flag == nullptr) throw std::runtime_error("the preset flag does not load");
  SimulationDescription description = flag->simulation;
  description.integrator = Bdf2Description{};
  description.time_step = 1.0 / 60;
  description.sleep_speed = 0;  // every step is measured
  description.cloths[0].initial_level = description.cloths[0].max_level = level;
  description.cloths.assign(static_cast<std::size_t>(count), ClothDescription(description.cloths[0]));
  return description;
}

ManyCloths measure_flags(int count, int level) {
  constexpr int kWarmUp = 120, kMeasured = 120;  // frames
  Simulation<float> simulation(flags(count, level));
  for (int i = 0; i < kWarmUp; ++i) simulation.step();
  std::vector<double> times;
  for (int i = 0; i < kMeasured; ++i) {
    const double begin = now();
    simulation.step();
    times.push_back(now() - begin);
  }
  return {median(times), *std::min_element(times.begin(), times.end())};
}

}  // namespace weft::bench
