#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cloth/core/grab_id.h"
#include "cloth/core/vec3.h"
#include "cloth/levels/level_policy.h"
#include "cloth/levels/view_cone.h"
#include "host/link_keeper.h"
#include "host/viewer.h"

namespace weft::host {

/// A viewer's place in a scene: from where it looks, and the level each cloth has for it.
struct Seat {
  std::shared_ptr<Viewer> viewer;
  std::uint64_t visit = 0;
  std::uint64_t number = 0;       ///< of the scene's seats, from 1; never again
  bool placed = false;            ///< it has sent its camera
  double distance = 0;            ///< m, to every cloth, unless there is an eye
  std::optional<Vec3> eye;        ///< m
  std::optional<ViewCone> cone;   ///< what it has in sight; without one every direction
  std::vector<double> distances;  ///< m, to each cloth's centre
  std::vector<int>
      policy_levels;        ///< by Eq. 7 and hysteresis, before the cloths' own limits; empty: no history yet
  std::vector<int> levels;  ///< what its distance asks for
  LinkKeeper link;
  std::vector<int>
      steps_unseen;   ///< in a row, by cloth, in which it did not see it; 0 where that makes no difference
  std::string token;  ///< by which it is resumed
  std::vector<GrabId> grabs;        ///< what it holds
  std::uint64_t puts_again_at = 0;  ///< step from which on it may put balls and obstacles somewhere
  bool wants_curve = false;         ///< asked for the cost, and is told when it is known
  bool wants_frame = true;          ///< even if the scene did not change
};

}  // namespace weft::host
