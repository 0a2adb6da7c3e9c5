#include "cloth/kernels/contact_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "flat_sheet.h"

namespace weft::kernels {
namespace {

const Grid kContactGrid = Grid::with_nodes(6, 7);

/// Nodes 0.1 m apart in the plane z = 0, from the origin to (0.6, -0.5).
class ContactKernels : public testing::Test {
 protected:
  NodeBlock<double> block() const {
    return {components(position_), kContactGrid.rows, kContactGrid.stride, kContactGrid.cols};
  }
  const VectorField<double> position_ = fixture::flat_sheet(kContactGrid, 0.1, 0.1);
};

// Rows lie at y = 0, -0.1, ..., -0.5. A ball of 0.12 m about (0.3, -0.2, 0) holds nodes of rows 1, 2 and 3.
TEST_F(ContactKernels, ABallHoldsTheRowsWithinItsRadius) {
  EXPECT_EQ(rows_inside(block(), Sphere{0.3, -0.2, 0, 0.12 * 0.12}), 0b001110U);
  // 0.11 m off the plane only its middle reaches it: sqrt(0.12^2 - 0.11^2) = 0.048 m.
  EXPECT_EQ(rows_inside(block(), Sphere{0.3, -0.2, 0.11, 0.12 * 0.12}), 0b000100U);
  EXPECT_EQ(rows_inside(block(), Sphere{0.3, -0.2, 0.13, 0.12 * 0.12}), 0U);
}

TEST_F(ContactKernels, AHalfSpaceHoldsTheRowsBelowIt) {
  EXPECT_EQ(rows_inside(block(), Below{0, 1, 0, -0.25}), 0b111000U);
  EXPECT_EQ(rows_inside(block(), Below{0, 1, 0, -1}), 0U);
}

// Turned by 45 degrees about z, 0.1 m half a side: along y it reaches 0.1 sqrt 2, and row 1's nodes beside
// its corner are out.
TEST_F(ContactKernels, ATurnedBoxHoldsWhatIsWithinItsAxes) {
  const double s = std::sqrt(0.5);
  const auto axis = [](double x, double y, double z) { return Below{x, y, z, 0.3 * x - 0.2 * y}; };
  const OrientedBox box{{axis(s, s, 0), axis(-s, s, 0), axis(0, 0, 1)}, {0.1, 0.1, 0.1}};
  EXPECT_EQ(rows_inside(block(), box), 0b001110U);
  const OrientedBox flat{{axis(1, 0, 0), axis(0, 1, 0), axis(0, 0, 1)}, {0.04, 0.04, 0.1}};
  EXPECT_EQ(rows_inside(block(), flat), 0b000100U);
}

// Along x at y = -0.3, with a radius of 0.05 m: row 3 alone, and nothing beyond its end.
TEST_F(ContactKernels, ACapsuleHoldsWhatIsNearItsStretch) {
  const Stretch along{{0.1, -0.3, 0}, {1, 0, 0}, 0.2, 0.05 * 0.05};
  EXPECT_EQ(rows_inside(block(), along), 0b001000U);
  const Stretch beyond{{0.66, -0.3, 0}, {1, 0, 0}, 0.2, 0.05 * 0.05};
  EXPECT_EQ(rows_inside(block(), beyond), 0U);
}

// A ball of 0.03 m between two rows, in the plane: the nodes have come 0.1 m down, through it.
TEST_F(ContactKernels, AWayThroughABallIsFoundThoughItEndsBeyond) {
  const VectorField<double> still(kContactGrid);
  VectorField<double> way(kContactGrid);
  way.y.fill(-0.1);
  const Sphere ball{0.3, -0.15, 0, 0.03 * 0.03};
  // Node (r, c) has come from position - way: only column 3 of row 2 passed y = -0.15.
  const BlockWay<double> down{components(static_cast<const VectorField<double>&>(way)), 1, -1};
  EXPECT_EQ(rows_inside(block(), ball), 0U);
  EXPECT_EQ(rows_swept(block(), down, {0, 0, 0}, ball), 0b000100U);
  const BlockWay<double> none{components(still), 1, -1};
  EXPECT_EQ(rows_swept(block(), none, {0, 0, 0}, ball), 0U);
}

// Cells of 0.1 m have diagonals of 0.02 m2; one node drawn aside widens the cells of the rows above and
// below.
TEST_F(ContactKernels, WideCellsAreFoundByTheirDiagonals) {
  VectorField<double> position = fixture::flat_sheet(kContactGrid, 0.1, 0.1);
  position.z.at(3, 2) = 0.2;
  const NodeBlock<double> drawn{components(static_cast<const VectorField<double>&>(position)),
                                kContactGrid.rows - 1, kContactGrid.stride, kContactGrid.cols - 1};
  EXPECT_EQ(rows_wider(drawn, 0.021), 0b001100U);
  EXPECT_EQ(rows_wider(drawn, 0.019), 0b011111U);
  EXPECT_EQ(rows_wider(drawn, 0.061), 0U);
}

// |own a + factor b|^2 with a = (1, 0, 0) c and b = (0, 2, 0): 9 c^2 + 16 at c = 20.
TEST(LargestSquare, IsOfTheFarthestNode) {
  constexpr std::size_t kMany = 21;
  std::vector<double> rising(kMany), two(kMany, 2), zero(kMany, 0);
  for (std::size_t i = 0; i < kMany; ++i) rising[(7 * i) % kMany] = static_cast<double>(i);
  const Components<const double> a{rising.data(), zero.data(), zero.data()};
  const Components<const double> b{zero.data(), two.data(), zero.data()};
  EXPECT_EQ(largest_square(a, b, 3.0, -2.0, kMany), 9 * 400 + 16);
}

}  // namespace
}  // namespace weft::kernels
