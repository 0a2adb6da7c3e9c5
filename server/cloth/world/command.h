#pragma once
/// What is done to a simulation between two steps, as data: so that it can be written down and done again.
/// Each is one of Simulation's calls, carry_out() makes it; of equal states and equal commands follow equal
/// states, to the bit.
#include <cstdint>
#include <variant>
#include <vector>

#include "cloth/world/cloth_commands.h"
#include "cloth/world/collider_commands.h"
#include "cloth/world/simulation.h"

namespace weft::command {

struct SetWind {
  Wind wind;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.set_wind(wind);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(wind);
  }
};

struct SetWindZone {
  std::size_t zone = 0;
  Vec3 velocity{0, 0, 0};
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.set_wind_zone(zone, velocity);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(zone, velocity);
  }
};

struct SetIntegrator {
  IntegratorDescription integrator;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.set_integrator(integrator);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(integrator);
  }
};

struct SetEffects {
  std::vector<EffectDescription> effects;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.set_effects(effects);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(effects);
  }
};

struct MoveGrab {
  GrabId grab = 0;
  Vec3 hand{0, 0, 0};
  template <class Real>
  bool carry_out(Simulation<Real>& simulation) const {
    return simulation.move_grab(grab, hand);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(grab, hand);
  }
};

struct Release {
  GrabId grab = 0;
  template <class Real>
  bool carry_out(Simulation<Real>& simulation) const {
    return simulation.release(grab);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(grab);
  }
};

struct Reset {
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.reset();
  }
  template <class Archive>
  void serialize(Archive&) {}
};

struct Steps {
  std::uint32_t count = 1;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    for (std::uint32_t i = 0; i < count; ++i) simulation.step();
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(count);
  }
};

/// Records hold the place in this list: what is new stands last.
using Command = std::variant<Steps, RequestLevel, ApplyLevel, SetResting, SetMostWork, TryAgain, SetWind,
                             SetWindZone, SetIntegrator, SetEffects, SetMaterial, SetBallFriction,
                             SetObstacleFriction, AddBall, MoveBall, ThrowBall, RemoveBall, MoveObstacle,
                             ThrowObstacle, GrabCloth, GrabObstacle, MoveGrab, Release, Pin, Unpin, Reset>;

}  // namespace weft::command
