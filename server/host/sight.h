#pragma once
#include <vector>

#include "cloth/world/simulation.h"
#include "host/seat.h"

namespace weft::host {

/// What viewers see of a scene's cloths: the level that each has for each viewer by Eq. 7, and what nobody
/// sees.
class Sight {
 public:
  /// Simulated, s, that a viewer must not have seen a cloth before less is done for it: who looks around
  /// loses nothing. Counted in steps, so that it is the same when commands are made again.
  static constexpr double kUnseenTime = 1.0;

  /// Of a scene of this description, which is kept by reference, in frames of at most so many bytes.
  Sight(const SimulationDescription& scene, std::size_t frame_bytes);

  /// The cloths have moved.
  void find_bounds(const std::vector<Cloth<float>>& cloths);
  /// Around each cloth; without a radius where nobody asks for it.
  const std::vector<BoundingSphere>& bounds() const { return bounds_; }

  /// Which cloths the viewer sees, and Eq. 7 for each, from where it is; `steps`: 1 in one, else 0.
  void look(Seat& seat, int steps = 0) const;
  /// The same without what it saw before.
  void look_anew(Seat& seat) const;
  /// No viewer that counts has seen the cloth for kUnseenTime. One that has just come and has not sent its
  /// camera yet does not count for what is simulated, so that a join changes nothing of what others see;
  /// where nobody has, all do.
  bool unseen(const std::vector<Seat>& seats, std::size_t cloth) const;
  /// The finest level of each cloth that one of those who count looks at.
  std::vector<int> wanted_levels(const std::vector<Seat>& seats) const;

 private:
  /// True for all cloths for which the scene makes no difference.
  bool sees(const Seat& seat, std::size_t cloth) const;
  /// The viewer has not seen the cloth for kUnseenTime.
  bool lost(const Seat& seat, std::size_t cloth) const { return seat.steps_unseen[cloth] > unseen_steps_; }

  const SimulationDescription& scene_;
  std::vector<int> finest_sendable_;  ///< by cloth
  std::vector<BoundingSphere> bounds_;
  int unseen_steps_;  ///< kUnseenTime
};

}  // namespace weft::host
