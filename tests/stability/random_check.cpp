// What a random scene is held to.
#include <algorithm>
#include <cmath>

#include "criteria.h"
#include "random_scenes.h"

namespace weft::stability {
namespace {

constexpr double kSeconds = 2;

Method method_of(const IntegratorDescription& integrator) {
  constexpr Method kMethods[] = {Method::symplectic_euler, Method::backward_euler, Method::bdf2,
                                 Method::xpbd};
  return kMethods[integrator.index()];
}

/// Work of a steady force of so many newtons on a body of so many kilograms, J.
double work_of_force(double force, double mass, double speed) {
  return force * (speed * kSeconds + force / mass * kSeconds * kSeconds / 2);
}

/// Upper bound of what wind and balls can do on the cloth in the time, J. Generous: it parts what is bounded
/// from what runs away.
double input(const SimulationDescription& scene) {
  const ClothDescription& cloth = scene.cloths[0];
  const double area = cloth.size.x() * cloth.size.y(), mass = cloth.material.density * area;
  const Grid grid = cloth.base_cells.at(cloth.max_level);
  const double spacing = std::min(cloth.size.x() / (grid.cols - 1), cloth.size.y() / (grid.rows - 1));
  const double speed = cloth.velocity.norm(), wind = scene.wind.speed;
  double work = 0;
  for (const EffectDescription& effect : scene.effects) {
    if (const auto* air = std::get_if<AerodynamicsEffect>(&effect)) {
      work += air->air_density * air->drag * wind * wind / 2 * area * wind * kSeconds;
    } else if (const auto* steady = std::get_if<PaperWindEffect>(&effect)) {
      const double pushed = cloth.discretization == Discretization::paper ? grid.nodes() : area;
      work += work_of_force(steady->factor * wind * pushed, mass, speed);
    }
  }
  const double stiffness = cloth.material.structural + cloth.material.shear + 4 * cloth.material.bending;
  for (const BallDescription& each : scene.balls) {
    double fastest = each.velocity.norm(), way = fastest * kSeconds;
    for (std::size_t i = 1; i < each.path.size(); ++i) {
      const double length = (each.path[i].position - each.path[i - 1].position).norm();
      fastest = std::max(fastest, length / (each.path[i].time - each.path[i - 1].time));
      way += length;
    }
    // Nodes inside are put on its surface at once; others may fly off at twice its speed, or be pulled along.
    const double stretch = (each.radius + std::min(way, 10 * cloth.size.maxCoeff())) / spacing;
    work += mass * 4 * fastest * fastest / 2 + stiffness * area * stretch * stretch;
  }
  return work;
}

}  // namespace

Complaint check(const SimulationDescription& scene) {
  const Setup setup{method_of(scene.integrator), 0, 0};
  Simulation<float> simulation(scene);
  const EnergyBound bound = energy_bound(simulation, setup, input(scene));
  const ClothDescription& cloth = scene.cloths[0];
  const int levels = cloth.max_level - cloth.min_level;
  const auto period = static_cast<long>(1 + scene.seed % 16);
  const long steps = std::lround(kSeconds / scene.time_step);
  for (long step = 0; step < steps; ++step) {
    if (levels > 0 && step % period == 0) {
      const long turn = step / period % (2 * levels);
      simulation.request_level(0, cloth.min_level + static_cast<int>(std::min(turn, 2 * levels - turn)));
    }
    simulation.step();
    const std::string when = " after step " + std::to_string(step + 1);
    if (!simulation.healthy()) return "not finite" + when;
    const double rise = read(simulation, setup.method != Method::xpbd).energy - bound.start;
    if (!(rise <= bound.allowed)) {
      return "energy " + std::to_string(rise) + " J above the start's, allowed " +
             std::to_string(bound.allowed) + when;
    }
  }
  return {};
}

}  // namespace weft::stability
