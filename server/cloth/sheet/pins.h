#pragma once
#include <vector>

#include "cloth/core/particles.h"
#include "cloth/core/path.h"
#include "cloth/shapes/solid.h"
#include "cloth/sheet/cloth_description.h"
#include "cloth/sheet/seam.h"

namespace weft {

/// The nodes a region holds: all in it, or the nearest one. Indices into the grid's arrays, ascending.
std::vector<std::size_t> nodes_of(const PinRegion& region, const Grid& grid);

/// What a region goes with that has an obstacle or a ball.
inline ColliderId collider_of(const PinRegion& region) {
  return region.ball ? 1 + static_cast<ColliderId>(*region.ball)
                     : kFirstObstacle + static_cast<ColliderId>(region.obstacle.value_or(0));
}

/// The regions that hold at `time`, s: those that have a stiffness, or the others.
std::vector<PinRegion> acting(const std::vector<PinRegion>& regions, double time, bool soft);

/// When the next of them begins or ends to hold after `time`, s; infinite if none does.
double next_change(const std::vector<PinRegion>& regions, double time);

/// A cloth's pins at one level: which nodes are held, and where those go whose regions have a path or a
/// motion or are fixed to an obstacle.
template <class Real>
class Pins {
 public:
  Pins() = default;
  /// Holds the nodes of all regions: their inverse mass becomes 0 (the others' 1/mass), their velocity 0. The
  /// particles are where they are at `time`, s. With a seam, whose nodes are held both or neither.
  Pins(const std::vector<PinRegion>& regions, double time, Particles<Real>& particles,
       const Seam<Real>* seam = nullptr);

  /// Whether any pin has a path, a motion or an obstacle.
  bool moving() const { return !carried_.empty() || !led_.empty() || !fixed_.empty(); }
  /// A step of `dt` from `time` on, s, in which the solids go as they do. True if some pin moves in it; one
  /// whose obstacle is not there stands still.
  bool begin_step(const Particles<Real>& particles, const std::vector<Solid>& solids, double time, double dt);
  /// Puts the nodes that move where they are at `time`, s, within the step that has begun.
  void carry(Particles<Real>& particles, double time) const;
  /// The longest way that a path, or a node of a motion, goes from `begin` to `end`, s, in m; as straight in
  /// each eighth of the time.
  double longest_way(double begin, double end) const;
  /// Calls visit(node, way) for the nodes that move, with their way from `begin` to `end`, s, in m.
  template <class Visit>
  void for_each_way(double begin, double end, Visit visit) const {
    for (const Path& path : carried_) {
      const Vec3 way = along_path(path.points, end, path.loops) - along_path(path.points, begin, path.loops);
      for (const Carried& carried : path.nodes) visit(carried.node, way);
    }
    for (const Led& led : led_) {
      const Pose from = along_path(led.motion, begin, led.loops), to = along_path(led.motion, end, led.loops);
      for (const Carried& carried : led.nodes)
        visit(carried.node, Vec3(place(to, carried.origin) - place(from, carried.origin)));
    }
    for (const Fixed& fixed : fixed_) {
      if (!fixed.placed || !fixed.obstacle.moves()) continue;
      const PlacedShape from = at(fixed, begin), to = at(fixed, end);
      for (const Carried& carried : fixed.nodes) {
        visit(carried.node, Vec3(to.centre - from.centre + (to.rotation - from.rotation) * carried.origin));
      }
    }
  }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(carried_, led_, fixed_, end_of_motion_, begin_, step_);
  }

 private:
  struct Carried {
    std::size_t node;
    Vec3 origin;  ///< where it is in the world at offset 0, m
    template <class Archive>
    void serialize(Archive& archive) {
      archive(node, origin);
    }
  };
  struct Path {
    std::vector<Waypoint> points;
    bool loops;
    std::vector<Carried> nodes;
    template <class Archive>
    void serialize(Archive& archive) {
      archive(points, loops, nodes);
    }
  };
  /// Nodes that go with poses.
  struct Led {
    std::vector<PoseWaypoint> motion;
    bool loops;
    std::vector<Carried> nodes;  ///< origin: as seen from the pose
    template <class Archive>
    void serialize(Archive& archive) {
      archive(motion, loops, nodes);
    }
  };
  static Vec3 place(const Pose& pose, const Vec3& origin) {
    return pose.position + pose.orientation * origin;
  }
  /// Nodes on an obstacle. Their places as seen from it are taken in the first step and kept from then on.
  struct Fixed {
    Solid obstacle;              ///< as it goes in the step
    std::vector<Carried> nodes;  ///< origin: in the obstacle's own frame
    bool placed = false;
    template <class Archive>
    void serialize(Archive& archive) {
      archive(obstacle, nodes, placed);
    }
  };
  /// The obstacle at `time`, s, within the step.
  PlacedShape at(const Fixed& fixed, double time) const {
    return fixed.obstacle.placed((time - begin_) / step_);
  }

  std::vector<Path> carried_;
  std::vector<Led> led_;
  std::vector<Fixed> fixed_;
  double end_of_motion_ = 0;     ///< when the last path or motion ends, s; infinite if one loops
  double begin_ = 0, step_ = 1;  ///< of the step, s
};

}  // namespace weft
