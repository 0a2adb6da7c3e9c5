#include "scene/pin_check.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <string>

#include "cloth/forces/soft_pins.h"
#include "cloth/kernels/node_vector.h"
#include "cloth/shapes/mass_properties.h"
#include "cloth/sheet/start.h"

namespace weft::scene {
namespace {

using nlohmann::json;

/// A pin on a collider that may fly: it must be soft, and all of them on it softer than the step bears. `is`
/// begins what is said of it.
void check_pull(const PinRegion& pin, const SimulationDescription& simulation, const std::string& at,
                const std::string& is, double mass, Report& report) {
  if (!pin.stiffness) {
    report.add(at, is + "that one may fly, and a pin on it needs a stiffness");
    return;
  }
  double all = 0;
  for (const ClothDescription& cloth : simulation.cloths) {
    for (const PinRegion& other : cloth.pins) {
      if (other.obstacle == pin.obstacle && other.ball == pin.ball) all += other.stiffness.value_or(0);
    }
  }
  const double most = kPinBound * mass / (simulation.time_step * simulation.time_step);
  if (all > most) {
    report.add(at, is + "that one has " + json(mass).dump() + " kg, and all pins on it a stiffness of " +
                       json(all).dump() + " N/m; at most " + json(most).dump() +
                       " N/m are allowed, a quarter of mass / time_step^2");
  }
}

/// Beyond kPinBound: a pin at a ball's rim, where 1 / mass + r^2 / inertia is 3.5 / mass.
constexpr double kAtRim = 3.5;

/// Of the places, from where a body is, that a pin holds as the scene begins, the farthest, m.
double lever_of(const PinRegion& pin, const ClothDescription& cloth, const Vec3& centre) {
  const Particles<double> particles = start<double>(cloth, cloth.initial_level);
  double lever = 0;
  for (const std::size_t node : nodes_of(pin, particles.grid())) {
    const Vec3 place = particles.place + at<double>(kernels::components(particles.position), node);
    lever = std::max(lever, (place - centre).norm());
  }
  return lever;
}

/// The pins on a body that explicit methods step must be softer the farther they are from its centre.
void check_lever(int obstacle, const SimulationDescription& simulation, const std::string& at,
                 const std::string& is, Report& report) {
  const bool explicitly = std::holds_alternative<SymplecticEulerDescription>(simulation.integrator) ||
                          std::holds_alternative<XpbdDescription>(simulation.integrator);
  if (!explicitly) return;
  const ObstacleDescription& description = simulation.obstacles[static_cast<std::size_t>(obstacle)];
  const Shape shape = std::visit([](const auto& own) { return own.shape(); }, description.shape);
  const double mass = description.body->mass;
  const double inertia =
      mass * mass_properties(shape).inertia.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
  double all = 0, asked = 0, farthest = 0;
  for (const ClothDescription& cloth : simulation.cloths) {
    for (const PinRegion& pin : cloth.pins) {
      if (pin.obstacle != obstacle) continue;
      const double lever = lever_of(pin, cloth, description.position), stiffness = pin.stiffness.value_or(0);
      all += stiffness;
      asked += stiffness * (1 + mass * lever * lever / inertia);
      farthest = std::max(farthest, lever);
    }
  }
  const double most = kAtRim * kPinBound * mass / (simulation.time_step * simulation.time_step);
  if (asked <= most) return;
  report.add(at, is + "that one is pulled up to " + json(farthest).dump() + " m from its centre, by " +
                     json(all).dump() + " N/m in all; with \"" +
                     std::visit([](const auto& d) { return std::string(d.kName); }, simulation.integrator) +
                     "\" at most " + json(all * most / asked).dump() +
                     " N/m are allowed there; \"bdf2\" bears more");
}

}  // namespace

void check_pins(const SimulationDescription& simulation, Report& report) {
  for (std::size_t c = 0; c < simulation.cloths.size(); ++c) {
    const std::vector<PinRegion>& pins = simulation.cloths[c].pins;
    for (std::size_t p = 0; p < pins.size(); ++p) {
      const std::string pin = "/cloths/" + std::to_string(c) + "/pins/" + std::to_string(p);
      if (pins[p].ball) {
        const auto ball = static_cast<std::size_t>(*pins[p].ball);
        const std::string is = "is " + std::to_string(ball) + "; ";
        if (ball >= simulation.balls.size()) {
          report.add(pin + "/ball", is + "the scene has " + std::to_string(simulation.balls.size()) +
                                        " balls, counted from 0");
        } else {
          check_pull(pins[p], simulation, pin + "/ball", is, simulation.balls[ball].mass, report);
        }
      }
      if (!pins[p].obstacle) continue;
      const std::string at = pin + "/obstacle";
      const std::string is = "is " + std::to_string(*pins[p].obstacle) + "; ";
      if (*pins[p].obstacle >= static_cast<int>(simulation.obstacles.size())) {
        report.add(at, is + "the scene has " + std::to_string(simulation.obstacles.size()) +
                           " colliders that are no balls, counted from 0");
      } else if (const auto& body = simulation.obstacles[static_cast<std::size_t>(*pins[p].obstacle)].body) {
        check_pull(pins[p], simulation, at, is, body->mass, report);
        if (report.count() == 0) check_lever(*pins[p].obstacle, simulation, at, is, report);
      }
    }
  }
}

}  // namespace weft::scene
