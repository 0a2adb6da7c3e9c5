// A pair of two sheets in the step of one of them: an impulse to explicit methods, a spring to implicit ones.
#include "cloth/contact/constraints/layer_contacts.h"

#include "cloth/solver/node_arrays.h"
#include "fixtures.h"

namespace weft::test {
namespace {

constexpr double kPairGap = 0.01, kPairStep = 0.01;

/// The first sheet is stepped: its node (0, 0) lies `height` over the middle of a triangle of the second one.
/// Two sheets of one cell, 1 kg a node.
class NodeOverTriangle {
  Grid grid_ = Grid::with_nodes(2, 2);

 public:
  NodeOverTriangle(double height, const Vec3& velocity) : sheet(grid_) {
    const auto size = static_cast<std::uint32_t>(grid_.size());
    nodes_.first = {0, size, 2 * size};
    const std::size_t count = 2 * grid_.size();
    nodes_.start.assign(count, Vec3(0, 0, 0));
    nodes_.velocity = nodes_.acceleration = nodes_.support = nodes_.start;
    nodes_.inverse_mass.assign(count, 0);
    nodes_.lies.assign(count, 0);
    nodes_.tangled.assign(count, 0);
    each_node(grid_, [&](int r, int c) {
      // The first sheet stands aside of the second but for its first node.
      const Vec3 beneath(c, 0, r), over = Vec3(0.25, height, 0.25) + 2 * Vec3(-c, 1 - (r + c == 0), -r);
      put(0, r, c, over, velocity);
      put(1, r, c, beneath, Vec3(0, 0, 0));
      set(sheet.position, r, c, over);
      set(sheet.velocity, r, c, velocity);
      sheet.mass.at(r, c) = sheet.inverse_mass.at(r, c) = 1;
    });
    nodes_.end = nodes_.start;
    search_.set_grids({grid_, grid_});
    search_.find(nodes_, 2 * kPairGap);
    contacts.emplace(nodes_, search_, grid_, 0, LayerParameters{kPairGap, kPairGap / 10, 0.5});
    LayerPair pair;
    pair.features.kind = FeaturePair::Kind::node_triangle;
    pair.features.node = {0, size + index(0, 0), size + index(1, 0), size + index(0, 1)};
    pair.features.distance = height;
    pair.near = nearness(pair.features.kind, points_of(pair.features, nodes_.start));
    pair.normal = {0, 1, 0};
    pair.gap = kPairGap;
    contacts->set_pairs({pair});
    // The node's own inverse mass and, by the squares of their weights 1/2, 1/4, 1/4, the triangle's, 1/kg.
    share = 1 + 0.25 + 2.0 / 16;
  }

  Particles<double> sheet;
  std::optional<LayerContacts<double>> contacts;
  double share;

 private:
  std::uint32_t index(int r, int c) const { return static_cast<std::uint32_t>(grid_.index(r, c)); }
  void put(std::size_t cloth, int r, int c, const Vec3& place, const Vec3& velocity) {
    const std::size_t n = nodes_.first[cloth] + grid_.index(r, c);
    nodes_.start[n] = place;
    nodes_.velocity[n] = velocity;
    nodes_.inverse_mass[n] = 1;
  }
  LayerNodes nodes_;
  FeatureSearch search_;
};

TEST(LayerContacts, AnExplicitSubstepStopsTheApproachPlastically) {
  NodeOverTriangle pair(kPairGap / 2, {0, -2, 0});
  pair.contacts->resolve(pair.sheet, Substep{0, 1, kPairStep});
  // An impulse of v / share: the other sheet's part of the approach is its own to stop.
  EXPECT_NEAR(get(pair.sheet.velocity, 0, 0).y(), -2 + 2 / pair.share, 1e-9);
  EXPECT_NEAR(pair.contacts->given()[0].y(), 2 / pair.share, 1e-9) << "N s, as another cloth gave it";
  EXPECT_EQ(get(pair.sheet.velocity, 0, 1), Vec3(0, -2, 0)) << "nothing is near that one";
}

TEST(LayerContacts, AnExplicitSubstepRubs) {
  NodeOverTriangle pair(kPairGap / 2, {3, -2, 0});
  pair.contacts->resolve(pair.sheet, Substep{0, 1, kPairStep});
  // Coulomb, 0.5: half of the impulse across it.
  EXPECT_NEAR(get(pair.sheet.velocity, 0, 0).x(), 3 - 0.5 * 2 / pair.share, 1e-9);
}

TEST(LayerContacts, WhatIsApartOrFliesApartIsLeftAlone) {
  NodeOverTriangle apart(2 * kPairGap, {0, -2, 0}), leaving(kPairGap / 2, {0, 1, 0});
  apart.contacts->resolve(apart.sheet, Substep{0, 1, kPairStep});
  leaving.contacts->resolve(leaving.sheet, Substep{0, 1, kPairStep});
  EXPECT_EQ(get(apart.sheet.velocity, 0, 0), Vec3(0, -2, 0));
  EXPECT_EQ(get(leaving.sheet.velocity, 0, 0), Vec3(0, 1, 0));
}

/// The pair's part of a system whose inertia is 1 kg / h^2, at no move.
struct Added {
  explicit Added(NodeOverTriangle& pair) : vectors(pair.sheet.grid(), 6), diagonal(pair.sheet.grid(), 1) {
    std::fill_n(diagonal[0], pair.sheet.grid().size(), 1 / (kPairStep * kPairStep));
    pair.contacts->add_to(vectors.vector(0), couplings, diagonal[0], vectors.vector(3));
  }
  Vec3 force() { return at(kernels::Components<const double>(vectors.vector(0)), 0); }
  NodeArrays<double> vectors, diagonal;
  NodeCouplings<double> couplings;
};

TEST(LayerContacts, AnImplicitSubstepPushesWhatWouldComeTooNear) {
  NodeOverTriangle pair(kPairGap, {0, -2, 0});
  pair.contacts->begin(pair.sheet, Substep{0, 1, kPairStep}, false);
  EXPECT_FALSE(pair.contacts->empty());
  Added added(pair);
  EXPECT_FALSE(added.couplings.empty());
  // At its place it has its gap: the spring acts by what it moves. Moved inwards it presses, outwards it
  // pulls and is let go.
  EXPECT_NEAR(added.force().y(), 0, 1e-6);
  std::vector<OneSidedSpring> springs;
  add(added.vectors.vector(3), 0, Vec3(0, -1e-3, 0));
  pair.contacts->append_springs(added.vectors.vector(3), added.vectors.vector(0), springs);
  ASSERT_EQ(springs.size(), 1U);
  EXPECT_EQ(pair.contacts->release_pulling(added.vectors.vector(3)), 0);
  add(added.vectors.vector(3), 0, Vec3(0, 3e-3, 0));
  EXPECT_GT(pair.contacts->release_pulling(added.vectors.vector(3)), 0);
  EXPECT_EQ(pair.contacts->release_pulling(added.vectors.vector(3)), 0) << "it is gone";
}

TEST(LayerContacts, ForcesOfAnImplicitSubstepAreCarriedOn) {
  NodeOverTriangle pair(kPairGap, {0, -2, 0});
  pair.contacts->begin(pair.sheet, Substep{0, 1, kPairStep}, false);
  Added added(pair);
  add(added.vectors.vector(3), 0, Vec3(0, -1e-3, 0));
  pair.contacts->finish(added.vectors.vector(3));
  ASSERT_EQ(pair.contacts->forces().size(), 1U);
  const PairForce& carried = pair.contacts->forces()[0];
  EXPECT_TRUE(carried.between_cloths);
  // Of a hit no more than the nodes' own weight.
  EXPECT_NEAR(carried.force, 9.81 / pair.share, 1e-6);
  EXPECT_GT(pair.contacts->given()[0].y(), kPairStep * carried.force) << "what it did in the step was more";
}

TEST(LayerContacts, FarFromEachOtherThereIsNothingToDo) {
  NodeOverTriangle pair(10 * kPairGap, {0, -2, 0});
  pair.contacts->begin(pair.sheet, Substep{0, 1, kPairStep}, false);
  Added added(pair);
  EXPECT_TRUE(added.couplings.empty());
  EXPECT_EQ(added.force(), Vec3(0, 0, 0));
}

}  // namespace
}  // namespace weft::test
