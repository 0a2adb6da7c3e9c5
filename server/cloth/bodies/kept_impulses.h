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
  /// What a step's contacts were found to need, contact by contact. Two solids of which neither yields, as
  /// they sleep, are not looked at: what they had stays.
  void keep(const std::vector<BodyContact>& contacts, const std::vector<BodyImpulse>& impulses,
            const std::vector<Solid>& solids, double dt);
  /// Tells contacts of a step of dt seconds, in their order, what those had that were in the same place on
  /// the first of the two. Each is told once.
  void start(std::vector<BodyContact>& contacts, const std::vector<Solid>& solids, double dt) const;

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(kept_);
  }

 private:
  /// Forgets all but what two have that are there and do not yield.
  void keep_sleeping(const std::vector<Solid>& solids);

  struct Kept {
    std::pair<ColliderId, ColliderId> pair;
    Vec3 place{0, 0, 0};    ///< BodyContact::arm_a along the first one's axes at the step's end, m
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
