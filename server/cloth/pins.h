#pragma once
#include <vector>

#include "cloth/contact/solid.h"
#include "cloth/description.h"
#include "cloth/particles.h"

namespace weft {

/// A cloth's pins at one level: which nodes are held, and where those go whose regions have a path or are
/// fixed to an obstacle.
template <class Real>
class Pins {
 public:
  Pins() = default;
  /// Holds the nodes of all regions: their inverse mass becomes 0 (the others' 1/mass), their velocity 0. The
  /// particles are where they are at `time`, s.
  Pins(const std::vector<PinRegion>& regions, double time, Particles<Real>& particles);

  /// Whether any pin has a path or an obstacle.
  bool moving() const { return !carried_.empty() || !fixed_.empty(); }
  /// A step of `dt` from `time` on, s, in which the solids go as they do. True if some pin moves in it.
  bool begin_step(const Particles<Real>& particles, const std::vector<Solid>& solids, double time, double dt);
  /// Puts the nodes that move where they are at `time`, s, within the step that has begun.
  void carry(Particles<Real>& particles, double time) const;

 private:
  struct Carried {
    std::size_t node;
    Vec3 origin;  ///< its place at offset 0, m
  };
  struct Path {
    std::vector<Waypoint> points;
    bool loops;
    std::vector<Carried> nodes;
  };
  /// Nodes on an obstacle. Their places as seen from it are taken in the first step and kept from then on.
  struct Fixed {
    Solid obstacle;              ///< as it goes in the step
    std::vector<Carried> nodes;  ///< origin: in the obstacle's own frame
    bool placed = false;
  };
  std::vector<Path> carried_;
  std::vector<Fixed> fixed_;
  double end_of_motion_ = 0;     ///< when the last path ends, s; infinite if one loops
  double begin_ = 0, step_ = 1;  ///< of the step, s
};

extern template class Pins<float>;
extern template class Pins<double>;

}  // namespace weft
