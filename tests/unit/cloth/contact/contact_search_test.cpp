// What Contact finds and leaves as it is.
#include <gtest/gtest.h>

#include <vector>

#include "cloth/contact/recovery/contact.h"
#include "fixtures.h"
#include "loose_contact.h"

namespace weft {
namespace {

// A firm ball, one that the cloth pushes, and a body, each over another node of a flat sheet; the fourth is
// over none.
TEST(ContactSearch, InsideAreTheFreeNodesInAnySolid) {
  const Particles<double> sheet = test::flat_sheet<double>(5, 5, {4, 4});
  std::vector<Solid> solids(4);
  const std::vector<std::pair<int, int>> over{{1, 1}, {1, 3}, {3, 1}};
  for (std::size_t i = 0; i < solids.size(); ++i) {
    solids[i].id = static_cast<ColliderId>(i + 1);
    solids[i].shape = Sphere{0.2};
    const Vec3 place =
        i < over.size() ? sheet.local_position_at(over[i].first, over[i].second) : Vec3(0, 0, 1);
    solids[i].start = solids[i].position = place + Vec3(0, 0, 0.1);
  }
  solids[1].inverse_mass = 2;
  solids[2].shape = Box{{0.2, 0.2, 0.2}};
  solids[2].inverse_mass = 2;
  solids[2].inverse_inertia = Eigen::Matrix3d::Identity();
  test::LooseContact<double> contact(sheet.grid());
  std::vector<Touch> expected;
  for (std::size_t i = 0; i < over.size(); ++i)
    expected.push_back({sheet.grid().index(over[i].first, over[i].second), solids[i].id});
  EXPECT_EQ(contact.inside(sheet, solids, {0, 1, 0.01}), expected);

  Particles<double> held = sheet;
  for (const auto& [row, col] : over) held.inverse_mass.at(row, col) = 0;
  EXPECT_EQ(contact.inside(held, solids, {0, 1, 0.01}), std::vector<Touch>{});
}

// At 10 m/s a node comes 0.1 m down in the substep: into a plate whose nearer face is 0.05 m below, past one
// of 0.02 m that lies there, not to one 0.2 m below, wherever those stand in the list.
TEST(ContactSearch, ForeseenAreTheSolidsOnANodesWay) {
  Particles<double> sheet = test::flat_sheet<double>(5, 5, {4, 4});
  test::set(sheet.velocity, 2, 2, {0, 0, -10});
  const auto plate = [&](ColliderId id, double half, double below) {
    Solid made;
    made.id = id;
    made.shape = Box{{0.3, 0.3, half}};
    made.start = made.position = sheet.local_position_at(2, 2) - Vec3(0, 0, below + half);
    return made;
  };
  const std::vector<Solid> solids{plate(1, 0.1, 0.2), plate(2, 0.1, 0.05), plate(3, 0.01, 0.05)};
  test::LooseContact<double> contact(sheet.grid());
  const std::vector<Arrival> found =
      contact.foresee(sheet, sheet.velocity, solids, {0, 1, 0.01}, [](const Solid&) { return true; });
  ASSERT_EQ(found.size(), 2U);
  for (const Arrival& arrival : found) {
    EXPECT_EQ(arrival.touch.node, sheet.grid().index(2, 2));
    EXPECT_EQ(arrival.surface.normal, Vec3(0, 0, 1));
    EXPECT_NEAR(arrival.surface.distance, -0.05, 1e-12) << "how far beyond the face it would come";
    EXPECT_NEAR(arrival.approach, 10, 1e-9);
  }
  EXPECT_EQ(found[0].solid, 1U);
  EXPECT_EQ(found[1].solid, 2U);
}

}  // namespace
}  // namespace weft
