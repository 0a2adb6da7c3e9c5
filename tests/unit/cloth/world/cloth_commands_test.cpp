#include "cloth/world/cloth_commands.h"

#include <gtest/gtest.h>

#include "commanded.h"

namespace weft {
namespace {

using test::expect_does;

TEST(ClothCommands, ALevelIsAskedForAndApplied) {
  expect_does(command::RequestLevel{0, 3}, [](auto& s) { s.request_level(0, 3); });
  expect_does(
      command::ApplyLevel{0}, [](auto& s) { return s.cloths()[0].apply_pending_level(); },
      [](auto& s) { s.request_level(0, 3); });
}

TEST(ClothCommands, AClothIsToldToRest) {
  expect_does(command::SetResting{0, true}, [](auto& s) { s.set_resting(0, true); });
  expect_does(
      command::SetResting{0, false}, [](auto& s) { s.set_resting(0, false); },
      [](auto& s) { s.set_resting(0, true); });
}

// A cloth whose steps take more than that stands still, until it is tried again.
TEST(ClothCommands, AClothThatTakesTooMuchWorkStandsStillUntilItIsTriedAgain) {
  expect_does(command::SetMostWork{0, 1}, [](auto& s) { s.cloths()[0].set_most_work(1); });
  expect_does(
      command::TryAgain{0}, [](auto& s) { s.cloths()[0].try_again(); },
      [](auto& s) {
        s.cloths()[0].set_most_work(1);
        test::run(s, 2);
        s.cloths()[0].set_most_work(1e9);
      });
}

TEST(ClothCommands, MaterialsAreSet) {
  Material material;
  material.structural = {3000, 2000};
  material.shear = 100;
  material.bending = 1;
  material.density = 0.3;
  material.damping = 0.4;
  expect_does(command::SetMaterial{0, material}, [&](auto& s) { s.set_material(0, material); });
}

TEST(ClothCommands, PinsComeAndGo) {
  expect_does(command::Pin{0, {0.25, 0.75}}, [](auto& s) { s.pin(0, {0.25, 0.75}); });
  expect_does(
      command::Unpin{0, {0.25, 0.75}},
      [](auto& s) {
        return s.unpin(0, {0.25, 0.75});
      },
      [](auto& s) {
        s.pin(0, {0.25, 0.75});
      });
}

TEST(ClothCommands, AClothIsGrabbedByAHandOrWhereItIs) {
  const Vec3 hand(0.4, 0.3, 1);
  expect_does(command::GrabCloth{0, {0.5, 0.75}, hand, 30}, [&](auto& s) {
    return s.grab(0, {0.5, 0.75}, hand, 30);
  });
  expect_does(command::GrabCloth{0, {0.5, 0.75}, {}, 30}, [](auto& s) {
    return s.grab(0, {0.5, 0.75}, {}, 30);
  });
}

}  // namespace
}  // namespace weft
