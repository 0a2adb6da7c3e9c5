#pragma once
#include <memory>
#include <optional>
#include <tuple>
#include <variant>
#include <vector>

#include "cloth/core/path.h"
#include "cloth/core/vec3.h"
#include "cloth/shapes/shape.h"

namespace weft {

struct BallDescription {
  enum class Motion {
    kinematic,  ///< goes where it is told (velocity, path, commands); the cloth yields
    dynamic,    ///< falls under the scene's gravity, is slowed by the cloth, lands on what is in its way
  };
  Vec3 position{0.0, 0.0, 0.0};
  double radius = 0.2;  ///< m, > 0
  Vec3 velocity{0.0, 0.0, 0.0};
  Motion motion = Motion::kinematic;
  double mass = 1.0;           ///< kg, > 0, dynamic balls only
  double friction = 0.0;       ///< Coulomb's coefficient, >= 0; between two solids the geometric mean
  std::vector<Waypoint> path;  ///< kinematic balls only; overrides position and velocity
  bool loop = false;           ///< as a pin's
};

/// A length, or lengths, of a shape by the name that scene files and messages have for it; m, > 0.
template <class Member>
struct NamedLength {
  const char* name;
  Member member;
};
template <class Member>
NamedLength(const char*, Member) -> NamedLength<Member>;

// A shape that scene files may name: its `orientation`, the Shape it is and, unless it is a plane or a mesh,
// its lengths(), by which it is read and told to viewers.

/// All space below a plane: a floor, a wall. `position` is one of its points.
struct PlaneDescription {
  Vec3 normal{0.0, 1.0, 0.0};  ///< unit, out of the solid
  static constexpr const char* kName = "plane";
  Shape shape() const { return HalfSpace{}; }
};
/// A solid box; `position` is its centre.
struct BoxDescription {
  Vec3 size{1.0, 1.0, 1.0};                         ///< lengths of its edges, m; > 0
  Quaternion orientation = Quaternion::Identity();  ///< local to world
  static constexpr const char* kName = "box";
  static constexpr auto lengths() { return std::tuple(NamedLength{"size", &BoxDescription::size}); }
  Shape shape() const { return Box{size / 2}; }
};
/// All within `radius` of a stretch of its own y axis around `position`: an arm, a rail.
struct CapsuleDescription {
  double radius = 0.1;  ///< m, > 0
  double length = 1.0;  ///< of the stretch, between its round ends' centres, m; > 0
  Quaternion orientation = Quaternion::Identity();  ///< local to world
  static constexpr const char* kName = "capsule";
  static constexpr auto lengths() {
    return std::tuple(NamedLength{"radius", &CapsuleDescription::radius},
                      NamedLength{"length", &CapsuleDescription::length});
  }
  Shape shape() const { return Capsule{length / 2, radius}; }
};
/// Within a closed surface of triangles around `position`, which is the origin of its vertices.
struct MeshDescription {
  std::shared_ptr<const TriangleMesh> surface;
  Quaternion orientation = Quaternion::Identity();  ///< local to world
  bool convex = false;                              ///< known to be: told to viewers
  static constexpr const char* kName = "mesh";
  static constexpr const char* kConvexName = "convex";
  Shape shape() const { return Mesh{surface.get()}; }
};
/// Meshes, which are named in two ways, last.
using ObstacleShape = std::variant<PlaneDescription, BoxDescription, CapsuleDescription, MeshDescription>;
/// What an obstacle needs to fly, of uniform density.
struct BodyDescription {
  double mass = 1.0;             ///< kg, > 0
  bool dynamic = true;           ///< flies from the start; else it is told where to go until it is thrown
  Vec3 velocity{0.0, 0.0, 0.0};  ///< of its centre, at the start if dynamic, m/s
  Vec3 spin{0.0, 0.0, 0.0};      ///< the same, rad/s, in the world
};
/// Something that stands where it is or goes where it is told (path, commands), and the cloth yields; or, as
/// a body, flies under the scene's gravity and is slowed and turned by the cloth.
struct ObstacleDescription {
  ObstacleShape shape;
  Vec3 position{0.0, 0.0, 0.0};
  double friction = 0.0;  ///< as a ball's
  /// Overrides position and orientation. Planes keep their normal.
  std::vector<PoseWaypoint> path = {};
  bool loop = false;  ///< as a pin's
  /// No planes, and shapes only whose origin is their centre of mass. Dynamic ones have no path.
  std::optional<BodyDescription> body = {};
};

}  // namespace weft
