// Sheets that lie exactly in a coordinate's plane: what folds within it opens as it would in any other plane,
// and what does not fold stays in it.
#include <gtest/gtest.h>

#include "cloth/world/simulation.h"
#include "fixtures.h"

namespace weft {
namespace {

constexpr double kCell = 1.0 / 16;  // m
constexpr int kRows = 16, kCols = 4;

/// A strip of 1 m that hangs by its upper edge in the plane z = 0 from these heights of its rows, m, in
/// cells.
SimulationDescription strip(const std::vector<int>& heights, const IntegratorDescription& integrator) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {kCols * kCell, kRows * kCell};
  cloth.base_cells = {1, kRows / kCols};
  cloth.min_level = cloth.initial_level = cloth.max_level = 2;
  // So damped that it hangs still after a few seconds.
  cloth.material = {.density = 0.5, .structural = 100, .shear = 20, .damping = 1};
  cloth.material.limit = {0.05, 0.05, 0.3, 20};
  cloth.pins = {{0, 1, 0, 0}};
  for (const int height : heights) {
    for (int c = 0; c <= kCols; ++c) cloth.nodes.emplace_back(c * kCell, height * kCell, 0.0);
  }
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{}, DampingEffect{}, StrainLimitEffect{}};
  scene.integrator = integrator;
  return scene;
}

class InAPlane : public ::testing::TestWithParam<IntegratorDescription> {};
INSTANTIATE_TEST_SUITE_P(Integrators, InAPlane,
                         ::testing::Values(SymplecticEulerDescription{}, BackwardEulerDescription{},
                                           Bdf2Description{}, XpbdDescription{}),
                         [](const auto& test) {
                           return std::visit([](const auto& d) { return std::string(d.kName); }, test.param);
                         });

TEST_P(InAPlane, AFoldOpens) {
  // Down by six rows, up by four, down by six: the middle stands on the lower bend and bears what hangs from
  // the upper one. In the plane alone it keeps standing.
  std::vector<int> heights;
  for (int r = 0; r <= kRows; ++r) heights.push_back(r <= 6 ? -r : r <= 10 ? r - 12 : 8 - r);
  Simulation<float> simulation(strip(heights, GetParam()));
  for (int step = 0; step < 300; ++step) simulation.step();
  const Particles<float>& particles = simulation.cloths()[0].particles();
  for (int c = 0; c <= kCols; ++c) EXPECT_LT(particles.position_at(kRows, c).y(), -0.95) << c;
}

TEST_P(InAPlane, WhatDoesNotFoldStaysInIt) {
  std::vector<int> heights;
  for (int r = 0; r <= kRows; ++r) heights.push_back(-r);
  SimulationDescription scene = strip(heights, GetParam());
  scene.cloths[0].material.structural = 5000;  // it stretches by 0.1 %
  Simulation<float> simulation(scene);
  for (int step = 0; step < 60; ++step) simulation.step();
  test::each_node(simulation.cloths()[0].particles().grid(), [&](int r, int c) {
    ASSERT_EQ(simulation.cloths()[0].particles().position_at(r, c).z(), 0);
  });
}

}  // namespace
}  // namespace weft
