#include "random_scenes.h"

#include "cloth/integrators/symplectic_euler.h"
#include "cloth/levels/refine.h"
#include "draw.h"
#include "random_surroundings.h"

namespace weft::stability {
namespace {

Material draw_material(Draw& draw, Discretization discretization) {
  Material material;
  material.density = draw.decades(0.01, 10);
  material.structural = draw.decades(1, 1e6);
  material.shear = draw.chance(0.1) ? 0 : draw.decades(0.1, 1e5);
  material.bending = draw.chance(0.2) ? 0 : draw.decades(0.01, 1e4);
  material.damping = draw.decades(1e-3, 10) * (discretization == Discretization::paper ? 1e-3 : 1);
  return material;
}

ClothDescription draw_cloth(Draw& draw, int max_level) {
  ClothDescription cloth;
  const double size = draw.decades(0.05, 50);
  cloth.size = {size, std::max(1e-3, size * draw.decades(0.05, 1))};
  cloth.base_cells = {draw.integer(1, 3), draw.integer(1, 2)};
  cloth.position = draw.in_box(1);
  // One after the other: compilers differ in which argument of a call they find first.
  const Vec3 axis = draw.direction();
  cloth.orientation = Quaternion(Eigen::AngleAxisd(draw.between(0, 3.1), axis));
  if (draw.chance(0.3)) cloth.velocity = draw.in_box(20);
  if (draw.chance(0.5)) cloth.perturbation = 0.02 * size * draw.between(0, 1);
  if (draw.chance(0.2)) cloth.discretization = Discretization::paper;
  cloth.material = draw_material(draw, cloth.discretization);
  cloth.min_level = kMinLevel;
  cloth.max_level = draw.integer(kMinLevel, max_level);
  cloth.initial_level = draw.integer(cloth.min_level, cloth.max_level);
  for (int pins = draw.integer(0, 4); pins > 0; --pins) {
    const double u = draw.between(0, 1), v = draw.between(0, 1);
    const bool patch = draw.chance(0.3);
    cloth.pins.push_back({u, patch ? std::min(1.0, u + 0.3) : u, v, v});
  }
  return cloth;
}

BallDescription draw_ball(Draw& draw, const ClothDescription& cloth) {
  const double size = cloth.size.maxCoeff();
  BallDescription ball;
  ball.radius = size * draw.decades(0.03, 0.5);
  ball.position = cloth.position + draw.in_box(size);
  ball.friction = draw.chance(0.3) ? 0 : draw.between(0, 2);
  if (draw.chance(0.4)) {
    ball.motion = BallDescription::Motion::dynamic;
    ball.mass = draw.decades(0.01, 100);
  }
  if (ball.motion == BallDescription::Motion::kinematic && draw.chance(0.3)) {
    for (const double time : {0.2, 0.8, 1.4}) ball.path.push_back({time, cloth.position + draw.in_box(size)});
    ball.position = ball.path.front().position;
  } else if (draw.chance(0.7)) {
    ball.velocity = draw.in_box(draw.decades(0.1, 50));
  }
  return ball;
}

std::vector<EffectDescription> draw_effects(Draw& draw) {
  std::vector<EffectDescription> effects;
  if (draw.chance(0.9)) {
    effects.emplace_back(GravityEffect{draw.chance(0.7) ? standard_gravity() : draw.in_box(100)});
  }
  if (draw.chance(0.7)) effects.emplace_back(DampingEffect{});
  if (draw.chance(0.2)) effects.emplace_back(PaperWindEffect{draw.decades(1e-3, 1), draw.chance(0.5)});
  if (draw.chance(0.5)) effects.emplace_back(AerodynamicsEffect{draw.between(0, 2), draw.between(0, 3)});
  return effects;
}

template <class Implicit>
Implicit draw_implicit(Draw& draw) {
  Implicit implicit;
  implicit.substeps = draw.integer(1, 3);
  implicit.tolerance = draw.decades(1e-4, 0.1);
  implicit.newton_iterations = draw.integer(1, 4);
  implicit.linear_iterations = draw.integer(5, 100);
  return implicit;
}

/// Substeps that symplectic Euler would take at the finest level, its drag aside.
int explicit_substeps(const ClothDescription& cloth, double time_step) {
  const Grid grid = cloth.base_cells.at(cloth.max_level);
  Field<float> mass(grid);
  mass_distribution(cloth.material.density * cloth.size.x() * cloth.size.y(), cloth.discretization, mass);
  const Springs<float> springs(cloth.material, cloth.discretization, cloth.size, grid);
  return stable_substeps(springs.max_squared_frequency(mass), 0, time_step, 0.9);
}

constexpr int kMostExplicit = 300;  ///< substeps

IntegratorDescription draw_integrator(Draw& draw, const SimulationDescription& scene) {
  switch (draw.integer(0, 3)) {
    case 0:
      if (explicit_substeps(scene.cloths[0], scene.time_step) <= kMostExplicit)
        return SymplecticEulerDescription{0, draw.between(0.3, 0.9)};
      [[fallthrough]];
    case 1:
      return draw_implicit<BackwardEulerDescription>(draw);
    case 2:
      return XpbdDescription{draw.integer(1, 60)};
    default:
      return draw_implicit<Bdf2Description>(draw);
  }
}

/// Another cloth; where symplectic Euler would take too many substeps for it, of the first one's make.
ClothDescription draw_other(Draw& draw, int max_level, const SimulationDescription& scene) {
  const ClothDescription& first = scene.cloths[0];
  ClothDescription other = draw_cloth(draw, max_level);
  const bool is_explicit = std::holds_alternative<SymplecticEulerDescription>(scene.integrator);
  if (is_explicit && explicit_substeps(other, scene.time_step) > kMostExplicit) {
    other.size = first.size;
    other.material = first.material;
    other.base_cells = first.base_cells;
    other.discretization = first.discretization;
    other.max_level = first.max_level;
    other.initial_level = std::min(other.initial_level, other.max_level);
  }
  return other;
}

}  // namespace

SimulationDescription random_scene(std::uint64_t seed, int max_level) {
  Draw draw(seed);
  SimulationDescription scene;
  scene.seed = seed;
  scene.cloths = {draw_cloth(draw, max_level)};
  for (int balls = draw.integer(0, 3); balls > 0; --balls)
    scene.balls.push_back(draw_ball(draw, scene.cloths[0]));
  scene.effects = draw_effects(draw);
  scene.wind = {draw.direction(), draw.chance(0.2) ? 100.0 : draw.between(0, 30)};
  scene.time_step = draw.chance(0.4) ? 1.0 / 60 : draw.decades(1.0 / 240, 0.1);
  scene.integrator = draw_integrator(draw, scene);
  // Drawn apart, so that the other half of the scenes is what it would be without.
  if (Draw more(~seed); more.chance(0.5)) add_surroundings(more, scene);
  Draw company(seed + (std::uint64_t{3} << 32));
  const ClothDescription other = draw_other(company, max_level, scene);
  add_company(company, other, scene);
  return scene;
}

}  // namespace weft::stability
