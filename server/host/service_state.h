#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cloth/core/grab_id.h"
#include "cloth/shapes/solid.h"
#include "cloth/world/description.h"
#include "scene/scene.h"

namespace weft::host {

/// A ball, or an obstacle, that a viewer put somewhere or set in motion.
struct PutBody {
  ColliderId id = 0;
  std::uint64_t viewer = 0;  ///< who did: Seat::number
  std::uint64_t step = 0;    ///< when
  Pose before;               ///< where an obstacle was before anybody did
  template <class Archive>
  void serialize(Archive& archive) {
    archive(id, viewer, step, before);
  }
};

/// What a viewer holds who has gone and may come back.
struct HeldSeat {
  std::string token;  ///< Seat's
  std::vector<GrabId> grabs;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(token, grabs);
  }
};

/// What the next step is composed of anew. Effects wake all there is, a material only its cloth.
enum class Recompose { nothing, materials, effects };

/// What a scene being served has beside its simulation and its viewers, written down with its state.
struct ServiceState {
  std::uint32_t epoch = 1;
  bool paused = false;
  int waiting_steps = 0;
  std::vector<EffectDescription> effects;  ///< the scene's, with the parameters that they have now
  std::vector<std::string> effects_off;
  std::vector<Material> materials;  ///< of the cloths, from the next step on
  Recompose recompose = Recompose::nothing;
  scene::Quality wish;
  std::vector<PutBody> put;
  std::vector<double> usual_work;
  std::vector<HeldSeat> held;  ///< by all who hold anything
  template <class Archive>
  void serialize(Archive& archive) {
    archive(epoch, paused, waiting_steps, effects, effects_off, materials, recompose, wish.max_error,
            wish.max_ms, put, usual_work, held);
  }
};

}  // namespace weft::host
