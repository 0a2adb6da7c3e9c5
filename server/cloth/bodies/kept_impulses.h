#pragma once
#include <utility>
#include <vector>

#include "cloth/bodies/body_contact.h"
#include "cloth/shapes/solid.h"

namespace weft {

/// The impulses of a step's contacts, for the next step to begin with (warm starting: Catto, Iterative
/// Dynamics with Temporal Coherence, GDC 2005). A sweep passes a weight on by a contact or two: from nothing,
/// as many as a step has do not hold up a tower, and what they leave makes it creep.
class KeptImpulses {
 public:
  /// What a step's contacts were found to need, contact by contact.
  void keep(const std::vector<BodyContact>& contacts, const std::vector<BodyImpulse>& impulses,
            const std::vector<Solid>& solids, double dt);
  /// Tells contacts of a step of dt seconds what those in the same place had. Each is told once.
  void start(std::vector<BodyContact>& contacts, const std::vector<Solid>& solids, double dt) const;

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(kept_);
  }

 private:
  struct Kept {
    std::pair<ColliderId, ColliderId> pair;
    Vec3 place{0, 0, 0};    ///< from the first one's centre along its own axes, m
    double along = 0;       ///< mean force along the normal, N
    Vec3 rubbing{0, 0, 0};  ///< the same across it, N
    template <class Archive>
    void serialize(Archive& archive) {
      archive(pair.first, pair.second, place, along, rubbing);
    }
  };
  std::vector<Kept> kept_;  ///< by pair
};

}  // namespace weft
