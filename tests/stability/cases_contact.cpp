// Cloth that meets cloth: S51. What holds for all: no triangle passes through another one, by a test of its
// own that decides exactly (unit/cloth/fixtures/intersections.h), and layers bring in no energy.
#include <algorithm>
#include <limits>
#include <memory>

#include "criteria.h"
#include "unit/cloth/fixtures/folding_scenes.h"
#include "unit/cloth/fixtures/held.h"
#include "unit/cloth/fixtures/intersections.h"

namespace weft::stability {
namespace {

/// Of every fifth step, from the first on.
Watch nothing_crosses(const Setup&) {
  constexpr int kEvery = 5;
  const auto step = std::make_shared<int>(0);
  return [step](const Simulation<float>& simulation, double) -> Complaint {
    if ((*step)++ % kEvery != 0) return {};
    test::TriangleSoup soup;
    for (const Cloth<float>& cloth : simulation.cloths()) soup.add(cloth.particles());
    const int count = test::count_intersections(soup);
    if (count == 0) return {};
    return std::to_string(count) + " pairs of triangles pass through each other";
  };
}

/// Of those that take minutes at level 6. There S51c is not claimed: nodes of the two cloths still shook
/// after 4 s, by 0.6 mm a step (BDF2, 60 Hz).
const std::vector<int> kBelowFinest{4, 5};

/// A scene of the unit tests, stepped as the setup says.
using Made = SimulationDescription (*)(int level, const IntegratorDescription&);
std::function<SimulationDescription(const Setup&)> stepped(Made made) {
  return [made](const Setup& setup) {
    SimulationDescription scene = made(setup.level, integrator_of(setup));
    scene.time_step = setup.time_step();
    return scene;
  };
}

/// As it is when a cloth is to come to rest: with the ordinary sheet's drag, and allowed to sleep.
std::function<SimulationDescription(const Setup&)> calmed(Made made) {
  return [made](const Setup& setup) {
    SimulationDescription scene = stepped(made)(setup);
    for (ClothDescription& cloth : scene.cloths) cloth.material.damping = 0.5;
    scene.effects.emplace_back(DampingEffect{});
    scene.sleep_speed = SimulationDescription{}.sleep_speed;
    return scene;
  };
}

bool is_explicit(const Setup& setup) {
  return setup.method == Method::explicit_fixed || setup.method == Method::symplectic_euler;
}

/// Comes to rest, but with explicit methods, whose layers go on shaking within their thickness.
Case met(std::string name, std::string what, double seconds, Made scene) {
  Case made{std::move(name), std::move(what), {{seconds, calmed(scene)}}};
  made.watch = nothing_crosses;
  made.expect = [=](const Setup& setup) {
    const SimulationDescription falls = calmed(scene)(setup);
    Expectation expect;
    expect.stretch = 0.05 + xpbd_excess(falls, setup, mass_of(falls.cloths[0]) * kGravity);
    // It falls for 0.5 s; layers that meet in the fall are stopped at their springs' cost.
    expect.stretch_from = 1.5;
    expect.rests = !is_explicit(setup);
    return expect;
  };
  return made;
}

/// Besides, what the hands put in less what the strip has may not grow by more than a twentieth: contact only
/// takes energy. Not of XPBD and explicit methods, whose layers are held apart in a rope so tight at their
/// springs' cost (scenes.md, cloth_contact), nor of longer steps, in which a hand turns by 24 degrees and
/// more: its work is the trapezoidal rule's no more.
class WorkOfHands {
 public:
  explicit WorkOfHands(const Setup& setup) : crosses_(nothing_crosses(setup)), counts_(claims(setup)) {}

  static bool claims(const Setup& setup) {
    return setup.hz == 60 && (setup.method == Method::backward_euler || setup.method == Method::bdf2);
  }

  Complaint operator()(const Simulation<float>& simulation, double time) {
    test::Held now = test::Held::of(simulation.cloths()[0]);
    if (time > 0) put_in_ += test::work(held_, now);
    held_ = std::move(now);
    const ClothReport report = simulation.report(0);
    const double lost = put_in_ - report.kinetic_energy - report.potential_energy;
    most_lost_ = time > 0 ? std::max(most_lost_, lost) : lost;
    if (Complaint crossed = crosses_(simulation, time)) return crossed;
    const double gained = most_lost_ - lost;
    if (!counts_ || gained <= kShare * std::max(put_in_, kAtRest)) return {};
    return "gains " + std::to_string(gained) + " J where the hands put in " + std::to_string(put_in_);
  }

 private:
  static constexpr double kShare = 0.05;
  static constexpr double kAtRest = 1;  ///< J: before the hands have put in as much there is nothing to share

  Watch crosses_;
  bool counts_;
  test::Held held_;
  double put_in_ = 0, most_lost_ = 0;
};

Case wrung() {
  Case made{
      "S51b",
      "strip wrung by four turns in 2 s: never crosses itself, gains no more than a twentieth of the work",
      {{2.2, stepped(test::wrung)}}};
  made.levels = kBelowFinest;
  made.watch = [](const Setup& setup) -> Watch {
    const auto work = std::make_shared<WorkOfHands>(setup);
    return [work](const Simulation<float>& simulation, double time) { return (*work)(simulation, time); };
  };
  made.expect = [](const Setup& setup) {
    Expectation expect;
    // J, that the hands put in: 13.2 with backward Euler at 60 Hz; as much again where they go by jumps.
    expect.input = setup.hz == 60 ? 15 : 30;
    expect.stretch = std::numeric_limits<double>::infinity();  // by the hands
    expect.rests = false;                                      // nothing slows it but its layers
    return expect;
  };
  return made;
}

}  // namespace

std::vector<Case> contact_cases() {
  Case caught = met("S51c", "small sheet falls flat onto one held by its corners: neither passes through", 2,
                    test::caught);
  Case fall_together = met("S51d", "two sheets, one above the other, fall on a floor: neither passes through",
                           2, test::fall_together);
  for (Case* each : {&caught, &fall_together}) each->levels = kBelowFinest;
  return {
      met("S51a", "square of 1 m dropped on its edge into a heap: never crosses itself", 2,
          test::dropped_on_edge),
      wrung(),
      std::move(caught),
      std::move(fall_together),
  };
}

}  // namespace weft::stability
