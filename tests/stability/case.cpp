#include "case.h"

#include <array>
#include <numbers>

#include "cloth/integrators/symplectic_euler.h"
#include "cloth/integrators/xpbd.h"
#include "cloth/levels/refine.h"

namespace weft::stability {
namespace {

/// Substeps of a step of 1/60 s that keep the ordinary sheet stable at this level.
int ordinary_substeps(int level) {
  constexpr double kHardlyMore = 0.9, kDragRate = 5;
  const Material material;
  const Grid grid = BaseCells{}.at(level);
  Field<float> mass(grid);
  mass_distribution(material.density * kSize * kSize, Discretization::continuum, mass);
  const Springs<float> springs(material, Discretization::continuum, {kSize, kSize}, grid);
  return stable_substeps(springs.max_squared_frequency(mass), kDragRate, 1.0 / 60, kHardlyMore);
}

}  // namespace

const char* name_of(Method method) {
  constexpr std::array kNames{"explicit_fixed", "symplectic_euler", "xpbd", "backward_euler", "bdf2"};
  return kNames[static_cast<std::size_t>(method)];
}

IntegratorDescription integrator_of(const Setup& setup) {
  switch (setup.method) {
    case Method::explicit_fixed:
      return SymplecticEulerDescription{ordinary_substeps(setup.level)};
    case Method::symplectic_euler:
      return SymplecticEulerDescription{};
    case Method::xpbd:
      return XpbdDescription{};
    case Method::backward_euler:
      return BackwardEulerDescription{};
    default:
      return Bdf2Description{};
  }
}

SimulationDescription ordinary_sheet(const Setup& setup, std::vector<PinRegion> pins) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {kSize, kSize};
  cloth.min_level = cloth.max_level = cloth.initial_level = setup.level;
  cloth.material.damping = 0.5;
  cloth.pins = std::move(pins);
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{}, DampingEffect{}};
  scene.integrator = integrator_of(setup);
  scene.time_step = setup.time_step();
  return scene;
}

SimulationDescription level_sheet(const Setup& setup, std::vector<PinRegion> pins) {
  SimulationDescription scene = ordinary_sheet(setup, std::move(pins));
  scene.cloths[0].orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  return scene;
}

BallDescription ball(const Vec3& position, double radius, double friction) {
  BallDescription description;
  description.position = position;
  description.radius = radius;
  description.friction = friction;
  return description;
}

double mass_of(const ClothDescription& cloth) {
  return cloth.material.density * cloth.size.x() * cloth.size.y();
}

double xpbd_excess(const SimulationDescription& scene, const Setup& setup, double load) {
  if (setup.method != Method::xpbd) return 0;
  const ClothDescription& cloth = scene.cloths[0];
  const Grid grid = cloth.base_cells.at(cloth.initial_level);
  const double h = scene.time_step / substeps(std::get<XpbdDescription>(scene.integrator), scene.time_step);
  const double border_mass = mass_of(cloth) / grid.cells() / 2;
  const double spacing = std::min(cloth.size.x() / (grid.cols - 1), cloth.size.y() / (grid.rows - 1));
  return load * h * h * 2 / border_mass / spacing;
}

std::vector<Case> all_cases() {
  std::vector<Case> all;
  for (const auto& theme : {material_cases, shape_cases, ball_cases, level_cases, long_cases, mesh_cases,
                            body_cases, effect_cases, contact_cases, tunnel_cases, driven_cases}) {
    for (Case& each : theme()) all.push_back(std::move(each));
  }
  return all;
}

}  // namespace weft::stability
