// A cloth that nothing damps and nothing drives never has more energy than it began with: kinetic, springs',
// plate's, and that of height, added up here in double from the state alone. Each method, over levels, rates
// and substeps.
//
// "More" is relative to the energy that moves: a potential has no zero, so the gain is given as a share of
// the largest kinetic energy of the first ten seconds. The energy that the start has above the rest is no
// less. Where nothing moves all that is told is rounding: of positions in single precision, 6e-8 m, under the
// cloths' weight.
//
// XPBD leaves springs longer than their stiffness says (Xpbd). That they come to be so is no gain of motion:
// its start is the largest energy of the first two seconds.
//
// Symplectic Euler's velocities are those of half a substep before its positions (leapfrog's: Hairer, Lubich,
// Wanner, Geometric Numerical Integration, I.1.4). Energy is that of both at one time, so they are brought
// forward by half a substep's force.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "cloth/world/simulation.h"
#include "methods.h"
#include "scene/scene.h"

namespace weft::test {
namespace {

constexpr double kMostGain = 0.01;
constexpr int kLeastSeconds = 20;  ///< of a run that would take too long

struct Run {
  std::string scene;  ///< a preset, "silk-swing" or "strip"
  Method method;
  int level;
  int rate;        ///< steps a second
  int substeps;    ///< explicit methods choose their own, which bdf2 and backward_euler do not
  double seconds;  ///< at most
  double liveliness = 1, tolerance = Bdf2Description().tolerance;  ///< of implicit methods
  double processor =
      std::numeric_limits<double>::infinity();  ///< s; past it a run of kLeastSeconds or more ends
};

void PrintTo(const Run& run, std::ostream* out) {
  *out << run.scene << " by " << name_of(run.method) << ", level " << run.level << ", " << run.rate << " Hz, "
       << run.substeps << " substeps, " << run.seconds << " s";
}

std::string name_of_run(const ::testing::TestParamInfo<Run>& tested) {
  const Run& run = tested.param;
  std::string scene = run.scene;
  std::replace(scene.begin(), scene.end(), '-', '_');
  return scene + "_" + name_of(run.method) + "_L" + std::to_string(run.level) + "_" +
         std::to_string(run.rate) + "Hz_x" + std::to_string(run.substeps);
}

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

IntegratorDescription method_of(const Run& run) {
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

SimulationDescription scene_of(const Run& run) {
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

struct Energy {
  double kinetic = 0, potential = 0;  ///< J
  double sum() const { return kinetic + potential; }
};

/// The cloth's energy; half_substep: by how much the positions are later than the velocities, s.
Energy energy_of(const Cloth<float>& cloth, const Vec3& gravity, double half_substep) {
  Energy energy;
  const Particles<float>& nodes = cloth.particles();
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

Energy energy_of(const Simulation<float>& simulation) {
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

struct Outcome {
  double gain = 0;  ///< the largest, relative
  double kept = 0;  ///< of the first ten seconds' largest kinetic energy, in the last ten of all of the run
  double seconds = 0;  ///< that were run
};

Outcome outcome_of(const Run& run) {
  Simulation<float> simulation(scene_of(run));
  for (std::size_t i = 0; i < simulation.cloths().size(); ++i) simulation.request_level(i, run.level);
  simulation.step();  // in which the level changes
  // Here the method begins anew: what that step took of the energy is not due any more.
  simulation.set_integrator(method_of(run));
  double start = energy_of(simulation).sum();
  const int settled = run.method == Method::xpbd ? 2 * run.rate : 0;
  const int steps = static_cast<int>(run.seconds * run.rate), every = std::max(1, run.rate / 20);
  const std::clock_t began = std::clock();
  double most = start, moving = 0, last = 0;
  int step = 1;
  for (; step < steps; ++step) {
    if (step > kLeastSeconds * run.rate && double(std::clock() - began) / CLOCKS_PER_SEC > run.processor)
      break;
    simulation.step();
    if (step % every != 0) continue;
    const Energy energy = energy_of(simulation);
    most = std::max(most, energy.sum());
    if (step <= settled) start = most;
    if (step < 10 * run.rate) moving = std::max(moving, energy.kinetic);
    if (step >= steps - 10 * run.rate) last = std::max(last, energy.kinetic);
  }
  double mass = 0;
  for (const Cloth<float>& cloth : simulation.cloths()) mass += cloth.total_mass();
  const double rounding = 6e-8 * mass * standard_gravity().norm();
  return {most - start < rounding ? 0 : (most - start) / moving, last / moving, double(step) / run.rate};
}

class UndampedEnergy : public ::testing::TestWithParam<Run> {};

TEST_P(UndampedEnergy, IsNeverMoreThanAtTheStart) {
  const Outcome outcome = outcome_of(GetParam());
  RecordProperty("gain", std::to_string(outcome.gain));
  RecordProperty("seconds", std::to_string(outcome.seconds));
  EXPECT_LT(outcome.gain, kMostGain);
}

// Up to a minute of what swings, by each method.
INSTANTIATE_TEST_SUITE_P(Swings, UndampedEnergy,
                         ::testing::Values(Run{"silk-swing", Method::bdf2, 5, 60, 1, 60},
                                           Run{"silk-swing", Method::bdf2, 4, 15, 1, 60},
                                           Run{"silk-swing", Method::bdf2, 4, 240, 8, 10},
                                           Run{"silk-swing", Method::backward_euler, 4, 60, 1, 60},
                                           Run{"silk-swing", Method::symplectic_euler, 4, 60, 0, 20},
                                           Run{"silk-swing", Method::xpbd, 4, 60, 0, 20},
                                           Run{"strip", Method::bdf2, 4, 60, 1, 60},
                                           Run{"strip", Method::bdf2, 4, 60, 4, 30},
                                           Run{"strip", Method::backward_euler, 4, 240, 3, 10},
                                           Run{"strip", Method::symplectic_euler, 4, 60, 0, 20},
                                           Run{"strip", Method::xpbd, 4, 60, 0, 20}),
                         name_of_run);

// A sheet held all round whose stiffest modes turn by more than sqrt(2) radians a substep, and one that folds
// upon itself.
INSTANTIATE_TEST_SUITE_P(Sheets, UndampedEnergy,
                         ::testing::Values(Run{"paper-screen", Method::symplectic_euler, 5, 60, 0, 10},
                                           Run{"towel", Method::bdf2, 5, 60, 8, 3}),
                         name_of_run);

// Nothing takes the energy of these, so all of the motion stays: its energy is 1 of what it was. Without the
// ledger a loose tolerance takes or pumps as it comes.
TEST(UndampedEnergyIsKept, AtAnyToleranceAndRate) {
  EXPECT_GT(outcome_of({"silk-swing", Method::bdf2, 5, 60, 1, 60}).kept, 0.98);
  EXPECT_GT(outcome_of({"silk-swing", Method::bdf2, 5, 60, 1, 60, 1, 0.1}).kept, 0.95);
  EXPECT_GT(outcome_of({"silk-swing", Method::bdf2, 4, 15, 1, 60}).kept, 0.95);
  EXPECT_GT(outcome_of({"strip", Method::bdf2, 4, 60, 4, 30}).kept, 0.98);
  EXPECT_GT(outcome_of({"strip", Method::backward_euler, 4, 240, 3, 30}).kept, 0.95);
  // Not given back, backward Euler takes w^2 h of it a second (T3): 3.766^2 / 720, for 20 s.
  EXPECT_NEAR(outcome_of({"strip", Method::backward_euler, 4, 240, 3, 30, 0}).kept, std::exp(-0.394), 0.02);
}

// The books are exact: from step to step the energy changes by what was given back less what was lost, as
// gravity's work has its potential and nothing else does any. 1e-7 J is rounding: of positions in single
// precision, 6e-8 m, under the sheet's weight of 0.2 N, and of velocities, 1e-7 of 4 mJ, over a step's sums.
TEST(EnergyLedger, TellsEachStepsChange) {
  Simulation<float> simulation(scene_of({"silk-swing", Method::bdf2, 5, 60, 1, 2}));
  simulation.request_level(0, 5);
  simulation.step();
  double before = energy_of(simulation).sum(), lost = 0;
  for (int step = 1; step < 2 * 60; ++step) {
    simulation.step();
    const AdvanceReport& report = simulation.last_advance(0);
    const double now = energy_of(simulation).sum();
    EXPECT_NEAR(now - before, report.energy_given_back - report.energy_lost, 1e-7) << step;
    before = now;
    lost += report.energy_lost;
  }
  EXPECT_GT(lost, 1e-4) << "J; the swing has 4 mJ";
}

// A sheet of 0.05 kg that slides down a slope: gravity does m g sin(a) on its way, friction takes mu m g
// cos(a).
TEST(EnergyLedger, TellsTheWorkOfGravityAndOfFriction) {
  constexpr double kFriction = 0.3, kMass = 0.05, kGravity = 9.81;  // kg, m/s2
  const double angle = 30 * std::numbers::pi / 180;
  SimulationDescription scene;
  ClothDescription sheet;
  sheet.size = {0.5, 0.5};
  sheet.min_level = sheet.initial_level = sheet.max_level = 3;
  sheet.material.density = kMass / 0.25;
  sheet.orientation = Quaternion(Eigen::AngleAxisd(angle, Vec3::UnitZ()) *
                                 Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  scene.cloths = {sheet};
  PlaneDescription slope;
  slope.normal = {-std::sin(angle), std::cos(angle), 0};
  ObstacleDescription ground;
  ground.shape = slope;
  ground.friction = kFriction;
  scene.obstacles = {ground};
  scene.effects = {GravityEffect{}};
  Simulation<float> simulation(scene);
  for (int step = 0; step < 10; ++step) simulation.step();  // until it lies on the slope
  const Vec3 begin = simulation.centre(0);
  double work = 0, took = 0;
  for (int step = 0; step < 60; ++step) {
    simulation.step();
    work += simulation.last_advance(0).effects_work;
    took += simulation.last_advance(0).contact_took;
  }
  const double way = (simulation.centre(0) - begin).norm(), weight = kMass * kGravity;
  EXPECT_GT(way, 0.5) << "m";
  EXPECT_NEAR(work, weight * std::sin(angle) * way, 0.01 * weight * way);
  EXPECT_NEAR(took, kFriction * weight * std::cos(angle) * way, 0.03 * weight * way);
}

/// Ten minutes, or as much of them as so many seconds of a processor are enough for, of the i-th of nine that
/// have each pair of level and rate once, of level and substeps, and of rate and substeps.
Run spread(const std::string& scene, Method method, int i, double processor) {
  constexpr std::array kRates{15, 60, 240}, kSubsteps{1, 3, 8};
  const auto u = static_cast<std::size_t>(i % 3), v = static_cast<std::size_t>(i / 3 % 3);
  const int level = 4 + static_cast<int>(u), substeps = kSubsteps[(u + v) % 3];
  Run run{scene, method, level, kRates[v], substeps, 600};
  run.processor = processor;
  return run;
}

std::vector<Run> swings() {
  std::vector<Run> runs;
  for (const char* scene : {"silk-swing", "strip"}) {
    for (const Method method : kMethods) {
      for (int i = 0; i < 9; ++i) runs.push_back(spread(scene, method, i, 100));
    }
  }
  return runs;
}

/// Each preset by each method, at places of the spread that change from preset to preset.
std::vector<Run> all_presets() {
  std::vector<Run> runs;
  int i = 0;
  for (const scene::Preset& preset : scene::presets()) {
    for (const Method method : kMethods) runs.push_back(spread(std::string(preset.name), method, i++, 20));
  }
  return runs;
}

INSTANTIATE_TEST_SUITE_P(NightlySwings, UndampedEnergy, ::testing::ValuesIn(swings()), name_of_run);
INSTANTIATE_TEST_SUITE_P(NightlyPresets, UndampedEnergy, ::testing::ValuesIn(all_presets()), name_of_run);

}  // namespace
}  // namespace weft::test
