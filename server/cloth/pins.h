#pragma once
#include <vector>

#include "cloth/description.h"
#include "cloth/particles.h"

namespace weft {

/// A cloth's pins at one level: which nodes are held, and where those go whose regions have a path.
template <class Real>
class Pins {
 public:
  Pins() = default;
  /// Holds the nodes of all regions: their inverse mass becomes 0 (the others' 1/mass), their velocity 0. The
  /// particles are where they are at `time`, s.
  Pins(const std::vector<PinRegion>& regions, double time, Particles<Real>& particles);

  /// Whether any pin has a path.
  bool moving() const { return !carried_.empty(); }
  /// When the last path ends, s; infinite if one loops.
  double end_of_motion() const { return end_of_motion_; }
  /// Puts the nodes that a path carries where they are at `time`, s.
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
  std::vector<Path> carried_;
  double end_of_motion_ = 0;
};

extern template class Pins<float>;
extern template class Pins<double>;

}  // namespace weft
