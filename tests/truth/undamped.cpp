#include "undamped.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <vector>

#include "scene/scene.h"

namespace weft::test {
namespace {

/// Cotton, 1 m long and 0.25 m wide, hung by its short edge, stretched by its weight and let go in its first
/// mode, J0(j01 sqrt(s)), with its end 0.15 m aside.
SimulationDescription strip(int level) {
  constexpr double kFirstZero = 2.404825557695773, kWidth = 0.25, kAside = 0.15;
  ClothDescription cloth;
  cloth.size = {kWidth, 1};
  cloth.material = find_fabric("cotton")->material;
  cloth.min_level = cloth.max_level = cloth.initial_level = level;
  cloth.pins = {PinRegion{0, 1, 0, 0}};
  const Grid grid = cloth.base_cells.at(level);
  const double cell = 1.0 / (grid.rows - 1);
  const auto aside = [&](int r) {
    return r == 0 ? 0 : kAside * std::cyl_bessel_j(0.0, kFirstZero * std::sqrt(1 - r * cell));
  };
  double y = 0;
  for (int r = 0; r < grid.rows; ++r) {
    if (r > 0) {
      const double load = cloth.material.density * 9.81 * (1 - (r - 0.5) * cell);
      const double length = cell * (1 + load / cloth.material.structural.warp),
                   step = aside(r) - aside(r - 1);
      y -= std::sqrt(length * length - step * step);
    }
    for (int c = 0; c < grid.cols; ++c)
      cloth.nodes.push_back({kWidth * (double(c) / (grid.cols - 1) - 0.5), y, aside(r)});
  }
  SimulationDescription simulation;
  simulation.cloths = {cloth};
  simulation.effects = {GravityEffect{}};
  return simulation;
}

/// Where it begins, for good.
void stop(PinRegion& pin) {
  pin.path.clear();
  pin.motion.clear();
  pin.loop = false;
  pin.obstacle.reset();
  pin.ball.reset();
  pin.from = 0;
  pin.until = std::numeric_limits<double>::infinity();
}
void stop(BallDescription& ball) {
  if (!ball.path.empty()) ball.position = ball.path.front().position;
  ball.path.clear();
  ball.loop = false;
  ball.velocity = Vec3::Zero();
}
void stop(ObstacleDescription& obstacle) {
  if (!obstacle.path.empty()) {
    const Pose begin = obstacle.path.front().pose;
    obstacle.position = begin.position;
    std::visit(
        [&](auto& shape) {
          if constexpr (requires { shape.orientation; }) shape.orientation = begin.orientation;
        },
        obstacle.shape);
  }
  obstacle.path.clear();
  obstacle.loop = false;
  if (obstacle.body) obstacle.body->dynamic = false;
}

/// What neither damps nor drives: without air, pressure and what tears, and with all that moves by a path or
/// with a skeleton's bone standing still where it begins, or away if it would fall.
void close_off(SimulationDescription& scene) {
  std::erase_if(scene.effects, [](const EffectDescription& effect) {
    return !std::holds_alternative<GravityEffect>(effect) &&
           !std::holds_alternative<PlateBendingEffect>(effect) &&
           !std::holds_alternative<StrainLimitEffect>(effect) &&
           !std::holds_alternative<ClothContactEffect>(effect);
  });
  scene.wind = Wind{};
  for (ClothDescription& cloth : scene.cloths) {
    for (PinRegion& pin : cloth.pins) stop(pin);
  }
  std::erase_if(scene.balls,
                [](const BallDescription& ball) { return ball.motion == BallDescription::Motion::dynamic; });
  for (BallDescription& ball : scene.balls) stop(ball);
  for (ObstacleDescription& obstacle : scene.obstacles) stop(obstacle);
}

}  // namespace

void PrintTo(const UndampedRun& run, std::ostream* out) {
  *out << run.scene << " by " << name_of(run.method) << ", level " << run.level << ", " << run.rate << " Hz, "
       << run.substeps << " substeps, " << run.seconds << " s";
}

IntegratorDescription method_of(const UndampedRun& run) {
  const auto implicit = [&](auto description) -> IntegratorDescription {
    description.substeps = run.substeps;
    description.liveliness = run.liveliness;
    description.tolerance = run.tolerance;
    return description;
  };
  switch (run.method) {
    case Method::backward_euler:
      return implicit(BackwardEulerDescription{});
    case Method::bdf2:
      return implicit(Bdf2Description{});
    case Method::xpbd:
      return XpbdDescription{};
    default:
      return SymplecticEulerDescription{};
  }
}

SimulationDescription scene_of(const UndampedRun& run) {
  SimulationDescription scene;
  if (run.scene == "strip") {
    scene = strip(run.level);
  } else {
    const bool silk = run.scene == "silk-swing";
    scene = std::get<scene::Scene>(scene::load(silk ? "swing" : run.scene)).simulation;
    if (silk) scene.cloths[0].material = find_fabric("silk")->material;
    close_off(scene);
  }
  scene.sleep_speed = 0;
  scene.time_step = 1.0 / run.rate;
  scene.integrator = method_of(run);
  return scene;
}

namespace {

/// The cloth's energy; half_substep: by how much the positions are later than the velocities, s.
template <class Real>
Energy energy_of(const Cloth<Real>& cloth, const Vec3& gravity, double half_substep) {
  Energy energy;
  const Particles<Real>& nodes = cloth.particles();
  const Grid& grid = nodes.grid();
  std::vector<Vec3> forces(grid.size(), Vec3::Zero());
  const auto force = [&](int r, int c) -> Vec3& { return forces[grid.index(r, c)]; };
  for (const SpringFamily& family : cloth.springs().families()) {
    for (int r = 0; r + family.rows < grid.rows; ++r) {
      for (int c = std::max(0, -family.cols); c + std::max(0, family.cols) < grid.cols; ++c) {
        const Vec3 along = nodes.position_at(r + family.rows, c + family.cols) - nodes.position_at(r, c);
        const double length = along.norm(), stretch = length - family.rest_length,
                     past = std::max(0.0, length - family.limit.length),
                     stiffening = family.limit.stiffening - 1,
                     stiffness = family.stiffness_at(r, c, grid.rows, grid.cols);
        energy.potential += stiffness / 2 * (stretch * stretch + stiffening * past * past);
        if (length == 0) continue;  // it has no direction
        const Vec3 pull = stiffness * (stretch + stiffening * past) / length * along;
        force(r, c) += pull;
        force(r + family.rows, c + family.cols) -= pull;
      }
    }
  }
  if (cloth.plate() != nullptr) {
    cloth.plate()->for_each_stencil([&](double stiffness, const auto& stencil) {
      Vec3 difference(0, 0, 0);
      for (const auto& node : stencil) {
        if (node.weight != 0) difference += node.weight * nodes.position_at(node.row, node.col);
      }
      energy.potential += stiffness * difference.squaredNorm() / 2;
      for (const auto& node : stencil) {
        if (node.weight != 0) force(node.row, node.col) -= stiffness * node.weight * difference;
      }
    });
  }
  each_node(grid, [&](int r, int c) {
    const double mass = nodes.mass.at(r, c);
    energy.potential -= mass * gravity.dot(nodes.position_at(r, c));
    if (nodes.inverse_mass.at(r, c) == 0) return;
    const Vec3 velocity = nodes.velocity_at(r, c) + half_substep * (force(r, c) / mass + gravity);
    energy.kinetic += mass * velocity.squaredNorm() / 2;
  });
  return energy;
}

}  // namespace

template <class Real>
Energy state_energy(const Simulation<Real>& simulation) {
  Energy sum;
  for (std::size_t i = 0; i < simulation.cloths().size(); ++i) {
    const bool is_leapfrog =
        std::holds_alternative<SymplecticEulerDescription>(simulation.description().integrator);
    const double half_substep =
        is_leapfrog ? simulation.description().time_step / simulation.last_advance(i).substeps / 2 : 0;
    const Energy energy = energy_of(simulation.cloths()[i], simulation.gravity(), half_substep);
    sum.kinetic += energy.kinetic;
    sum.potential += energy.potential;
  }
  return sum;
}

template Energy state_energy(const Simulation<float>&);
template Energy state_energy(const Simulation<double>&);

}  // namespace weft::test
