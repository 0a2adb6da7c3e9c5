#include "cloth/world/command.h"

#include <gtest/gtest.h>

#include "commanded.h"

namespace weft {
namespace {

using test::expect_does;

TEST(Command, TheWindIsSet) {
  Wind wind = test::commanded_scene().wind;
  wind.speed = 5;
  wind.gusts = {0.2, 1.5};
  wind.turbulence = {0.1, 0.4};
  expect_does(command::SetWind{wind}, [&](auto& s) { s.set_wind(wind); });
  expect_does(command::SetWindZone{0, {0, 3, 0}}, [](auto& s) { s.set_wind_zone(0, {0, 3, 0}); });
}

TEST(Command, IntegratorAndEffectsAreSet) {
  for (const IntegratorDescription& integrator : std::vector<IntegratorDescription>{
           SymplecticEulerDescription{0, 0.5}, XpbdDescription{20}, BackwardEulerDescription{}}) {
    expect_does(command::SetIntegrator{integrator}, [&](auto& s) { s.set_integrator(integrator); });
  }
  const std::vector<EffectDescription> effects{GravityEffect{}, PlateBendingEffect{}, StrainLimitEffect{}};
  expect_does(command::SetEffects{effects}, [&](auto& s) { s.set_effects(effects); });
}

TEST(Command, AHandIsMovedAndLetsGo) {
  const auto grab = [](auto& s) { s.grab(0, {0.5, 0.75}, Vec3(0.4, 0.3, 1), 30); };
  expect_does(
      command::MoveGrab{1, {0, 0.5, 1}},
      [](auto& s) {
        return s.move_grab(1, {0, 0.5, 1});
      },
      grab);
  expect_does(
      command::Release{1}, [](auto& s) { return s.release(1); }, grab);
}

TEST(Command, StepsAreMadeAndAllBeginsAnew) {
  expect_does(command::Steps{3}, [](auto& s) { test::run(s, 3); });
  expect_does(command::Reset{}, [](auto& s) { s.reset(); });
}

// Records hold these numbers: one that has its place keeps it.
TEST(Command, PlacesInRecordsStay) {
  const std::vector<command::Command> in_order{command::Steps{},
                                               command::RequestLevel{},
                                               command::ApplyLevel{},
                                               command::SetResting{},
                                               command::SetMostWork{},
                                               command::TryAgain{},
                                               command::SetWind{},
                                               command::SetWindZone{},
                                               command::SetIntegrator{},
                                               command::SetEffects{},
                                               command::SetMaterial{},
                                               command::SetBallFriction{},
                                               command::SetObstacleFriction{},
                                               command::AddBall{},
                                               command::MoveBall{},
                                               command::ThrowBall{},
                                               command::RemoveBall{},
                                               command::MoveObstacle{},
                                               command::ThrowObstacle{},
                                               command::GrabCloth{},
                                               command::GrabObstacle{},
                                               command::MoveGrab{},
                                               command::Release{},
                                               command::Pin{},
                                               command::Unpin{},
                                               command::Reset{}};
  for (std::size_t i = 0; i < in_order.size(); ++i) EXPECT_EQ(in_order[i].index(), i);
}

}  // namespace
}  // namespace weft
