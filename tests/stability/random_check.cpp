// What a random scene is held to.
#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/contact/triangle_mesh.h"
#include "cloth/effects/grab.h"
#include "criteria.h"
#include "merges.h"
#include "random_scenes.h"
#include "random_surroundings.h"

namespace weft::stability {
namespace {

constexpr double kSeconds = 2;

Method method_of(const IntegratorDescription& integrator) {
  constexpr Method kMethods[] = {Method::symplectic_euler, Method::backward_euler, Method::bdf2,
                                 Method::xpbd};
  return kMethods[integrator.index()];
}

bool is_implicit(Method method) { return method == Method::backward_euler || method == Method::bdf2; }

/// Work of a steady force of so many newtons on a body of so many kilograms, J.
double work_of_force(double force, double mass, double speed) {
  return force * (speed * kSeconds + force / mass * kSeconds * kSeconds / 2);
}

/// What the body's motion and its start within the cloth bring, J.
double work_of_body(const ClothDescription& cloth, double radius, double fastest) {
  const Material& material = cloth.material;
  const double area = cloth.size.x() * cloth.size.y(), mass = material.density * area;
  const Grid grid = cloth.base_cells.at(cloth.max_level);
  const double spacing = std::min(cloth.size.x() / (grid.cols - 1), cloth.size.y() / (grid.rows - 1));
  const double stiffness = material.structural + material.shear + 4 * material.bending;
  // Nodes inside are put on its surface at once; others may fly off at twice its speed, or be pulled along.
  const double stretch = (radius + std::min(fastest * kSeconds, 10 * cloth.size.maxCoeff())) / spacing;
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

/// Of the smallest ball around its centre that holds it, m; a plane's none: it stands, and not in the cloth.
struct OuterRadius {
  double operator()(const PlaneDescription&) const { return 0; }
  double operator()(const BoxDescription& box) const { return box.size.norm() / 2; }
  double operator()(const CapsuleDescription& capsule) const { return capsule.length / 2 + capsule.radius; }
  double operator()(const MeshDescription& mesh) const { return mesh.surface->outer_radius(); }
};

double work_of_obstacle(const ClothDescription& cloth, const ObstacleDescription& obstacle) {
  const double radius = std::visit(OuterRadius{}, obstacle.shape);
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
      work += air->air_density * air->drag * wind * wind / 2 * area * wind * kSeconds;
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

/// The same of all cloths, with what the hand does on the first.
double input(const SimulationDescription& scene) {
  double work = 0;
  for (const ClothDescription& each : scene.cloths) work += input_to(each, scene);
  // What it holds goes with it, and may be thrown the sheet's length past it.
  if (const auto hand = hand_of(scene))
    work += hand->force * 2 * (hand->way.norm() + scene.cloths[0].size.norm());
  return work;
}

/// Whether a pressure is more than a sheet's springs can balance (inflation.h). In air that follows it, it
/// then grows faster the larger it is, beyond all bounds within a finite time: the guard has to hold it.
bool bursts(const SimulationDescription& scene) {
  double pressure = 0;
  bool limited = false;
  for (const EffectDescription& effect : scene.effects) {
    const auto* inflation = std::get_if<InflationEffect>(&effect);
    if (inflation && !inflation->volume) pressure += inflation->pressure;
    limited = limited || std::holds_alternative<StrainLimitEffect>(effect);
  }
  return std::any_of(scene.cloths.begin(), scene.cloths.end(), [&](const ClothDescription& cloth) {
    const double stiffening = limited ? cloth.material.limit.stiffening : 1;
    return std::abs(pressure) * cloth.size.maxCoeff() > 2 * cloth.material.structural * stiffening;
  });
}

/// What a step of symplectic Euler brings in by its rounding, J. Each substep leaves every coordinate off by
/// up to half a unit of its last place, evenly spread, which has the variance unit^2 / 12: of so much at
/// either end a spring of stiffness k gets k unit^2 / 12 on average, and nothing takes it away.
double work_of_rounding(const Simulation<float>& simulation) {
  double farthest = 0, stiffness = 0;  // N/m, of all springs, as often as there are substeps
  for (const Vec3& node : positions(simulation)) farthest = std::max(farthest, node.cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < simulation.cloths().size(); ++i) {
    const Cloth<float>& cloth = simulation.cloths()[i];
    const Grid& grid = cloth.particles().grid();
    for (const SpringFamily& family : cloth.springs().families()) {
      const int springs = (grid.rows - family.rows) * (grid.cols - std::abs(family.cols));
      stiffness += simulation.report(i).substeps * springs * family.stiffness * family.limit.stiffening;
    }
  }
  const double unit = std::numeric_limits<float>::epsilon() * farthest;
  return stiffness * unit * unit / 12;
}

/// What is done to a scene while it runs, by its seed.
class Commands {
 public:
  explicit Commands(Simulation<float>& simulation)
      : simulation_(simulation),
        scene_(simulation.description()),
        hand_(hand_of(scene_)),
        kept_(kept_effects(scene_)) {}

  /// J, that the last change of level brought in by the paper's rules. Eqs. 8 and 9 say all of the state
  /// after it: springs across folds that a finer grid has and a coarser one has not are compressed, however
  /// the nodes move. The engine's own rules may bring in nothing but what take_brought_in says.
  double raised() const { return raised_; }
  /// J, of springs and plate alone: what the merges since the last call had to bring in (merges.h).
  double take_brought_in() { return merges_.take_brought_in(); }

  /// Before a step. True if effects were switched: energies before and after are not of one system.
  bool give(long step) {
    raised_ = 0;
    change_level(step);
    move_hand(step);
    if (kept_ && step == step_at(kSwitchesOff)) simulation_.set_effects(*kept_);
    if (kept_ && step == step_at(kSwitchesOn)) simulation_.set_effects(scene_.effects);
    return kept_ && (step == step_at(kSwitchesOff) || step == step_at(kSwitchesOn));
  }

 private:
  long step_at(double time) const { return std::lround(time / scene_.time_step); }

  /// Up and down through the cloth's levels.
  void change_level(long step) {
    const ClothDescription& cloth = scene_.cloths[0];
    const long levels = cloth.max_level - cloth.min_level;
    const auto period = static_cast<long>(1 + scene_.seed % 16);
    if (levels == 0 || step % period != 0) return;
    const long turn = step / period % (2 * levels);
    simulation_.request_level(0, cloth.min_level + static_cast<int>(std::min(turn, 2 * levels - turn)));
    Cloth<float>& changing = simulation_.cloths()[0];
    const int level = changing.level();
    const double energy = read(simulation_, true).energy, elastic = changing.elastic_energy();
    changing.apply_pending_level();
    if (cloth.discretization == Discretization::paper) {
      raised_ = std::max(0.0, read(simulation_, true).energy - energy);
    } else if (changing.level() < level && is_implicit(method_of(scene_.integrator))) {
      merges_.add(simulation_, elastic);
    }
  }

  void move_hand(long step) {
    if (!hand_) return;
    const long begin = step_at(kGrabs), end = step_at(kReleases);
    if (step == begin) {
      from_ = Grabs<float>::place(simulation_.cloths()[0].particles(), scene_.cloths[0], hand_->at);
      grab_ = simulation_.grab(0, hand_->at, from_, hand_->force);
    } else if (step == end) {
      simulation_.release(grab_);
    } else if (step > begin && step < end) {
      const double share = static_cast<double>(step - begin) / static_cast<double>(end - begin);
      simulation_.move_grab(grab_, from_ + share * hand_->way);
    }
  }

  Simulation<float>& simulation_;
  double raised_ = 0;
  Merges merges_;
  const SimulationDescription& scene_;
  std::optional<Hand> hand_;
  std::optional<std::vector<EffectDescription>> kept_;
  Vec3 from_{0, 0, 0};
  GrabId grab_ = 0;
};

}  // namespace

std::optional<Failure> check(const SimulationDescription& scene) {
  const Setup setup{method_of(scene.integrator), 0, 0};
  Simulation<float> simulation(scene);
  EnergyBound bound = energy_bound(simulation, setup, input(scene));
  Commands commands(simulation);
  double held = 0;  // J, brought into the springs by merges
  const long steps = std::lround(kSeconds / scene.time_step);
  const bool bursting = bursts(scene);
  bool burst = false;
  for (long step = 0; step < steps; ++step) {
    const bool switched = commands.give(step);
    simulation.step();
    const std::string when = " after step " + std::to_string(step + 1);
    if (!simulation.healthy()) return Failure{Failure::Kind::not_finite, "not finite" + when};
    if (const Complaint guarded = guard_complaint(simulation)) {
      burst = bursting;
      if (!burst) return Failure{Failure::Kind::guard, *guarded + when};
    }
    if (burst) continue;
    double put_in = commands.raised();
    if (setup.method == Method::symplectic_euler) put_in += work_of_rounding(simulation);
    bound.allowed += (1 + energy_room(setup.method)) * put_in;
    if (switched) bound = energy_bound(simulation, setup, input(scene));
    const double rise = read(simulation, setup.method != Method::xpbd).energy - bound.start;
    if (rise <= bound.allowed) continue;
    held += commands.take_brought_in();
    const double motion = read(simulation, false).energy - bound.start;
    if (rise <= bound.allowed + held && motion <= bound.allowed) continue;
    return Failure{Failure::Kind::energy,
                   "energy " + std::to_string(rise) + " J above the start's, without springs' " +
                       std::to_string(motion) + "; allowed " + std::to_string(bound.allowed) +
                       ", merges had to bring into springs " + std::to_string(held) + when};
  }
  return {};
}

}  // namespace weft::stability
