// Features of one cloth that would meet in a substep.
#include "cloth/contact/recovery/substep_net.h"

#include <gtest/gtest.h>

#include "cloth/sheet/diagnostics.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;
using test::set;

constexpr double kNetGap = 1e-3;  // m
const Substep kNetSubstep{0, 0.25, 0.01};

/// A strip of 3 x 8 nodes, folded over between its fourth and its fifth column into two layers, `height`
/// apart, of which the upper one's nodes come down with this velocity. In a step of four such substeps.
struct FoldedStrip {
  FoldedStrip(double height, const Vec3& velocity) : particles(Grid::with_nodes(3, 8)) {
    const Grid& grid = particles.grid();
    particles.place = {10, 0, -3};
    nodes.first = {0, static_cast<std::uint32_t>(grid.size())};
    nodes.start.assign(grid.size(), particles.place);
    inverse_mass.assign(grid.size(), 0);
    nodes.tangled.assign(grid.size(), 0);
    each_node(grid, [&](int r, int c) {
      const bool upper = c >= 4;
      const double along = upper ? 7 - c + 0.3 : c;
      set(particles.position, r, c, {0.1 * along, upper ? height : 0, 0.1 * r});
      set(particles.velocity, r, c, upper ? velocity : Vec3(0, 0, 0));
      particles.mass.at(r, c) = 0.5 + 0.1 * c;
      particles.inverse_mass.at(r, c) = 1 / particles.mass.at(r, c);
      nodes.start[grid.index(r, c)] = particles.position_at(r, c);
      inverse_mass[grid.index(r, c)] = particles.inverse_mass.at(r, c);
    });
    nodes.end = nodes.start;
    const double step = kNetSubstep.step_seconds();
    each_node(grid, [&](int r, int c) { nodes.end[grid.index(r, c)] += step * particles.velocity_at(r, c); });
    nodes.velocity = nodes.acceleration = nodes.support = nodes.start;
    nodes.inverse_mass = inverse_mass;
    nodes.lies.assign(grid.size(), 0);
    search.set_grids({grid});
    search.find(nodes, 10 * kNetGap);
  }
  void begin() {
    net.begin_step(nodes, inverse_mass, search, 0, static_cast<std::uint32_t>(particles.grid().size()));
  }
  /// Nodes go on by their velocities; then the net.
  void substep(const Substep& part = kNetSubstep) {
    each_node(particles.grid(), [&](int r, int c) {
      set(particles.position, r, c,
          particles.local_position_at(r, c) + part.seconds * particles.velocity_at(r, c));
    });
    net.apply(particles, part);
  }
  /// Of the features of the two layers: how far the nearest are apart along the line between them as the step
  /// began, m; below 0 they have passed each other.
  double lowest() {
    std::vector<Vec3> now = nodes.start;
    each_node(particles.grid(),
              [&](int r, int c) { now[particles.grid().index(r, c)] = particles.position_at(r, c); });
    FeatureSearch all;
    all.set_grids({particles.grid()});
    double least = 1e9;
    for (const FeaturePair& pair : all.find(nodes, 0.1)) {
      const auto upper = [&](std::size_t i) {
        return static_cast<int>(pair.node[i]) % particles.grid().stride >= 4;
      };
      // Of an edge pair the first two nodes are one feature, of the other kind the first alone.
      const bool edges = pair.kind == FeaturePair::Kind::edge_edge;
      if (upper(edges ? 1 : 0) != upper(0) || upper(2) != upper(3) || upper(edges ? 2 : 1) != upper(2) ||
          upper(0) == upper(2)) {
        continue;  // within a layer, or in the fold
      }
      const Vec3 was = nearness(pair.kind, points_of(pair, nodes.start)).apart;
      if (std::abs(was.y()) < 0.9 * was.norm()) continue;  // beside each other
      const Nearness then = nearness(pair.kind, points_of(pair, now));
      least = std::min(least, then.apart.dot(was) / was.norm());
    }
    return least;
  }

  Particles<double> particles;
  LayerNodes nodes;
  std::vector<double> inverse_mass;
  FeatureSearch search;
  SubstepNet net{particles.grid(), kNetGap};
};

// 3 mm over the lower layer, 4 mm down in the substep: through, but for the net.
TEST(SubstepNet, LayersThatWouldMeetAreHeldApart) {
  FoldedStrip strip(0.003, {0, -0.4, 0});
  const Vec3 momentum = linear_momentum(strip.particles);
  const double kinetic = kinetic_energy(strip.particles);
  strip.begin();
  strip.substep();
  EXPECT_GT(strip.lowest(), 0.5 * kNetGap);
  // Impulses are opposite, and inelastic.
  EXPECT_LT((linear_momentum(strip.particles) - momentum).norm(), 1e-14);
  EXPECT_LT(kinetic_energy(strip.particles), kinetic);
  EXPECT_GT(kinetic_energy(strip.particles), 0.1 * kinetic);
  // It goes on so for the rest of the step.
  for (int part = 1; part < 4; ++part) strip.substep(Substep::of(part, 4, 0.04));
  EXPECT_GT(strip.lowest(), 0);
}

TEST(SubstepNet, WhatComesNoNearerThanTheGapIsLeftAlone) {
  for (const auto& [height, speed] : {std::pair{0.003, -0.1}, {0.2, -0.4}, {0.003, 0.4}}) {
    FoldedStrip strip(height, {0, speed, 0});
    strip.begin();
    Particles<double> expected = strip.particles;
    each_node(expected.grid(), [&](int r, int c) {
      set(expected.position, r, c,
          expected.local_position_at(r, c) + kNetSubstep.seconds * expected.velocity_at(r, c));
    });
    strip.substep();
    EXPECT_TRUE(test::same_state(strip.particles, expected)) << height << ", " << speed;
  }
}

// What moves with all of the cloth meets nothing.
TEST(SubstepNet, ACommonMotionIsNone) {
  FoldedStrip strip(0.003, {0, 0, 0});
  each_node(strip.particles.grid(), [&](int r, int c) { set(strip.particles.velocity, r, c, {0, -30, 0}); });
  strip.begin();
  const double kinetic = kinetic_energy(strip.particles);
  strip.substep();
  EXPECT_NEAR(kinetic_energy(strip.particles), kinetic, 1e-12 * kinetic);
  EXPECT_NEAR(strip.lowest(), 0.003, 1e-12);
}

// The step's search saw the nodes stay: where they leave its ways by more than its margin it is made again.
TEST(SubstepNet, NodesThatLeaveTheirExpectedWaysAreSearchedForAgain) {
  FoldedStrip strip(0.05, {0, 0, 0});
  strip.begin();
  each_node(strip.particles.grid(), [&](int r, int c) {
    if (c >= 4) set(strip.particles.velocity, r, c, {0, -6, 0});
  });
  strip.substep();
  EXPECT_GT(strip.lowest(), 0.5 * kNetGap);
}

// What is nearer than the gap as it begins is led apart little by little, not thrown.
TEST(SubstepNet, WhatIsTooNearIsLedApartByATenthOfWhatItLacks) {
  FoldedStrip strip(0.4 * kNetGap, {0, 0, 0});
  strip.begin();
  const double kinetic = kinetic_energy(strip.particles);
  strip.substep();
  EXPECT_GT(strip.lowest(), 0.4 * kNetGap);
  EXPECT_LT(strip.lowest(), 0.6 * kNetGap);
  EXPECT_EQ(kinetic_energy(strip.particles), kinetic);
}

}  // namespace
}  // namespace weft
