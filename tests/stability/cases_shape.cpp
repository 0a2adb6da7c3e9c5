// Hopeless shapes and shocks: S6, S12, S18, S19.
#include <random>

#include "endings.h"

namespace weft::stability {
namespace {

constexpr double kGravity = 9.81;

/// A start position for the node at row r and column c, which the flat sheet has at `flat`.
using Place = std::function<Vec3(int r, int c, const Vec3& flat)>;

/// The sheet hung by `pins`, its nodes put elsewhere but for the pinned ones.
SimulationDescription placed(const Setup& setup, const std::vector<PinRegion>& pins, const Place& place) {
  SimulationDescription scene = ordinary_sheet(setup, pins);
  const Simulation<float> flat(scene);
  const Particles<float>& state = flat.cloths()[0].particles();
  for (int r = 0; r < state.grid().rows; ++r) {
    for (int c = 0; c < state.grid().cols; ++c) {
      const Vec3 at = state.position_at(r, c);
      scene.cloths[0].nodes.push_back(state.inverse_mass.at(r, c) == 0 ? at : place(r, c, at));
    }
  }
  return scene;
}

/// Held by two corners, unfolds: strain under 5 % within 3 s, its centre as high as a flat sheet's.
Case crumpled(std::string name, std::string what, std::function<Place()> places) {
  const auto scene = [places = std::move(places)](const Setup& setup) {
    return placed(setup, {kTopLeft, kTopRight}, places());
  };
  Case made{std::move(name), std::move(what), {{5, scene}}};
  made.expect = [](const Setup& setup) {
    const SimulationDescription hung = ordinary_sheet(setup, {});
    Expectation expect;
    expect.stretch = 0.05 + xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * kGravity / 2);
    expect.stretch_from = 3;
    return expect;
  };
  made.ending = centre_comes_to(0, 0.1);
  return made;
}

Place random_places() {
  return [random = std::mt19937_64(1)](int, int, const Vec3&) mutable -> Vec3 {
    const auto within_box = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1.0; };
    const double x = within_box(), y = within_box(), z = within_box();
    return {x, y, z};
  };
}

Case ribbon() {
  const auto scene = [](const Setup& setup) {
    SimulationDescription made = ordinary_sheet(setup, {{0, 0, 0, 1}});
    made.cloths[0].size = {kSize, kSize / 100};
    return made;
  };
  Case made{
      "S12", "cells of 1 : 100, a ribbon of 2 m x 2 cm falls from lying: hangs straight down", {{5, scene}}};
  made.expect = [scene](const Setup& setup) {
    const SimulationDescription hung = scene(setup);
    Expectation expect;
    expect.stretch = 0.05 + xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * kGravity / (1 << setup.level));
    return expect;
  };
  made.ending = ribbon_hangs_down(0.01);
  return made;
}

Expectation settles_within_two_seconds(const Setup& setup) {
  const SimulationDescription hung = ordinary_sheet(setup, {kTopEdge});
  Expectation expect;
  expect.stretch = 0.05 + xpbd_excess(hung, setup, mass_of(hung.cloths[0]) * kGravity / (1 << setup.level));
  expect.stretch_from = 2;
  return expect;
}

Case shot_node() {
  constexpr float kSpeed = 1000;
  Case made{"S18",
            "1,000 m/s on one node: bounded by its energy, hangs flat again",
            {{5, [](const Setup& setup) { return ordinary_sheet(setup, {kTopEdge}); }}}};
  made.prepare = [](Simulation<float>& simulation) {
    Particles<float>& state = simulation.cloths()[0].particles();
    state.velocity.z.at(state.grid().rows / 2, state.grid().cols / 2) = kSpeed;
  };
  made.expect = settles_within_two_seconds;
  made.ending = hangs_flat(0.01);
  return made;
}

Case coincident() {
  const auto scene = [](const Setup& setup) {
    const int middle = 1 << (setup.level - 1);
    const double cell = kSize / (1 << setup.level);
    return placed(setup, {kTopEdge}, [=](int r, int c, const Vec3& flat) -> Vec3 {
      return flat + Vec3(c == middle ? -cell : 0, r == middle ? cell : 0, 0);
    });
  };
  Case made{"S19",
            "a row and a column lie on their neighbours: no division by zero, hangs flat again",
            {{5, scene}}};
  made.expect = settles_within_two_seconds;
  made.ending = hangs_flat(0.01);
  return made;
}

}  // namespace

std::vector<Case> shape_cases() {
  // The pinned corners stay at (-1, 1, 0) and (1, 1, 0).
  return {
      crumpled("S6a", "all nodes on one line",
               [] { return [](int, int, const Vec3& flat) -> Vec3 {
                      return {flat.x(), 1, 0};
                    }; }),
      crumpled("S6b", "all nodes on one point",
               [] { return [](int, int, const Vec3&) -> Vec3 {
                      return {0, 1, 0};
                    }; }),
      crumpled("S6c", "nodes anywhere in the 2 m box", random_places),
      crumpled("S6d", "every second row mirrored: inverted cells",
               [] {
                 return [](int r, int, const Vec3& flat) -> Vec3 {
                   return {r % 2 == 1 ? -flat.x() : flat.x(), flat.y(), flat.z()};
                 };
               }),
      ribbon(),
      shot_node(),
      coincident(),
  };
}

}  // namespace weft::stability
