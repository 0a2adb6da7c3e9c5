#include "cloth/kernels/link_rows.h"

#include <gtest/gtest.h>

#include "random_lattice.h"

namespace weft::kernels {
namespace {

using fixture::kLatticeFamilies;

TEST(LinkRows, ColumnsAreGroupedWhole) {
  EXPECT_EQ(grouped(1), kLinkGroup);
  EXPECT_EQ(grouped(kLinkGroup), kLinkGroup);
  EXPECT_EQ(grouped(kLinkGroup + 1), 2 * kLinkGroup);
}

TEST(LinkRows, TheUnitStepIsOneAboveZeroAlone) {
  for (const double x : {1e-200, 0.3, 1e300}) EXPECT_EQ(unit_step(x, x), 1);
  for (const double x : {0.0, -0.3, -1e300}) EXPECT_EQ(unit_step(x, 0.0), 0);
}

/// Random springs' links on 6 x 21 nodes, and a random vector to apply them to.
struct RandomLinks {
  RandomLinks() {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> uniform(-1, 1);
    links.has_bending = true;
    int first = 0;
    for (SpringLinks<double>* family : {&links.along_u, &links.along_v, &links.falling, &links.rising,
                                        &links.bending_u, &links.bending_v}) {
      *family = {numbers[first], numbers[first + 1], numbers[first + 2], numbers[first + 3]};
      const auto [down, right] = kLatticeFamilies[of.size()];
      for (int r = 0; r + down < grid.rows; ++r) {
        for (int c = std::max(0, -right); c < grid.cols - std::max(0, right); ++c) {
          for (int number = 0; number < 4; ++number) {
            numbers[first + number][grid.index(r, c)] = number == 0 ? 1 + uniform(random) : uniform(random);
          }
        }
      }
      of.push_back(*family);
      first += 4;
    }
    for (int r = 0; r < grid.rows; ++r) {
      for (int c = 0; c < grid.cols; ++c) {
        for (double* component : {x.x, x.y, x.z}) component[grid.index(r, c)] = uniform(random);
      }
    }
  }
  /// Link by link: a d + m (m . d) to its first end, the opposite to its second.
  std::vector<Vec3> listed(bool bending) const {
    std::vector<Vec3> forces(grid.size(), Vec3(0, 0, 0));
    for (std::size_t f = 0; f < (bending ? 6U : 4U); ++f) {
      const auto [down, right] = kLatticeFamilies[f];
      for (int r = 0; r + down < grid.rows; ++r) {
        for (int c = std::max(0, -right); c < grid.cols - std::max(0, right); ++c) {
          const std::size_t i = grid.index(r, c), j = grid.index(r + down, c + right);
          const Vec3 d = at<double>(x, i) - at<double>(x, j), m(of[f].x[i], of[f].y[i], of[f].z[i]);
          const Vec3 force = of[f].a[i] * d + m * m.dot(d);
          forces[i] += force;
          forces[j] -= force;
        }
      }
    }
    return forces;
  }
  template <bool kBending>
  void sum(RowRange rows) {
    for_each_link_force<double, kBending>(links, grid, x, rows, work.data(),
                                          [&](std::ptrdiff_t i, const Triple<double>& force) {
                                            out.x[i] = force.x, out.y[i] = force.y, out.z[i] = force.z;
                                          });
  }

  Grid grid = Grid::with_nodes(6, 21);
  NodeArrays<double> numbers{grid, 24}, vectors{grid, 6};
  Components<double> x = vectors.vector(0), out = vectors.vector(3);
  LinkFamilies<SpringLinks<double>> links;
  std::vector<SpringLinks<double>> of;
  std::vector<double, AlignedAllocator<double>> work = std::vector<double, AlignedAllocator<double>>(
      3 * WorkRows<double>::kVectors * WorkRows<double>::row_size(grid));
};

TEST(LinkRows, EachLinkPullsAtBothEnds) {
  RandomLinks links;
  links.sum<true>({0, links.grid.rows});
  EXPECT_LT(fixture::largest_error(links.grid, links.out, links.listed(true)), 1e-13);
  links.sum<false>({0, links.grid.rows});
  EXPECT_LT(fixture::largest_error(links.grid, links.out, links.listed(false)), 1e-13);
}

TEST(LinkRows, RangesOfRowsGiveTheSameBits) {
  RandomLinks whole, cut;
  whole.sum<true>({0, whole.grid.rows});
  for (const RowRange& rows : {RowRange{3, 4}, RowRange{0, 1}, RowRange{4, 6}, RowRange{1, 3}}) {
    cut.sum<true>(rows);
  }
  for (int r = 0; r < whole.grid.rows; ++r) {
    for (int c = 0; c < whole.grid.cols; ++c) {
      const std::size_t i = whole.grid.index(r, c);
      ASSERT_EQ(at<double>(cut.out, i), at<double>(whole.out, i)) << r << ", " << c;
    }
  }
}

// Row after row it is the sum of the products, of the rows asked for.
TEST(LinkRows, DotProductsAreOfTheRowsAskedFor) {
  const RandomLinks links;
  double expected = 0;
  for (int r = 1; r < 4; ++r) {
    for (int c = 0; c < links.grid.cols; ++c) {
      const std::size_t i = links.grid.index(r, c);
      expected += at<double>(links.x, i).squaredNorm();
    }
  }
  EXPECT_NEAR(dot_rows<double>(links.grid, links.x, links.x, {1, 4}), expected, 1e-14 * expected);
}

// A row's sum in single precision goes into a double: 1 beside 2^24 would be lost in a float.
TEST(LinkRows, RowsAreAddedUpInDouble) {
  NodeArrays<float> numbers(Grid::with_nodes(2, 2), 6);
  const Components<float> a = numbers.vector(0), b = numbers.vector(3);
  const Grid grid = Grid::with_nodes(2, 2);
  a.x[grid.index(0, 0)] = 16777216;
  a.x[grid.index(1, 0)] = 1;
  b.x[grid.index(0, 0)] = b.x[grid.index(1, 0)] = 1;
  DotProduct<float> dot;
  for (int r = 0; r < 2; ++r) {
    dot.add_row(a, b, static_cast<std::ptrdiff_t>(grid.index(r, 0)), grouped(grid.cols));
  }
  EXPECT_EQ(dot.sum(), 16777217);
}

// A symmetric matrix's six numbers stand for nine.
TEST(LinkRows, ABlockActsAsTheWholeMatrix) {
  double numbers[] = {1, 2, 3, 4, 5, 6};
  const Blocks<double> block{numbers, numbers + 1, numbers + 2, numbers + 3, numbers + 4, numbers + 5};
  Eigen::Matrix3d whole;
  whole << 1, 2, 3, 2, 4, 5, 3, 5, 6;
  const Vec3 d(0.5, -2, 0.25), expected = whole * d;
  const Triple<double> force = force_of(block, 0, d.x(), d.y(), d.z());
  EXPECT_EQ(Vec3(force.x, force.y, force.z), expected);
}

}  // namespace
}  // namespace weft::kernels
