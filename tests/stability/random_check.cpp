// What a random scene is held to.
#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/forces/grab.h"
#include "criteria.h"
#include "merges.h"
#include "random_loads.h"
#include "random_scenes.h"
#include "random_surroundings.h"

namespace weft::stability {
namespace {

Method method_of(const IntegratorDescription& integrator) {
  constexpr Method kMethods[] = {Method::symplectic_euler, Method::backward_euler, Method::bdf2,
                                 Method::xpbd};
  return kMethods[integrator.index()];
}

bool is_implicit(Method method) { return method == Method::backward_euler || method == Method::bdf2; }

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

/// How deep a place is in a solid that does not yield, m. What yields is pressed into nodes that it has met
/// before; and what lies between two solids stays on one of them, however deep it is in the other.
double depth_at(const Vec3& place, const std::vector<Solid>& solids) {
  constexpr double kBetween = 1e-3;  // m
  int near = 0;
  double depth = 0;
  for (const Solid& solid : solids) {
    const PlacedShape placed = solid.placed(1);
    if (!placed.may_touch(place, kBetween)) continue;
    const double distance = placed.surface(place).distance;
    if (distance < kBetween) ++near;
    if (!solid.yields()) depth = std::max(depth, -distance);
  }
  return near == 1 ? depth : 0;
}

/// The deepest that a node which is not pinned is in a solid, m.
double deepest_inside(const Simulation<float>& simulation) {
  double deepest = 0;
  for (const Cloth<float>& cloth : simulation.cloths()) {
    const Particles<float>& state = cloth.particles();
    for (int r = 0; r < state.grid().rows; ++r) {
      for (int c = 0; c < state.grid().cols; ++c) {
        if (state.inverse_mass.at(r, c) == 0) continue;
        deepest = std::max(deepest, depth_at(state.position_at(r, c), simulation.colliders().solids()));
      }
    }
  }
  return deepest;
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
  /// J, of all changes so far.
  double all_raised() const { return all_raised_; }
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
      all_raised_ += raised_;
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
  double raised_ = 0, all_raised_ = 0;
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
  const long steps = std::lround(kRandomSeconds / scene.time_step);
  const bool beyond = overloaded(scene);
  bool held_by_guard = false;
  for (long step = 0; step < steps; ++step) {
    const bool switched = commands.give(step);
    simulation.step();
    const std::string when = " after step " + std::to_string(step + 1);
    if (!simulation.healthy()) return Failure{Failure::Kind::not_finite, "not finite" + when};
    if (const Complaint guarded = guard_complaint(simulation)) {
      // Changes by the paper's rules that come and go shake a sheet ever harder (raised).
      held_by_guard = held_by_guard || beyond || commands.all_raised() > energy_beyond_guard(scene);
      if (!held_by_guard) return Failure{Failure::Kind::guard, *guarded + when};
    }
    if (held_by_guard) continue;
    if (const double depth = deepest_inside(simulation); depth > Expectation{}.penetration)
      return Failure{Failure::Kind::inside, "a node " + std::to_string(depth) + " m inside a solid" + when};
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
