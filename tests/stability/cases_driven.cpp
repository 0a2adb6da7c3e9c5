// Effects driven far while they run: S56 the paper's wind, S57 a zone of wind, S58 a hand, S59 pins, S60 the
// paper's damping.
#include <cmath>
#include <memory>

#include "criteria.h"
#include "draw.h"

namespace weft::stability {
namespace {

constexpr double kDriven = 4, kAfter = 8;  ///< s

/// Stretch that may stay besides: 0.059 and 0.077 were seen where what was driven hard stays crumpled. That
/// crushed shear and bending springs push a cell's sides apart, which gives this bound, is a guess.
double left_by_crumples(const SimulationDescription& hung) {
  const Material& material = hung.cloths[0].material;
  return (material.shear + material.bending) / material.structural.least();
}

double hung_stretch(const SimulationDescription& hung, const Setup& setup) {
  return 0.05 + xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * kGravity / (1 << setup.level));
}

/// 240 N on a sheet of 4 N: that of 60 m/s, at 1 N for each m2 and m/s.
Case paper_gale(std::string name, std::string what, bool along_normal) {
  constexpr double kSpeed = 60, kTurn = 0.5, kFactor = 1;
  const auto scene = [=](double speed) {
    return [=](const Setup& setup) {
      SimulationDescription made = ordinary_sheet(setup, {kTopEdge});
      made.effects.emplace_back(PaperWindEffect{kFactor, along_normal});
      made.wind = {{0, 0, -1}, speed};
      return made;
    };
  };
  Case made{std::move(name), std::move(what), {{kDriven, scene(kSpeed)}, {kAfter, scene(0)}}};
  made.drive = [](Simulation<float>& simulation, double time) {
    const bool back = static_cast<int>(time / kTurn) % 2 == 1;
    if (time < kDriven) simulation.set_wind({{0, 0, back ? 1.0 : -1.0}, kSpeed});
  };
  made.expect = [=](const Setup& setup) {
    Expectation expect;
    // A turn takes the sheet at most from one side to the other; of what it brought e^-5 is left at the next.
    expect.input = kFactor * kSpeed * kSize * kSize * 2 * kSize;
    expect.stretch_from = 2;  // e^-10 of the swing is left
    const SimulationDescription hung = scene(0)(setup);
    expect.stretch = hung_stretch(hung, setup) + left_by_crumples(hung);
    return expect;
  };
  return made;
}

/// A jet with an edge of a centimetre, finer than any cell, through the middle of a sheet.
Case jet() {
  constexpr double kSpeed = 60, kTurn = 0.25, kWide = 0.5;
  const auto scene = [=](const Setup& setup) {
    SimulationDescription made = ordinary_sheet(setup, {kTopEdge});
    made.effects.emplace_back(AerodynamicsEffect{});
    made.wind.zones = {{BoxZone{{kWide, kWide, 2 * kSize}}, {0.1, -0.3, 0}, {0, 0, -kSpeed}, 0.01}};
    return made;
  };
  Case made{"S57",
            "jet of 60 m/s, 0.5 m wide with an edge of 1 cm, to and fro, then none: comes to rest",
            {{kDriven + kAfter, scene}}};
  made.drive = [](Simulation<float>& simulation, double time) {
    if (time >= kDriven + kTurn) return;  // each change wakes the sheet
    const bool back = static_cast<int>(time / kTurn) % 2 == 1;
    const double speed = time < kDriven ? kSpeed : 0;
    simulation.set_wind_zone(0, {0, 0, back ? speed : -speed});
  };
  made.expect = [=](const Setup& setup) {
    const AerodynamicsEffect air;
    Expectation expect;
    // All of it, were it in the jet, from one side to the other, as in S5.
    const double pressure = air.air_density * air.drag * kSpeed * kSpeed / 2;
    expect.input = pressure * kSize * kSize * 2 * kSize;
    expect.stretch = hung_stretch(scene(setup), setup);
    expect.stretch_from = kDriven + 1;
    return expect;
  };
  return made;
}

/// A hand that nothing resists pulls at the free edge, to and fro, and lets go.
Case torn_at() {
  constexpr double kStart = 0.5, kPull = 0.2, kSpeed = 50, kForce = 1e6;  // s, s, m/s, N
  const auto scene = [](const Setup& setup) { return ordinary_sheet(setup, {kTopEdge}); };
  Case made{"S58",
            "a hand of 1e6 N takes the lower edge 10 m away at 50 m/s and lets go: strain back within 2 s",
            {{kAfter, scene}}};
  struct Hand {
    GrabId id = 0;
    Vec3 from{0, 0, 0};
  };
  const auto hand = std::make_shared<Hand>();
  made.drive = [hand](Simulation<float>& simulation, double time) {
    const double step = simulation.description().time_step;
    const long since = std::lround((time - kStart) / step), held = std::lround(kPull / step);
    const Particles<float>& state = simulation.cloths()[0].particles();
    if (since == 0) {
      hand->from = state.position_at(state.grid().rows - 1, state.grid().cols / 2);
      hand->id = simulation.grab(0, {0.5, 1}, hand->from, kForce);
    } else if (since > 0 && since < held) {
      simulation.move_grab(hand->id, hand->from + (time - kStart) * kSpeed * Vec3(0.6, 0, 0.8));
    } else if (since == held) {
      simulation.release(hand->id);
    }
  };
  made.expect = [=](const Setup& setup) {
    const SimulationDescription hung = scene(setup);
    const Material& material = hung.cloths[0].material;
    const double far = kSpeed * kPull, strain = far / kSize;
    Expectation expect;
    // No more than pulling all of it evenly would take, its speed, and its own links if the hand's node went
    // all of the way alone.
    expect.input = material.structural.most() * strain * strain / 2 * kSize * kSize +
                   mass_of(hung.cloths[0]) * kSpeed * kSpeed / 2 +
                   2 * (material.structural.most() + material.shear + material.bending) * far * far / 2;
    expect.stretch = hung_stretch(hung, setup) + left_by_crumples(hung);
    expect.stretch_from = kStart + kPull + 2;
    return expect;
  };
  return made;
}

/// A pin more on every third step, which the next one takes over from. A pin does no work: it stands.
Case pinned_in_motion() {
  constexpr int kEvery = 3;
  const auto scene = [](const Setup& setup) { return level_sheet(setup, {kTopLeft, kTopRight}); };
  Case made{"S59",
            "swings down from two corners, pinned somewhere else on every third step: brings in no energy",
            {{kDriven, scene}, {kAfter, scene}}};
  struct Pins {
    Draw draw{59};
    Vec2 at{0, 0};
    long step = 0;
  };
  made.drive = [pins = std::make_shared<Pins>()](Simulation<float>& simulation, double time) {
    if (time == 0) *pins = Pins{};
    if (time >= kDriven || pins->step++ % kEvery != 0) return;
    // The held edge's corners stay as they are.
    if (pins->step > 1) simulation.unpin(0, pins->at);
    const double u = pins->draw.between(0, 1);
    pins->at = {u, pins->draw.between(0.1, 1)};
    simulation.pin(0, pins->at);
  };
  made.expect = [scene](const Setup& setup) {
    const SimulationDescription hung = scene(setup);
    Expectation expect;
    expect.stretch = 0.05 + xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * kGravity / 2);
    return expect;
  };
  return made;
}

/// Falls at rho g / k, 1e-6 m/s, from the first step on, however it was thrown.
Case in_honey() {
  constexpr double kDamping = 1e6;  // kg/(m2 s)
  const auto scene = [](const Setup& setup) {
    SimulationDescription made = ordinary_sheet(setup, {kTopLeft});
    made.cloths[0].material.damping = kDamping;
    made.cloths[0].velocity = {30, 20, 100};
    return made;
  };
  Case made{"S60",
            "damping of 1e6 kg/(m2 s), thrown at 100 m/s: stands within the first step, and sleeps",
            {{2, scene}}};
  made.expect = [](const Setup&) {
    Expectation expect;
    expect.top_speed = 0.01;
    return expect;
  };
  return made;
}

}  // namespace

std::vector<Case> driven_cases() {
  return {
      paper_gale("S56a", "the paper's wind, 240 N that turn round every 0.5 s, then none: comes to rest",
                 false),
      paper_gale("S56b", "the same along the sheet's normal", true),
      jet(),
      torn_at(),
      pinned_in_motion(),
      in_honey(),
  };
}

}  // namespace weft::stability
