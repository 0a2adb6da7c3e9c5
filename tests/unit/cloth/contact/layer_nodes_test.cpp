// The side of a sheet on which something lies.
#include "cloth/contact/constraints/layer_nodes.h"

#include "fixtures.h"

namespace weft::test {
namespace {

/// A flat sheet of 3 x 3 nodes in the x-y plane, u along x and v along -y; its face looks along z.
class SheetsSides : public ::testing::Test {
 protected:
  SheetsSides() {
    each_node(sheet.grid(),
              [&](int r, int c) { places[sheet.grid().index(r, c)] = get(sheet.position, r, c); });
  }
  int side(int r, int c, const Vec3& direction) const {
    return side_of_sheet(sheet.grid(), places.data(), sheet.grid().index(r, c), direction, nullptr);
  }
  Particles<double> sheet = flat_sheet<double>(3, 3, {1, 1});
  std::vector<Vec3> places = std::vector<Vec3>(sheet.grid().size(), Vec3(0, 0, 0));
};

TEST_F(SheetsSides, AreTheSameAtAllItsNodes) {
  const int front = side(1, 1, {0, 0, 1});
  each_node(sheet.grid(), [&](int r, int c) {
    EXPECT_EQ(side(r, c, {0.3, 0.2, 1}), front) << r << ' ' << c;
    EXPECT_EQ(side(r, c, {0.3, 0.2, -1}), 1 - front) << r << ' ' << c;
  });
}

TEST_F(SheetsSides, TurnWithTheSheet) {
  const int front = side(1, 1, {0, 0, 1});
  for (Vec3& place : places) place = Vec3(-place.x(), place.y(), -place.z());
  EXPECT_EQ(side(1, 1, {0, 0, -1}), front);
}

TEST(PointsOf, AreThoseOfThePairsNodes) {
  FeaturePair pair;
  pair.node = {3, 0, 2, 1};
  const FourPoints points = points_of(pair, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)});
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(points[i].x(), pair.node[i]);
}

}  // namespace
}  // namespace weft::test
