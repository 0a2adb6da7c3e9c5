#include "random_loads.h"

#include <algorithm>
#include <cmath>

#include "cloth/forces/effect.h"
#include "cloth/guard/step_guard.h"
#include "cloth/shapes/triangle_mesh.h"
#include "random_surroundings.h"

namespace weft::stability {
namespace {

/// Work of a steady force of so many newtons on a body of so many kilograms, J.
double work_of_force(double force, double mass, double speed) {
  return force * (speed * kRandomSeconds + force / mass * kRandomSeconds * kRandomSeconds / 2);
}

/// m, at the finest level, the shorter side.
double spacing_of(const ClothDescription& cloth) {
  const Grid grid = cloth.base_cells.at(cloth.max_level);
  return std::min(cloth.size.x() / (grid.cols - 1), cloth.size.y() / (grid.rows - 1));
}

/// What the body's motion and its start within the cloth bring, J.
double work_of_body(const ClothDescription& cloth, double radius, double fastest) {
  const Material& material = cloth.material;
  const double area = cloth.size.x() * cloth.size.y(), mass = material.density * area;
  const double stiffness = material.structural.most() + material.shear + 4 * material.bending;
  // Nodes inside are put on its surface at once; others may fly off at twice its speed, or be pulled along.
  const double stretch =
      (radius + std::min(fastest * kRandomSeconds, 10 * cloth.size.maxCoeff())) / spacing_of(cloth);
  return mass * 4 * fastest * fastest / 2 + stiffness * area * stretch * stretch;
}

/// Of a path's points at those times, m/s.
template <class Point, class Distance>
double fastest_of(const std::vector<Point>& path, Distance distance) {
  double fastest = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    fastest = std::max(fastest, distance(path[i - 1], path[i]) / (path[i].time - path[i - 1].time));
  return fastest;
}

double work_of_ball(const ClothDescription& cloth, const BallDescription& ball) {
  const double on_path = fastest_of(
      ball.path, [](const Waypoint& a, const Waypoint& b) { return (b.position - a.position).norm(); });
  return work_of_body(cloth, ball.radius, std::max(ball.velocity.norm(), on_path));
}

/// Of the smallest ball around its centre that holds it, m; of a plane, which stands, how deep the sheet
/// begins in it at most, pins with it: springs then go on from those to nodes on its surface.
struct OuterRadius {
  const ClothDescription& cloth;
  const Vec3& position;
  double operator()(const PlaneDescription& plane) const {
    const double height = plane.normal.dot(cloth.position - position);
    return std::max(0.0, cloth.size.norm() / 2 - height);
  }
  double operator()(const BoxDescription& box) const { return box.size.norm() / 2; }
  double operator()(const CapsuleDescription& capsule) const { return capsule.length / 2 + capsule.radius; }
  double operator()(const MeshDescription& mesh) const { return mesh.surface->outer_radius(); }
};

double work_of_obstacle(const ClothDescription& cloth, const ObstacleDescription& obstacle) {
  const double radius = std::visit(OuterRadius{cloth, obstacle.position}, obstacle.shape);
  const double fastest = fastest_of(obstacle.path, [=](const PoseWaypoint& a, const PoseWaypoint& b) {
    return (b.pose.position - a.pose.position).norm() +
           radius * a.pose.orientation.angularDistance(b.pose.orientation);
  });
  if (!obstacle.body) return work_of_body(cloth, radius, fastest);
  // The cloth may throw it back at twice the speed of any of its points.
  const double thrown = obstacle.body->velocity.norm() + radius * obstacle.body->spin.norm();
  return work_of_body(cloth, radius, std::max(fastest, thrown));
}

/// Of the wind's speed; gusts and eddies are of a normal distribution, in three components.
double strongest_wind(const Wind& wind) {
  const double eddies = 5 * std::sqrt(3.0) * wind.turbulence.intensity * wind.speed;
  double strongest = wind.speed * (1 + 5 * wind.gusts.intensity);
  for (const WindZone& zone : wind.zones) strongest = std::max(strongest, zone.velocity.norm());
  return strongest + eddies;
}

/// Upper bound of what wind, bodies and pressure can do on the cloth in the time, J. Generous: it parts what
/// is bounded from what runs away.
double input_to(const ClothDescription& cloth, const SimulationDescription& scene) {
  const double area = cloth.size.x() * cloth.size.y(), mass = cloth.material.density * area;
  const Grid grid = cloth.base_cells.at(cloth.max_level);
  const double speed = cloth.velocity.norm(), wind = strongest_wind(scene.wind);
  double work = 0;
  for (const EffectDescription& effect : scene.effects) {
    if (const auto* air = std::get_if<AerodynamicsEffect>(&effect)) {
      work += air->air_density * air->drag * wind * wind / 2 * area * wind * kRandomSeconds;
    } else if (const auto* steady = std::get_if<PaperWindEffect>(&effect)) {
      const double pushed = cloth.discretization == Discretization::paper ? grid.nodes() : area;
      work += work_of_force(steady->factor * wind * pushed, mass, speed);
    } else if (const auto* inflation = std::get_if<InflationEffect>(&effect)) {
      if (!inflation->volume) work += work_of_force(std::abs(inflation->pressure) * area, mass, speed);
      // All at once in a flat bag it may do c ln(V / V0), of which kLeastShare says 7 c.
      if (inflation->volume && cloth.sewn)
        work += 8 * (Gas<float>::kOutside + inflation->pressure) * *inflation->volume;
    } else if (const auto* contact = std::get_if<ClothContactEffect>(&effect)) {
      // Layers put apart by the thickness within one step.
      const double apart = contact->thickness / scene.time_step;
      work += mass * apart * apart / 2;
    }
  }
  for (const BallDescription& each : scene.balls) work += work_of_ball(cloth, each);
  for (const ObstacleDescription& each : scene.obstacles) work += work_of_obstacle(cloth, each);
  return work;
}

/// N/m, of structural springs that are drawn far out.
double stiffness_of(const ClothDescription& cloth, const SimulationDescription& scene) {
  const bool limited = std::any_of(scene.effects.begin(), scene.effects.end(), [](const auto& effect) {
    return std::holds_alternative<StrainLimitEffect>(effect);
  });
  return cloth.material.structural.most() * (limited ? cloth.material.limit.stiffening : 1);
}

/// Of air per area, N/m2: drag or lift at right angles to the wind.
double pressure_of(const AerodynamicsEffect& air, double wind) {
  return air.air_density * std::max(air.drag, air.lift_or_drag()) * wind * wind / 2;
}

/// Of gravity and winds on the whole cloth, N.
double load_on(const ClothDescription& cloth, const SimulationDescription& scene) {
  const double area = cloth.size.x() * cloth.size.y(), wind = strongest_wind(scene.wind);
  double load = total_gravity(scene.effects).norm() * cloth.material.density * area;
  for (const EffectDescription& effect : scene.effects) {
    if (const auto* air = std::get_if<AerodynamicsEffect>(&effect)) {
      load += pressure_of(*air, wind) * area;
    } else if (const auto* steady = std::get_if<PaperWindEffect>(&effect)) {
      const bool papers = cloth.discretization == Discretization::paper;
      load += steady->factor * wind * (papers ? cloth.base_cells.at(cloth.max_level).nodes() : area);
    }
  }
  return load;
}

/// Whether a pressure, of air that follows the sheet or of wind, is more than its springs can balance
/// (inflation.h). The sheet then grows faster the larger it is, beyond all bounds within a finite time: the
/// guard has to hold it.
bool bursts(const ClothDescription& cloth, const SimulationDescription& scene) {
  double inflated = 0, blown = 0;
  for (const EffectDescription& effect : scene.effects) {
    const auto* inflation = std::get_if<InflationEffect>(&effect);
    if (inflation && !inflation->volume) inflated += inflation->pressure;
    if (const auto* air = std::get_if<AerodynamicsEffect>(&effect))
      blown += pressure_of(*air, strongest_wind(scene.wind));
  }
  return (std::abs(inflated) + blown) * cloth.size.maxCoeff() > 2 * stiffness_of(cloth, scene);
}

/// Whether a spring that bears all of the load, as at a pin, is drawn out beyond what the guard lets be.
bool drawn_out(const ClothDescription& cloth, const SimulationDescription& scene) {
  const double bears = StepGuard<float>::kMostStrain * stiffness_of(cloth, scene) * spacing_of(cloth);
  return load_on(cloth, scene) > bears;
}

/// Whether the paper's wind, which pushes on however fast a node goes, drives loose cloth beyond the speed
/// that the guard lets be.
bool flies_off(const ClothDescription& cloth, const SimulationDescription& scene) {
  const double area = cloth.size.x() * cloth.size.y(), wind = strongest_wind(scene.wind);
  double push = 0;
  bool loose = cloth.pins.empty();
  for (const EffectDescription& effect : scene.effects) {
    if (const auto* steady = std::get_if<PaperWindEffect>(&effect)) {
      const bool papers = cloth.discretization == Discretization::paper;
      push += steady->factor * wind * (papers ? cloth.base_cells.at(cloth.max_level).nodes() : area);
    }
    loose = loose || std::holds_alternative<TearingEffect>(effect);
  }
  const double speed = push / (cloth.material.density * area) * kRandomSeconds;
  return loose && speed > StepGuard<float>::kMostSpeed;
}

}  // namespace

double input(const SimulationDescription& scene) {
  double work = 0;
  for (const ClothDescription& each : scene.cloths) work += input_to(each, scene);
  // What it holds goes with it, and may be thrown the sheet's length past it.
  if (const auto hand = hand_of(scene))
    work += hand->force * 2 * (hand->way.norm() + scene.cloths[0].size.norm());
  return work;
}

bool overloaded(const SimulationDescription& scene) {
  return std::any_of(scene.cloths.begin(), scene.cloths.end(), [&](const ClothDescription& cloth) {
    return bursts(cloth, scene) || drawn_out(cloth, scene) || flies_off(cloth, scene);
  });
}

double energy_beyond_guard(const SimulationDescription& scene) {
  const ClothDescription& cloth = scene.cloths[0];
  const double mass =
      cloth.material.density * cloth.size.prod() / cloth.base_cells.at(cloth.max_level).nodes();
  const double speed = StepGuard<float>::kMostSpeed;
  const double stretch = StepGuard<float>::kMostStrain * spacing_of(cloth);
  return std::min(mass * speed * speed, cloth.material.structural.most() * stretch * stretch) / 2;
}

}  // namespace weft::stability
