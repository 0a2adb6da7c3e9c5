#include "study/trajectory.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "cloth/world/simulation.h"
#include "study/thread_time.h"

namespace weft::study {
namespace {

int kept_every(int level) { return 1 << std::max(0, level - kKeptLevel); }

template <class Real>
std::vector<Sheet> sheets_of(const Simulation<Real>& simulation) {
  std::vector<Sheet> sheets;
  for (const Cloth<Real>& cloth : simulation.cloths()) {
    const Grid& grid = cloth.particles().grid();
    const int every = kept_every(cloth.level());
    sheets.push_back(
        {(grid.rows - 1) / every + 1, (grid.cols - 1) / every + 1, cloth.description().size.maxCoeff()});
  }
  return sheets;
}

template <class Real>
Frame frame_of(const Simulation<Real>& simulation) {
  Frame frame;
  const auto cloths = static_cast<double>(simulation.cloths().size());
  for (std::size_t i = 0; i < simulation.cloths().size(); ++i) {
    const Cloth<Real>& cloth = simulation.cloths()[i];
    const Grid& grid = cloth.particles().grid();
    const int every = kept_every(cloth.level());
    for (int r = 0; r < grid.rows; r += every) {
      for (int c = 0; c < grid.cols; c += every) {
        const Vec3 position = cloth.particles().position_at(r, c);
        frame.positions.insert(frame.positions.end(), {position.x(), position.y(), position.z()});
      }
    }
    const ClothReport report = simulation.report(i);
    frame.kinetic_energy += report.kinetic_energy;
    frame.potential_energy += report.potential_energy;
    frame.mean_strain += report.strain.mean / cloths;
    frame.max_strain = std::max(frame.max_strain, report.strain.max);
    frame.max_compression = std::max(frame.max_compression, report.strain.max_compression);
  }
  frame.centre = simulation.centre(0);
  return frame;
}

template <class Real>
void disturb(Cloth<Real>& cloth, double share) {
  Particles<Real>& particles = cloth.particles();
  const double most = share * cloth.description().size.maxCoeff();
  std::mt19937_64 random(1);
  const auto offset = [&] {  // the upper 53 bits: a distribution's bits are not fixed by the standard
    return static_cast<Real>(most * (static_cast<double>(random() >> 11) * 0x1p-52 - 1.0));
  };
  for (int r = 0; r < particles.grid().rows; ++r) {
    for (int c = 0; c < particles.grid().cols; ++c) {
      if (particles.inverse_mass.at(r, c) == Real(0)) continue;
      particles.position.x.at(r, c) += offset();
      particles.position.y.at(r, c) += offset();
      particles.position.z.at(r, c) += offset();
    }
  }
}

}  // namespace

double Trajectory::milliseconds_per_frame() const {
  if (step_seconds.empty()) return 0;
  std::vector<double> sorted = step_seconds;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return 1e3 * *middle;
}

template <class Real>
Simulation<Real> at_level(SimulationDescription description, int level) {
  for (ClothDescription& cloth : description.cloths) {
    cloth.min_level = std::min(cloth.min_level, level);
    cloth.max_level = std::max(cloth.max_level, level);
  }
  description.sleep_speed = 0;
  Simulation<Real> simulation(std::move(description));
  for (Cloth<Real>& cloth : simulation.cloths()) {
    cloth.request_level(level);
    cloth.apply_pending_level();
  }
  return simulation;
}

template <class Real>
Trajectory simulate(SimulationDescription description, const RunPlan& plan, const Watch& watch) {
  Simulation<Real> simulation = at_level<Real>(std::move(description), plan.level);
  if (plan.disturbance > 0) {
    for (Cloth<Real>& cloth : simulation.cloths()) disturb(cloth, plan.disturbance);
  }
  Trajectory run;
  run.time_step = plan.kept_every * simulation.description().time_step;
  run.sheets = sheets_of(simulation);
  run.frames.push_back(frame_of(simulation));
  // No number of substeps mends a start that is not finite.
  run.sound = std::isfinite(run.frames[0].kinetic_energy + run.frames[0].potential_energy);
  if (!run.sound) return run;
  for (int frame = 1; frame <= plan.frames; ++frame) {
    const double begin = thread_time();
    simulation.step();
    run.step_seconds.push_back(thread_time() - begin);
    const auto& events = simulation.guard_events();
    run.sound =
        simulation.healthy() && std::all_of(events.begin(), events.end(), [](const GuardEvent& event) {
          return event.fault == Fault::crowded;  // not the step's doing
        });
    if (!run.sound) return run;
    if (frame % plan.kept_every == 0) run.frames.push_back(frame_of(simulation));
    if (!watch(frame) && frame < plan.frames) return run;
  }
  for (std::size_t i = 0; i < simulation.cloths().size(); ++i) {
    run.substeps = std::max(run.substeps, simulation.last_advance(i).substeps);
  }
  run.complete = true;
  return run;
}

template Simulation<float> at_level(SimulationDescription, int);
template Simulation<double> at_level(SimulationDescription, int);
template Trajectory simulate<float>(SimulationDescription, const RunPlan&, const Watch&);
template Trajectory simulate<double>(SimulationDescription, const RunPlan&, const Watch&);

}  // namespace weft::study
