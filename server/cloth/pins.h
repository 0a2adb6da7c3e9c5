#pragma once
#include <vector>

#include "cloth/description.h"
#include "cloth/particles.h"
#include "cloth/path.h"

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
  /// When the last path ends, s.
  double end_of_motion() const { return end_of_motion_; }
  /// Puts the nodes that a path carries where they are at `time`, s.
  void carry(Particles<Real>& particles, double time) const;
  /// Calls visit(node, way) for the nodes that a path carries, with their way from `begin` to `end`, s, in m.
  template <class Visit>
  void for_each_way(double begin, double end, Visit visit) const {
    for (const Path& path : carried_) {
      const Vec3 way = along_path(path.points, end) - along_path(path.points, begin);
      for (const Carried& carried : path.nodes) visit(carried.node, way);
    }
  }

 private:
  struct Carried {
    std::size_t node;
    Vec3 origin;  ///< its place at offset 0, m
  };
  struct Path {
    std::vector<Waypoint> points;
    std::vector<Carried> nodes;
  };
  std::vector<Path> carried_;
  double end_of_motion_ = 0;
};

extern template class Pins<float>;
extern template class Pins<double>;

}  // namespace weft
