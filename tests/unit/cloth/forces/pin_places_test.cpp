#include "cloth/forces/pin_places.h"

#include <gtest/gtest.h>

namespace weft {
namespace {

/// 5 x 5 nodes, each at (u, v, 0) m and 1 m above the place.
Particles<double> unit_sheet() {
  Particles<double> particles(Grid::with_nodes(5, 5));
  particles.place = {0, 0, 1};
  for (int r = 0; r < 5; ++r) {
    for (int c = 0; c < 5; ++c) {
      particles.position.x.at(r, c) = c / 4.0;
      particles.position.y.at(r, c) = r / 4.0;
    }
  }
  particles.mass.fill(1);
  return particles;
}

Vec3 place(const PinPlaces& places, double u, double v) { return places.at(places.stencil(u, v)); }

TEST(PinPlaces, AreTheNodesOwnAtThemAndBilinearBetween) {
  Particles<double> particles = unit_sheet();
  particles.position.z.at(2, 2) = 0.4;
  const PinPlaces places({0.5, 0.75, 0.25, 0.5}, 0, particles);
  EXPECT_EQ(place(places, 0.5, 0.5), Vec3(0.5, 0.5, 1.4));
  EXPECT_EQ(place(places, 0.75, 0.25), Vec3(0.75, 0.25, 1));
  // Half way to two sides of the cell: a quarter of the middle's height.
  EXPECT_LT((place(places, 0.625, 0.375) - Vec3(0.625, 0.375, 1.1)).norm(), 1e-12);
}

// One node of this level is in the region; those of finer ones lie between it and its neighbours.
TEST(PinPlaces, OfOneNodeAreThoseAroundItToo) {
  const PinPlaces places({0.4, 0.6, 0.4, 0.6}, 0, unit_sheet());
  for (const double u : {0.4, 0.5, 0.55})
    EXPECT_LT((place(places, u, 0.45) - Vec3(u, 0.45, 1)).norm(), 1e-12) << u;
}

TEST(PinPlaces, GoWithTheirPath) {
  PinRegion region{0, 1, 0, 0};
  region.path = {{0, {0, 0, 0}}, {2, {0, 0, 4}}};
  PinPlaces places(region, 0, unit_sheet());
  ASSERT_TRUE(places.moving());
  EXPECT_TRUE(places.begin_step({}, 0, 1));
  places.carry(1);
  EXPECT_LT((place(places, 0.625, 0) - Vec3(0.625, 0, 3)).norm(), 1e-12);
}

}  // namespace
}  // namespace weft
