#include "scene/pin_check.h"

#include <algorithm>
#include <map>
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

/// Of kPinBound: a pin at a ball's rim, where 1 / mass + r^2 / inertia is 3.5 / mass.
constexpr double kAtRim = 3.5;

/// How a body is pulled as the scene begins.
struct Pull {
  std::string first;     ///< pin
  double stiffness = 0;  ///< of all pins, N/m
  double as_felt = 0;    ///< of pins by its centre that move it as much, N/m
  double farthest = 0;   ///< m from its centre
};

/// Its moments of inertia by its mass; the least, m2.
double least_inertia(const ObstacleDescription& body) {
  const Shape shape = std::visit([](const auto& own) { return own.shape(); }, body.shape);
  return principal_moments(mass_properties(shape).inertia)[0];
}

void add_pulls(const SimulationDescription& simulation, std::size_t cloth, std::map<int, Pull>& pulls) {
  const ClothDescription& description = simulation.cloths[cloth];
  const auto on_body = [&](const PinRegion& pin) {
    return pin.obstacle && simulation.obstacles[static_cast<std::size_t>(*pin.obstacle)].body;
  };
  if (std::none_of(description.pins.begin(), description.pins.end(), on_body)) return;
  const Particles<double> particles = start<double>(description, description.initial_level);
  for (std::size_t p = 0; p < description.pins.size(); ++p) {
    const PinRegion& pin = description.pins[p];
    if (!on_body(pin)) continue;
    const ObstacleDescription& body = simulation.obstacles[static_cast<std::size_t>(*pin.obstacle)];
    double lever = 0;
    for (const std::size_t node : nodes_of(pin, particles.grid())) {
      const Vec3 place = particles.place + at<double>(kernels::components(particles.position), node);
      lever = std::max(lever, (place - body.position).norm());
    }
    Pull& pull = pulls[*pin.obstacle];
    if (pull.first.empty()) pull.first = element_path(element_path("/cloths", cloth) + "/pins", p);
    pull.stiffness += pin.stiffness.value_or(0);
    pull.as_felt += pin.stiffness.value_or(0) * (1 + lever * lever / least_inertia(body));
    pull.farthest = std::max(pull.farthest, lever);
  }
}

/// The pins on a body that explicit methods step must be softer the farther they are from its centre. The
/// scene has no problems so far.
void check_levers(const SimulationDescription& simulation, Report& report) {
  const bool explicitly = std::holds_alternative<SymplecticEulerDescription>(simulation.integrator) ||
                          std::holds_alternative<XpbdDescription>(simulation.integrator);
  if (!explicitly) return;
  std::map<int, Pull> pulls;
  for (std::size_t cloth = 0; cloth < simulation.cloths.size(); ++cloth) add_pulls(simulation, cloth, pulls);
  for (const auto& [obstacle, pull] : pulls) {
    const double mass = simulation.obstacles[static_cast<std::size_t>(obstacle)].body->mass;
    const double most = kAtRim * kPinBound * mass / (simulation.time_step * simulation.time_step);
    if (pull.as_felt <= most) continue;
    const auto name = std::visit([](const auto& d) { return std::string(d.kName); }, simulation.integrator);
    report.add(pull.first + "/obstacle",
               "is " + std::to_string(obstacle) + "; that one is pulled up to " + json(pull.farthest).dump() +
                   " m from its centre, by " + json(pull.stiffness).dump() + " N/m in all; with \"" + name +
                   "\" at most " + json(pull.stiffness * most / pull.as_felt).dump() +
                   " N/m are allowed there; \"bdf2\" bears more");
  }
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
      }
    }
  }
  if (report.count() == 0) check_levers(simulation, report);
}

}  // namespace weft::scene
