// The step guard where several cloths are stepped together.
#include <gtest/gtest.h>

#include "busy_scene.h"
#include "cloth/guard/step_guard.h"
#include "faults.h"

namespace weft {
namespace {

using test::hung_scene;
using test::kNaN;
using test::run;

// Cloths that lie on each other are one system, which a bad number in one of them leaves without a solution:
// both take the step back, and both go on.
TEST(GroupGuard, OfClothsThatTouchAllTakeTheStepBack) {
  SimulationDescription scene = hung_scene();
  scene.cloths[0].initial_level = 4;
  scene.cloths.push_back(scene.cloths[0]);
  scene.cloths[1].position += Vec3(0.03, 0.02, 0.004);
  scene.effects.emplace_back(ClothContactEffect{});
  Simulation<float> simulation(scene);
  run(simulation, 5);
  ASSERT_EQ(simulation.layers()->groups().size(), 1U);
  simulation.cloths()[0].particles().velocity.x.at(7, 9) = kNaN<float>;
  simulation.step();
  EXPECT_TRUE(simulation.healthy());
  ASSERT_EQ(simulation.guard_events().size(), 2U);
  for (std::size_t cloth : {0U, 1U}) {
    EXPECT_EQ(simulation.guard_events()[cloth].cloth, cloth);
    EXPECT_EQ(simulation.guard_events()[cloth].action, GuardEvent::Action::redone);
    EXPECT_EQ(simulation.guard_events()[cloth].rung, Rung::substeps_4);
  }
  run(simulation, 60);
  EXPECT_EQ(simulation.cloths()[0].guard_counters().all_redone(), 1U);
  for (std::size_t cloth : {0U, 1U}) EXPECT_LT(simulation.report(cloth).strain.max, 0.1);
}

}  // namespace
}  // namespace weft
