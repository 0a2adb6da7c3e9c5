#pragma once
/// What is done to one cloth of a simulation, by its index (command.h).
#include <cstddef>
#include <optional>

#include "cloth/core/grab_id.h"
#include "cloth/core/vec3.h"
#include "cloth/sheet/material.h"

namespace weft {
template <class Real>
class Simulation;
}  // namespace weft

namespace weft::command {

struct RequestLevel {
  std::size_t cloth = 0;
  int level = 0;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.request_level(cloth, level);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth, level);
  }
};

struct ApplyLevel {
  std::size_t cloth = 0;
  template <class Real>
  bool carry_out(Simulation<Real>& simulation) const {
    return simulation.cloths()[cloth].apply_pending_level();
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth);
  }
};

struct SetResting {
  std::size_t cloth = 0;
  bool resting = false;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.set_resting(cloth, resting);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth, resting);
  }
};

struct SetMostWork {
  std::size_t cloth = 0;
  double most = 0;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.cloths()[cloth].set_most_work(most);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth, most);
  }
};

struct TryAgain {
  std::size_t cloth = 0;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.cloths()[cloth].try_again();
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth);
  }
};

struct SetMaterial {
  std::size_t cloth = 0;
  Material material;
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.set_material(cloth, material);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth, material);
  }
};

struct Pin {
  std::size_t cloth = 0;
  Vec2 at{0, 0};
  template <class Real>
  void carry_out(Simulation<Real>& simulation) const {
    simulation.pin(cloth, at);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth, at);
  }
};

struct Unpin {
  std::size_t cloth = 0;
  Vec2 at{0, 0};
  template <class Real>
  bool carry_out(Simulation<Real>& simulation) const {
    return simulation.unpin(cloth, at);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth, at);
  }
};

struct GrabCloth {
  std::size_t cloth = 0;
  Vec2 at{0, 0};
  std::optional<Vec3> hand;
  double max_force = 0;
  template <class Real>
  GrabId carry_out(Simulation<Real>& simulation) const {
    return simulation.grab(cloth, at, hand, max_force);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(cloth, at, hand, max_force);
  }
};

}  // namespace weft::command
