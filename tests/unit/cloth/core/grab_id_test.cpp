#include "cloth/core/grab_id.h"

#include <gtest/gtest.h>

#include <set>

#include "commanded.h"

namespace weft {
namespace {

// Hands on cloths and on bodies are counted together: none has the other's number, and a number says which
// one is moved and let go.
TEST(GrabIds, AreOneSequenceForClothsAndBodies) {
  Simulation<float> simulation(test::commanded_scene());
  const GrabId cloth = simulation.grab(0, {0.5, 0.5}, {}, 10);
  const std::optional<GrabId> body = simulation.grab_obstacle(1, {0.3, 0.5, -0.6}, {}, 10);
  const GrabId again = simulation.grab(0, {0.2, 0.5}, {}, 10);
  ASSERT_TRUE(body);
  EXPECT_EQ((std::set<GrabId>{cloth, *body, again}).size(), 3U);
  EXPECT_EQ(*body, cloth + 1);
  EXPECT_EQ(again, cloth + 2);
  EXPECT_TRUE(simulation.release(*body));
  EXPECT_FALSE(simulation.move_grab(*body, {0, 0, 0}));
  EXPECT_TRUE(simulation.move_grab(cloth, {0, 0, 0}));
  EXPECT_TRUE(simulation.move_grab(again, {0, 0, 0}));
}

}  // namespace
}  // namespace weft
