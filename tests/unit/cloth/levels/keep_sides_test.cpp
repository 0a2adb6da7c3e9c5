// Chords of a coarser level pass thin solids on the side on which the finer level's nodes lay.
#include "cloth/levels/keep_sides.h"

#include "cloth/levels/chord.h"
#include "cloth/levels/refine.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;
using test::set;

constexpr double kThinRail = 0.02;

/// A rail along z at the origin.
Solid thin_rail() {
  Solid lying{.id = 1, .shape = Capsule{10, kThinRail}};
  lying.rotation = Eigen::AngleAxisd(std::acos(0.0), Vec3(1, 0, 0)).toRotationMatrix();
  return lying;
}

/// 5 x 9 nodes over the rail, 2 cm apart along x: the middle one on top, from which both sides hang down by
/// the rail and then swing in below it, each past the middle.
Particles<double> hung_over() {
  Particles<double> fine(Grid::with_nodes(5, 9));
  const double x[] = {-0.004, -0.012, -0.021, -0.021, 0, 0.021, 0.021, 0.012, 0.004};
  const double y[] = {-0.06, -0.04, -0.02, 0.001, 0.021, 0.001, -0.02, -0.04, -0.06};
  each_node(fine.grid(), [&](int r, int c) {
    const double swung = c < 4 ? 0.008 : c > 4 ? -0.008 : 0;
    set(fine.position, r, c, Vec3(x[c] + (c == 0 || c == 8 ? swung : 0), y[c], 0.02 * r));
    fine.inverse_mass.at(r, c) = 1;
  });
  return fine;
}

Particles<double> merged_twice(const Particles<double>& fine) {
  Particles<double> once(Grid::with_nodes(3, 5)), twice(Grid::with_nodes(2, 3));
  merge(fine, once);
  merge(once, twice);
  each_node(twice.grid(), [&](int r, int c) { twice.inverse_mass.at(r, c) = 1; });
  return twice;
}

Vec3 chord(const Particles<double>& coarse, int row, int col) {
  Vec3 sum(0, 0, 0);
  const Chord between = chord_of(row, col, 4, coarse.grid());
  for (std::size_t i = 0; i < 4; ++i) {
    if (between.weight[i] == 0) continue;
    const int node = static_cast<int>(between.node[i]);
    sum += between.weight[i] *
           coarse.local_position_at(node / coarse.grid().stride, node % coarse.grid().stride);
  }
  return sum;
}

TEST(Chord, IsWhereASplitPutsTheNode) {
  const Particles<double> fine = hung_over();
  const Particles<double> coarse = merged_twice(fine);
  Particles<double> once(Grid::with_nodes(3, 5)), twice(Grid::with_nodes(5, 9));
  split(coarse, once);
  split(once, twice);
  each_node(twice.grid(), [&](int r, int c) {
    EXPECT_LT((chord(coarse, r, c) - twice.local_position_at(r, c)).norm(), 1e-15) << r << ", " << c;
  });
}

TEST(Chord, OfANodeThatAFinerGridHasTooIsThatNode) {
  const Grid coarse = Grid::with_nodes(3, 5), fine = Grid::with_nodes(9, 17);
  const Chord same = chord_of(coarse.index(1, 3), coarse, fine);
  EXPECT_EQ(same.node[0], fine.index(4, 12));
  EXPECT_EQ(same.weight, (std::array<double, 4>{1, 0, 0, 0}));
  EXPECT_EQ(chord_of(fine.index(4, 12), fine, coarse).node[0], coarse.index(1, 3));
}

// Before, the chords from the node on top run through the rail's axis, each towards the other side.
TEST(KeepSides, ChordsThatWouldPassARailOnItsOtherSideAreMovedOut) {
  const Particles<double> fine = hung_over();
  Particles<double> coarse = merged_twice(fine);
  EXPECT_GT(chord(coarse, 0, 3).x(), 0);
  EXPECT_TRUE(keep_sides(fine, {thin_rail()}, coarse));
  for (const int row : {0, 2, 4}) {
    for (const int col : {2, 3})
      EXPECT_LT(chord(coarse, row, col).x(), -0.9 * kThinRail) << row << ", " << col;
    for (const int col : {5, 6})
      EXPECT_GT(chord(coarse, row, col).x(), 0.9 * kThinRail) << row << ", " << col;
    EXPECT_GT(chord(coarse, row, 4).y(), 0.9 * kThinRail);
  }
}

TEST(KeepSides, PinnedNodesStay) {
  const Particles<double> fine = hung_over();
  Particles<double> coarse = merged_twice(fine);
  coarse.inverse_mass.at(0, 1) = coarse.inverse_mass.at(1, 1) = 0;
  const Vec3 top = coarse.local_position_at(0, 1);
  EXPECT_TRUE(keep_sides(fine, {thin_rail()}, coarse));
  EXPECT_EQ(coarse.local_position_at(0, 1), top);
}

// On what is large for its cells a sheet's chords are less deep than contact can tell sides.
TEST(KeepSides, ASheetOnALargeBallIsLeftToContact) {
  Particles<double> fine(Grid::with_nodes(9, 9));
  each_node(fine.grid(), [&](int r, int c) {
    const Vec3 out(0.05 * (c - 4), 1, 0.05 * (r - 4));
    set(fine.position, r, c, out.normalized());
    fine.inverse_mass.at(r, c) = 1;
  });
  Particles<double> coarse(Grid::with_nodes(5, 5));
  merge(fine, coarse);
  each_node(coarse.grid(), [&](int r, int c) { coarse.inverse_mass.at(r, c) = 1; });
  const Particles<double> before = coarse;
  EXPECT_FALSE(keep_sides(fine, {Solid{.id = 1, .shape = Sphere{1}}}, coarse));
  each_node(coarse.grid(),
            [&](int r, int c) { EXPECT_EQ(coarse.local_position_at(r, c), before.local_position_at(r, c)); });
}

}  // namespace
}  // namespace weft
