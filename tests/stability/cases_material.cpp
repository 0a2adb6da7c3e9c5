// Stiffness, mass, step and load: S1 to S5, S13, S22.
#include <array>
#include <cmath>
#include <numbers>

#include "endings.h"

namespace weft::stability {
namespace {

/// Swings down from lying flat, held by two corners: each bears half of the weight. `stretch` is allowed by
/// level, from 4 on.
Case swung_down(std::string name, std::string what, double structural, std::array<double, 3> stretch) {
  const auto scene = [structural](const Setup& setup) {
    SimulationDescription made = level_sheet(setup, {kTopLeft, kTopRight});
    made.cloths[0].material.structural = structural;
    return made;
  };
  Case made{std::move(name), std::move(what), {{8, scene}}};
  made.expect = [=](const Setup& setup) {
    const SimulationDescription hung = scene(setup);
    Expectation expect;
    expect.stretch = stretch.at(static_cast<std::size_t>(setup.level - 4));
    expect.excess = xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * kGravity / 2);
    return expect;
  };
  // Forces of 1e7 N/m times the rounding of single precision heat a sheet that nothing else damps.
  made.beyond_explicit = structural > 1e6;
  return made;
}

constexpr std::array<double, 3> every_level(double stretch) { return {stretch, stretch, stretch}; }

/// With Y = 0.1 N/m the shear springs alone hold the sheet, and a point bears half of the weight: the spring
/// beside it is longer the smaller it is. Largest after the first second, BDF2 in double precision with 8
/// substeps, a tolerance of 1e-4 and 20 linearisations (with 4: 1.521, 1.690, 2.217; backward Euler with
/// 8: 1.519, 1.671, 2.205), and a twentieth more.
constexpr std::array<double, 3> kHeldByShear{1.05 * 1.521, 1.05 * 1.694, 1.05 * 2.208};

Case heavy_node() {
  constexpr double kHeavier = 1e4;
  const auto scene = [](const Setup& setup) { return ordinary_sheet(setup, {kTopEdge}); };
  Case made{"S2",
            "one node of the free edge 1e4 times heavier: strain within 2 points of the converged",
            {{5, scene}}};
  made.prepare = [](Simulation<float>& simulation) {
    Particles<float>& state = simulation.cloths()[0].particles();
    const int row = state.grid().rows - 1, col = state.grid().cols / 2;
    state.mass.at(row, col) *= static_cast<float>(kHeavier);
    state.inverse_mass.at(row, col) = 1 / state.mass.at(row, col);
  };
  made.expect = [scene](const Setup& setup) {
    // Backward Euler in double precision with 4 substeps, a tolerance of 1e-4 and 20 linearisations, after 5
    // s.
    constexpr double kConverged[] = {0.0910, 0.0470, 0.0239}, kPoints = 0.02;
    const SimulationDescription hung = scene(setup);
    const double node = mass_of(hung.cloths[0]) / std::pow(4.0, setup.level) / 2;
    Expectation expect;
    expect.stretch = kConverged[setup.level - 4] + kPoints;
    expect.stretch_least = kConverged[setup.level - 4] - kPoints;
    expect.excess = xpbd_excess(hung, setup, kHeavier * node * kGravity);
    expect.stretch_from = 4;
    // What it falls by when it is let go is the sheet's stretch, under a tenth of a metre.
    expect.input = kHeavier * node * kGravity * 0.1;
    return expect;
  };
  return made;
}

Case hundred_g() {
  const auto scene = [](double share) {
    return [share](const Setup& setup) {
      SimulationDescription made = level_sheet(setup, {kTopEdge});
      made.effects[0] = GravityEffect{share * standard_gravity()};
      return made;
    };
  };
  Case made{
      "S4", "100 g for 2 s, then 1 g: comes back to the shape at 1 g", {{2, scene(100)}, {5, scene(1)}}};
  made.expect = [scene](const Setup& setup) {
    const SimulationDescription hung = scene(1)(setup);
    Expectation expect;
    expect.stretch = 0.05;
    expect.excess = xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * kGravity / (1 << setup.level));
    return expect;
  };
  made.ending = hangs_flat(0.01);
  return made;
}

Case gale() {
  constexpr double kSpeed = 60, kTurn = 0.5, kSeconds = 5;
  const auto scene = [](double speed) {
    return [speed](const Setup& setup) {
      SimulationDescription made = ordinary_sheet(setup, {kTopEdge});
      made.effects.emplace_back(AerodynamicsEffect{});
      made.wind = {{0, 0, -1}, speed};
      return made;
    };
  };
  Case made{"S5",
            "wind of 60 m/s, turning round every 0.5 s, then none: comes to rest",
            {{kSeconds, scene(kSpeed)}, {8, scene(0)}}};
  // Not flat for sure: an edge that the wind wound up stays so, held by the bending springs, with every
  // method.
  made.drive = [](Simulation<float>& simulation, double time) {
    const bool back = static_cast<int>(time / kTurn) % 2 == 1;
    if (time < kSeconds) simulation.set_wind({{0, 0, back ? 1.0 : -1.0}, kSpeed});
  };
  made.expect = [scene](const Setup& setup) {
    const SimulationDescription hung = scene(0)(setup);
    const AerodynamicsEffect air;
    // Its pressure takes the sheet at most from one side to the other.
    const double pressure = air.air_density * air.drag * kSpeed * kSpeed / 2;
    Expectation expect;
    expect.input = pressure * kSize * kSize * 2 * kSize;
    expect.stretch = 0.05;
    expect.excess = xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * kGravity / (1 << setup.level));
    return expect;
  };
  return made;
}

Case gusty_gale() {
  constexpr double kSpeed = 40, kIntensity = 0.25, kPeak = kSpeed * (1 + 6 * kIntensity), kSeconds = 5;
  const auto scene = [](double speed) {
    return [speed](const Setup& setup) {
      SimulationDescription made = ordinary_sheet(setup, {kTopEdge});
      made.effects.emplace_back(AerodynamicsEffect{});
      made.wind = {{0, 0, -1}, speed, {kIntensity, 0.3}, {kIntensity, 0.5}, {}};
      return made;
    };
  };
  Case made{"S5b",
            "wind of 40 m/s in gusts and eddies that reach 60 m/s, then none: comes to rest",
            {{kSeconds, scene(kSpeed)}, {8, scene(0)}}};
  made.expect = [scene](const Setup& setup) {
    const SimulationDescription hung = scene(0)(setup);
    const AerodynamicsEffect air;
    // The pressure of six deviations takes the sheet at most from one side to the other.
    const double pressure = air.air_density * air.drag * kPeak * kPeak / 2;
    Expectation expect;
    expect.input = pressure * kSize * kSize * 2 * kSize;
    expect.stretch = 0.05;
    expect.excess = xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * kGravity / (1 << setup.level));
    return expect;
  };
  return made;
}

/// Of structural springs alone, as its stretch is then known to rounding: swings down from 30 degrees.
Case sized(std::string name, std::string what, double size) {
  const double swing = 1.202 * std::sqrt(kGravity / size);  // 1/s: j01/2 sqrt(g/L), T8 of the truths
  const double seconds = 12 / swing;                        // e^-12 of the swing is left
  const auto scene = [=](const Setup& setup) {
    SimulationDescription made = ordinary_sheet(setup, {kTopEdge});
    made.sleep_speed *= size / kSize;
    ClothDescription& cloth = made.cloths[0];
    cloth.size = {size, size};
    cloth.orientation = Quaternion(Eigen::AngleAxisd(std::numbers::pi / 6, Vec3::UnitX()));
    cloth.material.shear = cloth.material.bending = 0;
    cloth.material.damping = 2 * swing * cloth.material.density;  // critical
    return made;
  };
  Case made{std::move(name), std::move(what), {{std::max(1.0, seconds), scene}}};
  made.expect = [=](const Setup& setup) {
    const SimulationDescription hung = scene(setup);
    const Material& material = hung.cloths[0].material;
    Expectation expect;
    const double at_rest = material.density * kGravity * size / material.structural.weft;  // at the top
    expect.stretch = 0.01 + 1.01 * at_rest;
    expect.excess = xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * kGravity / (1 << setup.level));
    expect.stretch_from = std::max(0.8, 0.8 * seconds);
    return expect;
  };
  made.ending = hangs_flat(0.01);
  return made;
}

/// Held all round its rim, blown up at one blow by two fifths of Y / L, then let down: for the default sheet
/// 1 kPa, 1,000 times its weight.
Case blown_up() {
  constexpr double kPressure = 0.4 * 5000 / kSize, kSeconds = 3;
  const auto scene = [=](double share) {
    return [=](const Setup& setup) {
      SimulationDescription made = level_sheet(setup, {kTopEdge, {0, 1, 1, 1}, {0, 0, 0, 1}, {1, 1, 0, 1}});
      made.effects.emplace_back(InflationEffect{share * kPressure});
      return made;
    };
  };
  Case made{"S22",
            "held all round, blown up at one blow by 1,000 times its weight, then let down: comes to rest",
            {{kSeconds, scene(1)}, {8, scene(0)}}};
  made.expect = [=](const Setup& setup) {
    const SimulationDescription held = scene(0)(setup);
    Expectation expect;
    // At most a half ball's volume over the rim's circle, several times what it takes.
    expect.input = kPressure * 2.0 / 3 * std::numbers::pi * std::pow(kSize / std::numbers::sqrt2, 3);
    expect.stretch = 0.05;
    expect.excess = xpbd_excess(held, setup, mass_of(held.cloths[0]) * kGravity / (1 << setup.level));
    expect.stretch_from = kSeconds + 2;
    return expect;
  };
  return made;
}

}  // namespace

std::vector<Case> material_cases() {
  return {
      swung_down("S1a", "Y = 1e7 N/m, swings down from two corners: strain under 0.1 %", 1e7,
                 every_level(0.001)),
      swung_down(
          "S1b",
          "Y = 0.1 N/m, the same: shear springs alone hold it, strain within a twentieth of the converged",
          0.1, kHeldByShear),
      heavy_node(),
      swung_down("S3", "steps of 1/60, 1/30 and 1/15 s, swings down from two corners: strain under 5 %", 5000,
                 every_level(0.05)),
      hundred_g(),
      gale(),
      gusty_gale(),
      blown_up(),
      sized("S13a", "sheet of 1 mm: hangs as the formula says, relative to its size", 1e-3),
      sized("S13b", "sheet of 1 km: the same", 1e3),
  };
}

}  // namespace weft::stability
