// Effects driven far: S42 plates, S43 damped springs, S46 pillows.
#include <memory>

#include "criteria.h"

namespace weft::stability {
namespace {

/// Held level by one edge, which clamps it there, and let go: limp it swings down, as a board it stays up.
Case let_go(std::string name, std::string what, double rigidity) {
  const auto scene = [=](const Setup& setup) {
    SimulationDescription made = level_sheet(setup, {kTopEdge});
    made.effects.emplace_back(PlateBendingEffect{});
    made.cloths[0].material.rigidity = {rigidity, rigidity, rigidity};
    return made;
  };
  Case made{std::move(name), std::move(what), {{8, scene}}};
  made.expect = [=](const Setup& setup) {
    const SimulationDescription held = scene(setup);
    Expectation expect;
    expect.stretch = 0.05;
    expect.excess = xpbd_excess(held, setup, mass_of(held.cloths[0]) * kGravity / (1 << setup.level));
    return expect;
  };
  return made;
}

/// No step may leave more energy than the one before, but for a ten-thousandth of what there is to lose.
/// XPBD's springs never count (criteria.h).
Watch only_loses_energy(const Setup& setup, double to_lose) {
  constexpr double kRounding = 1e-4;
  const auto last = std::make_shared<double>(0);
  return [=](const Simulation<float>& simulation, double time) -> Complaint {
    if (setup.method == Method::xpbd) return {};
    const double energy = read(simulation, true).energy, gained = energy - *last;
    *last = energy;
    if (time == 0 || gained <= kRounding * to_lose) return {};
    return "damping brings in " + std::to_string(gained) + " J in a step; at most 1e-4 of what there is, " +
           std::to_string(kRounding * to_lose);
  };
}

constexpr double kDampingTime = 0.1;  ///< s

/// A tenth longer and wider than it is at rest, without gravity. Its slowest way of breathing, w = pi c / L =
/// 350 1/s with c^2 = Y / rho, is damped far beyond critical: it creeps back at 1 / tau, so that after 2 s
/// e^-20 is left of it.
Case stretched() {
  constexpr double kLonger = 1.1;
  const auto scene = [](const Setup& setup) {
    SimulationDescription made = ordinary_sheet(setup, {});
    made.effects = {StrainDampingEffect{kDampingTime}};
    return made;
  };
  Case made{
      "S43a",
      "damped springs, tau 0.1 s, sheet let go a tenth too large: creeps back, no step brings in energy",
      {{4, scene}}};
  made.prepare = [](Simulation<float>& simulation) {
    VectorField<float>& position = simulation.cloths()[0].particles().position;
    const Grid& grid = position.grid();
    for (Field<float>* component : {&position.x, &position.y, &position.z}) {
      for (int r = 0; r < grid.rows; ++r) {
        for (int c = 0; c < grid.cols; ++c) component->at(r, c) *= static_cast<float>(kLonger);
      }
    }
  };
  made.watch = [](const Setup& setup) {
    // Structural springs of both directions: 2 Y e^2 / 2 a square metre.
    return only_loses_energy(setup, 5000 * (kLonger - 1) * (kLonger - 1) * kSize * kSize);
  };
  made.expect = [](const Setup&) {
    Expectation expect;
    expect.stretch = 1e-3;
    expect.stretch_from = 2;
    expect.rests = false;  // nothing stops its turning, be it ever so slow
    return expect;
  };
  return made;
}

Case swung_down() {
  const auto scene = [](const Setup& setup) {
    SimulationDescription made = level_sheet(setup, {kTopLeft, kTopRight});
    made.effects.emplace_back(StrainDampingEffect{kDampingTime});
    return made;
  };
  Case made{"S43b",
            "damped springs, tau 0.1 s, swings down from two corners: no step brings in energy",
            {{8, scene}}};
  made.watch = [scene](const Setup& setup) {
    return only_loses_energy(setup, mass_of(scene(setup).cloths[0]) * kGravity * kSize);
  };
  made.expect = [scene](const Setup& setup) {
    const SimulationDescription hung = scene(setup);
    Expectation expect;
    expect.stretch = 0.05;
    expect.excess = xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * kGravity / 2);
    return expect;
  };
  return made;
}

/// Two squares of 1 m sewn together, with gas.
SimulationDescription pillow(const Setup& setup, const InflationEffect& gas) {
  SimulationDescription made = level_sheet(setup, {});
  ClothDescription& cloth = made.cloths[0];
  cloth.sewn = true;
  cloth.size = {2, 1};
  cloth.base_cells = {2, 1};
  for (int* level : {&cloth.min_level, &cloth.max_level, &cloth.initial_level}) *level = setup.level - 1;
  made.effects.emplace_back(StrainDampingEffect{0.002});
  made.effects.emplace_back(gas);
  return made;
}

/// How far a pillow's springs stretch that is half full: its gas presses with no more than the sheet weighs,
/// 2 Pa, which at a radius of 0.1 m pulls the sheet by 4e-5 of its stiffness. XPBD's springs bear more where
/// they run along the fold that both its sides hang on: the sheet is shut there, and a bending spring across
/// it, B / 2 stiff and two cells long, pushes with B l.
Expectation half_full(const SimulationDescription& bag, const Setup& setup) {
  const ClothDescription& cloth = bag.cloths[0];
  const int cells = cloth.base_cells.at(cloth.initial_level).rows - 1;
  Expectation expect;
  expect.stretch = 0.05;
  expect.excess = xpbd_excess(bag, setup, cloth.material.bending * cloth.size.y() / cells);
  expect.stretch_from = 3;
  return expect;
}

/// A pair of nodes apart, or later a bag inside out, is a fault.
Watch stays_closed(const Setup&) {
  return [](const Simulation<float>& simulation, double time) -> Complaint {
    const Cloth<float>& bag = simulation.cloths()[0];
    const VectorField<float>& at = bag.particles().position;
    for (const auto& [left, right] : bag.seam()->pairs()) {
      for (const Field<float>* component : {&at.x, &at.y, &at.z}) {
        if (component->row(0)[left] != component->row(0)[right]) return "the seam is open";
      }
    }
    const double volume = enclosed_volume(at);
    if (time > 1 && !(volume > 0)) return "holds " + std::to_string(volume) + " m3";
    return {};
  };
}

/// Thrown flat on the floor, half full of air.
Case thrown_pillow() {
  const auto scene = [](const Setup& setup) {
    SimulationDescription made = pillow(setup, {0, 0.1, 0.5});
    made.cloths[0].position = {0, 1, 0};
    made.cloths[0].velocity = {3, -20, 0};
    ObstacleDescription floor;
    floor.shape = PlaneDescription{};
    floor.friction = 0.5;
    made.obstacles = {floor};
    return made;
  };
  Case made{"S46a",
            "pillow thrown on the floor at 20 m/s while it is filled: stays sewn, comes to rest",
            {{6, scene}}};
  made.levels = {4, 5};
  made.watch = stays_closed;
  made.expect = [scene](const Setup& setup) {
    Expectation expect = half_full(scene(setup), setup);
    expect.input = Gas<float>::kOutside * 0.1;  // what pouring in may do
    return expect;
  };
  return made;
}

/// All of the gas is there at once, in a bag that lies flat: 25 atmospheres, which blow it up within a step.
Case burst_open() {
  const auto scene = [](const Setup& setup) { return pillow(setup, {0, 0.1, 0}); };
  Case made{"S46b", "flat bag with all of its gas at once, at 25 atmospheres: stays sewn", {{4, scene}}};
  made.levels = {4, 5};
  made.watch = stays_closed;
  made.expect = [scene](const Setup& setup) {
    Expectation expect = half_full(scene(setup), setup);
    expect.input = 8 * Gas<float>::kOutside * 0.1;
    expect.rests = false;  // it falls
    return expect;
  };
  return made;
}

}  // namespace

std::vector<Case> effect_cases() {
  return {
      let_go("S42a", "plate of 1e-6 N m held level by an edge: swings down, comes to rest", 1e-6),
      let_go("S42b", "plate of 1e-2 N m, the same", 1e-2),
      let_go("S42c", "plate of 100 N m, a board: the same", 100),
      stretched(),
      swung_down(),
      thrown_pillow(),
      burst_open(),
  };
}

}  // namespace weft::stability
