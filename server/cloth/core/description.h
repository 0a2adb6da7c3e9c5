#pragma once
/// What a simulation is made from: plain values, checked by whoever fills them (server/scene for files).
/// Field names equal the names in scene files.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cloth/air/wind.h"
#include "cloth/core/grid.h"
#include "cloth/core/vec3.h"
#include "cloth/levels/level_policy.h"
#include "cloth/levels/relevance.h"
#include "cloth/sheet/material.h"

namespace weft {

class TriangleMesh;

// --- Effects: only those listed in a simulation are built and cost anything (D5) ---

/// Eq. 2: F = m g.
struct GravityEffect {
  Vec3 acceleration = standard_gravity();  ///< m/s2
  static constexpr const char* kName = "gravity";
};

/// Eq. 3: F = -k v, with each cloth's own Material::damping.
struct DampingEffect {
  static constexpr const char* kName = "damping";
};

/// Eq. 4: F = lambda N on every particle. N is the wind's direction; the force grows linearly with the wind's
/// speed and is Eq. 4 exactly at 1 m/s, which is what the paper's presets have.
struct PaperWindEffect {
  double factor = 1.0;  ///< lambda, N at 1 m/s: per particle (paper) or per m2 (continuum); finite, >= 0
  bool along_normal =
      false;  ///< true reads "unit normal vector" as the cloth's: N is the surface normal, turned downwind
  static constexpr const char* kName = "paper_wind";
};

/// Moving air on a face: F/A = 1/2 rho |w_n| w_n (C_D (n.e) e + C_L (n - (n.e) e)) with w = wind - velocity,
/// e = w / |w|, w_n = w . n; drag along the relative wind and lift across it. Where both coefficients are C,
/// as by default, that is a flat plate's pressure, 1/2 rho C |w_n| w_n n. A sheet falling face on reaches
/// sqrt(2 rho_cloth g / (rho C_D)), T16 in the truths.
struct AerodynamicsEffect {
  double air_density = 1.225;       ///< kg/m3
  double drag = 1.2;                ///< C_D, dimensionless
  std::optional<double> lift = {};  ///< C_L, dimensionless; default: as drag
  double lift_or_drag() const { return lift.value_or(drag); }
  static constexpr const char* kName = "aerodynamics";
};

/// Springs that resist the rate of their length too (Kelvin-Voigt): F = -tau k n (n . (v_i - v_j)) on end i.
/// A mode of angular frequency w decays at tau w^2 / 2; a cloth that moves or turns as a whole keeps its
/// motion.
struct StrainDampingEffect {
  double time = 1e-3;  ///< tau, s; finite, >= 0. Explicit methods need substeps in proportion to it.
  static constexpr const char* kName = "strain_damping";
};

/// Resistance to curvature, with each cloth's own Material::rigidity (plate.h).
struct PlateBendingEffect {
  static constexpr const char* kName = "plate_bending";
};

/// Threads that are pulled straight: structural and shear springs stiffen beyond each cloth's own
/// Material::limit, the tension going on without a jump (the bilinear springs of biphasic cloth models;
/// Provot, Deformation constraints in a mass-spring model, 1995, holds the limit outright).
struct StrainLimitEffect {
  static constexpr const char* kName = "strain_limit";
};

/// Cloth does not pass through itself nor through another cloth of the scene (layers/layers.h).
struct ClothContactEffect {
  double thickness = 0.005;  ///< kept between layers, m; finite, > 0. Held to half a cell of a level.
  double friction = 0.3;     ///< Coulomb's coefficient between cloth and cloth, >= 0
  bool operator==(const ClothContactEffect&) const = default;
  static constexpr const char* kName = "cloth_contact";
};

/// Air under a sheet that is held all round its rim, as under an air-supported roof or in a bouncy castle: a
/// pressure above that outside, kept up whatever the volume, pushes every face along its normal, F = p A. A
/// sheet whose rim is free is pushed from its back. With a volume, gas that is shut in the scene's sewn
/// cloths and no other, each its own (effects/gas.h).
struct InflationEffect {
  double pressure = 100;  ///< Pa; finite. Below 0 it sucks; that of gas is above -p_a.
  /// What the gas has this pressure in, m3; > 0. Default: there is a pump, which keeps the pressure up.
  std::optional<double> volume = {};
  /// From when the effect is there, during which gas is poured in, s; >= 0. 0: it is there at once, and the
  /// bag is blown up without motion (Unsettled::by_gas).
  double fill_time = 1;
  bool operator==(const InflationEffect&) const = default;
  static constexpr const char* kName = "inflation";
};

/// Cloth tears where it is pulled too hard: a structural link breaks at the end of a step in which the sheet
/// carries more tension across its middle, per metre of cloth, than this (tear/tearing.h).
struct TearingEffect {
  double warp = 1000;  ///< strength along u, N/m; finite, > 0
  double weft = 1000;  ///< along v, N/m
  static constexpr const char* kName = "tearing";
};

using EffectDescription =
    std::variant<GravityEffect, DampingEffect, PaperWindEffect, AerodynamicsEffect, StrainDampingEffect,
                 PlateBendingEffect, StrainLimitEffect, ClothContactEffect, InflationEffect, TearingEffect>;

// --- Things in the scene ---

/// A point passed at a time; linear between points, at rest before the first and after the last.
struct Waypoint {
  double time = 0.0;  ///< s, ascending
  Vec3 position{0.0, 0.0, 0.0};
};

/// Where something is and how it is turned.
struct Pose {
  Vec3 position{0.0, 0.0, 0.0};
  Quaternion orientation = Quaternion::Identity();  ///< local to world
};
/// A pose taken at a time; between two points straight and turning at an even rate the shorter way round, at
/// rest before the first and after the last.
struct PoseWaypoint {
  double time = 0.0;  ///< s, ascending
  Pose pose;
};

/// Nodes held where they are: all with u, v inside the closed rectangle, or the nearest one if there is none.
/// (0, 0) is the top left corner, (1, 1) the bottom right one.
struct PinRegion {
  double u_min = 0, u_max = 0, v_min = 0, v_max = 0;  ///< in [0, 1]
  std::vector<Waypoint> path = {};  ///< how far they are from where they start, if they are moved
  bool loop = false;                ///< the path begins anew when it ends; it then ends where it begins
  /// They go with this one of the simulation's obstacles, counted from 0, as if fixed to it; no path then.
  std::optional<int> obstacle = {};
};

struct ClothDescription {
  std::string name = "cloth";
  Vec2 size{2.0, 2.0};  ///< width (along u) and height (along v), m; > 0
  BaseCells base_cells;
  /// The cloth lies in its local x-y plane, centred, u along +x, v along -y (it hangs), face normal +z.
  Vec3 position{0.0, 0.0, 0.0};                     ///< of the centre, m
  Quaternion orientation = Quaternion::Identity();  ///< local to world
  std::vector<Vec3> nodes;  ///< start positions in the world at initial_level, row by row; empty: the flat
                            ///< sheet. Rest lengths always come from `size`.
  Vec3 velocity{0.0, 0.0, 0.0};  ///< of every free node at the start, m/s
  double perturbation =
      0.0;  ///< random offset of each free node along the sheet's local z at the start, up to this, m
  int min_level = 4, max_level = 6, initial_level = 6;
  Material material;
  Discretization discretization = Discretization::continuum;
  /// A bag: folded over along u = 1/2, its back inside, and sewn together along its open rims (seam.h). It
  /// begins so, hardly open, its flat half as wide.
  bool sewn = false;
  std::vector<PinRegion> pins;
  Relevance relevance;
};

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

/// All space below a plane: a floor, a wall. `position` is one of its points.
struct PlaneDescription {
  Vec3 normal{0.0, 1.0, 0.0};  ///< unit, out of the solid
  static constexpr const char* kName = "plane";
};
/// A solid box; `position` is its centre.
struct BoxDescription {
  Vec3 size{1.0, 1.0, 1.0};                         ///< lengths of its edges, m; > 0
  Quaternion orientation = Quaternion::Identity();  ///< local to world
  static constexpr const char* kName = "box";
};
/// All within `radius` of a stretch of its own y axis around `position`: an arm, a rail.
struct CapsuleDescription {
  double radius = 0.1;  ///< m, > 0
  double length = 1.0;  ///< of the stretch, between its round ends' centres, m; > 0
  Quaternion orientation = Quaternion::Identity();  ///< local to world
  static constexpr const char* kName = "capsule";
};
/// Within a closed surface of triangles around `position`, which is the origin of its vertices.
struct MeshDescription {
  std::shared_ptr<const TriangleMesh> surface;
  Quaternion orientation = Quaternion::Identity();  ///< local to world
  bool convex = false;                              ///< known to be: told to viewers
  static constexpr const char* kName = "mesh";
  static constexpr const char* kConvexName = "convex";
};
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
  std::variant<PlaneDescription, BoxDescription, CapsuleDescription, MeshDescription> shape;
  Vec3 position{0.0, 0.0, 0.0};
  double friction = 0.0;  ///< as a ball's
  /// Overrides position and orientation. Planes keep their normal.
  std::vector<PoseWaypoint> path = {};
  bool loop = false;  ///< as a pin's
  /// No planes, and shapes only whose origin is their centre of mass. Dynamic ones have no path.
  std::optional<BodyDescription> body = {};
};

// --- How it is stepped ---

/// The paper's explicit method, Eq. 6.
struct SymplecticEulerDescription {
  int substeps = 0;     ///< per step; 0 chooses the fewest that keep the stiffest mode stable, and more
                        ///< while springs turn over
  double safety = 0.9;  ///< with substeps = 0: share of the stability limit used, (0, 1]
  bool operator==(const SymplecticEulerDescription&) const = default;
  static constexpr const char* kName = "symplectic_euler";
};
/// The implicit methods: one linear system a Newton iteration, solved by multigrid conjugate gradients.
struct ImplicitParameters {
  int substeps = 1;  ///< per step, >= 1
  /// Root of the energy that a substep's error may have, relative to the motion's, (0, 1]. Of cloth that
  /// something touches a fifth of it: what errors take from its motion nobody gives back.
  double tolerance = 0.1;
  /// Linearisations a substep, >= 1: fewer when one is accurate enough, more where the motion is rough or
  /// would gain energy.
  int newton_iterations = 2;
  /// Largest number of iterations of a linear solve, >= 1. Some presets reach 60; with that as the limit
  /// springs of 1e7 N/m are stretched 1.75 times as far as a hard case allows.
  int linear_iterations = 200;
  /// Share, 0 to 1, of what a step's errors take from the motion or give it that is made good, where nothing
  /// but wind drives the cloth and nothing touches it; in wind, of half of it (EnergyLedger).
  double liveliness = 1;
  bool operator==(const ImplicitParameters&) const = default;
};
/// Backward Euler: first order, damps (T3 in the truths), the sturdiest.
struct BackwardEulerDescription : ImplicitParameters {
  bool operator==(const BackwardEulerDescription&) const = default;
  static constexpr const char* kName = "backward_euler";
};
/// Backward differentiation formula of second order: nearly keeps the energy of slow motion.
struct Bdf2Description : ImplicitParameters {
  bool operator==(const Bdf2Description&) const = default;
  static constexpr const char* kName = "bdf2";
};

/// Every spring a constraint, projected once a substep: bounded whatever the stiffness, softer than asked for
/// until the substeps are many (xpbd.h says by how much).
struct XpbdDescription {
  /// Per step. Twice as many leave a quarter of the excess stretch. In violent motion up to 4 times that. 0:
  /// the fewest that are as short as stated.
  int substeps = 0;
  double longest_substep = 1.0 / 2400;  ///< s, with substeps = 0: 40 a step of 1/60 s
  bool operator==(const XpbdDescription&) const = default;
  static constexpr const char* kName = "xpbd";
};
using IntegratorDescription =
    std::variant<SymplecticEulerDescription, BackwardEulerDescription, Bdf2Description, XpbdDescription>;
inline bool is_implicit(const IntegratorDescription& integrator) {
  return std::holds_alternative<BackwardEulerDescription>(integrator) ||
         std::holds_alternative<Bdf2Description>(integrator);
}

struct SimulationDescription {
  std::vector<ClothDescription> cloths;
  std::vector<BallDescription> balls;
  std::vector<ObstacleDescription> obstacles;
  std::vector<EffectDescription> effects;
  Wind wind;
  IntegratorDescription integrator = Bdf2Description{};
  double time_step = 1.0 / 60.0;  ///< s
  /// A cloth none of whose nodes has got on faster for 60 steps, with nothing moving near it, sleeps: it is
  /// left as it is until something comes (Sleep), and so the bodies on it (islands.h), m/s; 0: never.
  double sleep_speed = 1e-4;
  LevelPolicy level_policy;
  std::uint64_t seed = 1;
};

}  // namespace weft
