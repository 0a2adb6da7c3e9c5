// A pair of two sheets in the step of one of them.
#include "cloth/contact/constraints/layer_contacts.h"

#include "cloth/solver/node_arrays.h"
#include "node_over_triangle.h"

namespace weft::test {
namespace {

/// The first sheet's step with the pair.
struct TouchingPair : NodeOverTriangle {
  TouchingPair(double height, const Vec3& velocity) : NodeOverTriangle(height, velocity) {
    contacts.set_pairs({pair});
  }
  void begin() {
    const std::array<const Particles<double>*, 1> starts{&sheet};
    contacts.begin(starts, Substep{0, 1, kPairStep}, false);
  }
  LayerContacts<double> contacts{nodes(), found(), first_part(), parameters()};
};

/// The pair's part of a system whose inertia is 1 kg / h^2, at no move.
struct Added {
  explicit Added(TouchingPair& pair) : vectors(pair.sheet.grid(), 6), diagonal(pair.sheet.grid(), 1) {
    std::fill_n(diagonal[0], pair.sheet.grid().size(), 1 / (kPairStep * kPairStep));
    const LayerSystem<double> system{vectors.vector(0), &couplings, diagonal[0], vectors.vector(3)};
    pair.contacts.add_to(std::span(&system, 1), between);
  }
  Vec3 force() { return at(kernels::Components<const double>(vectors.vector(0)), 0); }
  NodeArrays<double> vectors, diagonal;
  std::array<kernels::Components<const double>, 1> moved() { return {vectors.vector(3)}; }
  NodeCouplings<double> couplings;
  SystemCouplings<double> between;
};

TEST(LayerContacts, AnImplicitSubstepPushesWhatWouldComeTooNear) {
  TouchingPair pair(kPairGap, {0, -2, 0});
  pair.begin();
  EXPECT_FALSE(pair.contacts.empty());
  Added added(pair);
  EXPECT_FALSE(added.couplings.empty());
  // At its place it has its gap: the spring acts by what it moves. Moved inwards it presses, outwards it
  // pulls and is let go.
  EXPECT_NEAR(added.force().y(), 0, 1e-6);
  std::vector<OneSidedSpring> springs;
  add(added.vectors.vector(3), 0, Vec3(0, -1e-3, 0));
  const std::array<kernels::Components<const double>, 1> change{added.vectors.vector(0)};
  pair.contacts.append_springs(added.moved(), change, springs);
  ASSERT_EQ(springs.size(), 1U);
  EXPECT_EQ(pair.contacts.release_pulling(added.moved()), 0);
  add(added.vectors.vector(3), 0, Vec3(0, 3e-3, 0));
  EXPECT_GT(pair.contacts.release_pulling(added.moved()), 0);
  EXPECT_EQ(pair.contacts.release_pulling(added.moved()), 0) << "it is gone";
}

TEST(LayerContacts, ForcesOfAnImplicitSubstepAreCarriedOn) {
  TouchingPair pair(kPairGap, {0, -2, 0});
  pair.begin();
  Added added(pair);
  add(added.vectors.vector(3), 0, Vec3(0, -1e-3, 0));
  pair.contacts.finish(added.moved());
  ASSERT_EQ(pair.contacts.forces().size(), 1U);
  const PairForce& carried = pair.contacts.forces()[0];
  EXPECT_TRUE(carried.between_cloths);
  // Of a hit no more than the nodes' own weight.
  EXPECT_NEAR(carried.force, 9.81 / pair.share, 1e-6);
  EXPECT_GT(pair.contacts.given(0, 0).y(), kPairStep * carried.force) << "what it did in the step was more";
}

TEST(LayerContacts, AnExplicitSubstepIsTheImpulses) {
  TouchingPair pair(kPairGap / 2, {0, -2, 0});
  pair.contacts.strike(0, 3);
  pair.contacts.resolve(pair.sheet, Substep{0, 1, kPairStep});
  EXPECT_NEAR(pair.contacts.given(0, 0).y(), 2 / pair.share, 1e-9);
  int struck = 0;
  pair.contacts.for_each_node(0, [&](std::size_t) { ++struck; });
  EXPECT_EQ(struck, 0) << "what was moved before that step";
}

TEST(LayerContacts, FarFromEachOtherThereIsNothingToDo) {
  TouchingPair pair(10 * kPairGap, {0, -2, 0});
  pair.begin();
  Added added(pair);
  EXPECT_TRUE(added.couplings.empty());
  EXPECT_EQ(added.force(), Vec3(0, 0, 0));
}

}  // namespace
}  // namespace weft::test
