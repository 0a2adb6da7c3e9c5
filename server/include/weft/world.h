#pragma once
/// Weft as a library: scenes that the caller steps, looks at and changes, without a server.
///
/// SI units, right-handed, y up. Every function throws weft::Error for an argument that it cannot take; the
/// world is then as it was.
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "weft/error.h"

namespace weft {

/// x, y, z.
using Vector = std::array<double, 3>;
/// A turn from a thing's own axes to the world's: the quaternion w, x, y, z, of any length but 0.
using Turn = std::array<double, 4>;

/// What a new ball is. With a mass it falls and is moved by cloth; without one it goes where it is told.
struct NewBall {
  Vector position{0, 0, 0};         ///< of its centre, m
  double radius = 0.2;              ///< m
  Vector velocity{0, 0, 0};         ///< m/s
  std::optional<double> mass = {};  ///< kg
  double friction = 0;              ///< Coulomb's coefficient
};

/// What a cloth is like at the moment.
struct ClothState {
  double kinetic_energy = 0;    ///< J
  double potential_energy = 0;  ///< J, of springs and height
  double max_stretch = 0;       ///< largest (l - l0) / l0 of a structural spring
  double max_compression = 0;   ///< largest (l0 - l) / l0 of one
  int nodes_in_contact = 0;     ///< in the last step
  int substeps = 0;             ///< of the last step
  bool asleep = false;          ///< it rests, and its steps cost nothing
  bool frozen = false;          ///< no step from its state gave a good one: it stands still
};

/// A scene being simulated. Deterministic: of equal scenes and equal calls between the same steps follow
/// equal states, to the bit, on any number of threads. One thread at a time may use a world and what it has
/// handed out; different worlds are independent.
class World {
  struct Impl;

 public:
  class Cloth;
  class Ball;
  class Obstacle;
  class Hand;

  /// The names of the scenes that come with the library.
  static std::vector<std::string> presets();
  /// A preset by its name, else a scene file by its path. `overrides` are "JSON-pointer=value", as
  /// "/wind/speed=8". Throws SceneError.
  static World load(const std::string& preset_or_file, const std::vector<std::string>& overrides = {});
  /// A scene from its JSON text (server/docs/scenes.md). Meshes and start positions that it names by file are
  /// looked for in `folder`; without one it may name none. Throws SceneError.
  static World parse(std::string_view document, const std::string& folder = {});

  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  /// Makes so many steps of time_step(), at least 0.
  void step(int count = 1);
  double time_step() const;  ///< s
  double time() const;       ///< s, since the start
  /// Back to the start, with what was added, taken away or changed since undone.
  void reset();
  /// At most so many threads work on steps from now on, 1 to 1024; results do not depend on it. Else as many
  /// as the machine has. All worlds of a program share them: the smallest number given to any counts.
  void use_threads(int count);

  /// The cloths, in the scene's order. They stay while the world lives.
  std::vector<Cloth> cloths() const;
  /// The cloth of that name.
  Cloth cloth(std::string_view name) const;
  /// The balls there are. A ball stays until it is removed, or the world reset.
  std::vector<Ball> balls() const;
  Ball add_ball(const NewBall& ball);
  /// The obstacles, in the scene's order. They stay while the world lives.
  std::vector<Obstacle> obstacles() const;

  /// A viewer's eye, m: from the next step on every cloth has the level that its distance from there deserves
  /// (Eq. 7 of the paper, with the scene's thresholds).
  void look_from(const Vector& eye);

  /// The wind's mean velocity, m/s, at most 100; gusts and turbulence stay as they are. For scenes with an
  /// effect that feels it.
  void set_wind(const Vector& velocity);
  /// How the air moves in one of the wind's zones, by its place in the scene, m/s.
  void set_wind_zone(std::size_t zone, const Vector& velocity);
  /// The types of the effects that are simulated, as "gravity".
  std::vector<std::string> effects() const;
  /// Switches an effect of the scene off or on, from the next step on.
  void set_effect(std::string_view effect, bool on);
  /// Numbers of an effect, as set_parameter("aerodynamics", "drag", {1.1}).
  void set_parameter(std::string_view effect, std::string_view parameter, const std::vector<double>& values);

  /// What the step guard had to do in the last step, a line each; empty if all went well.
  std::vector<std::string> events() const;
  /// 64 bits of the whole state: equal for equal states.
  std::uint64_t hash() const;
  /// All that the next steps follow from. For this build of the library alone.
  std::string save() const;
  /// Goes on from there, to the bit, in a world of the same scene. Throws Error if `state` is of another
  /// scene or was cut off; the world is then at its start.
  void restore(std::string_view state);

 private:
  explicit World(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A cloth of a world: rows x columns of nodes, row 0 at v = 0, column 0 at u = 0.
class World::Cloth {
 public:
  const std::string& name() const;
  /// Of its level: level L has 2^L cells on a side of a square cloth.
  int level() const;
  int min_level() const;
  int max_level() const;
  /// Split or merged to it before the next step.
  void set_level(int level);
  int rows() const;
  int columns() const;
  /// x, y, z of each node in the world, row by row, m. Until the next call of it or of World.
  std::span<const float> positions() const;
  /// The same, m/s.
  std::span<const float> velocities() const;
  /// Three nodes a triangle, counter-clockwise seen from the front; none of torn cells.
  std::vector<std::uint32_t> triangles() const;
  /// Mean of its nodes, m.
  Vector centre() const;
  double mass() const;  ///< kg
  ClothState state() const;

  /// Holds what is at (u, v), each 0 to 1, where it is now.
  void pin(double u, double v);
  /// Lets go of the pin nearest to (u, v). False if there is none.
  bool unpin(double u, double v);
  /// A hand takes hold of what is at (u, v), and pulls with at most `max_force`, N.
  Hand grab(double u, double v, double max_force = 100);
  /// Numbers of its material, as set_parameter("structural", {6000}).
  void set_parameter(std::string_view parameter, const std::vector<double>& values);

 private:
  friend class World;
  Cloth(Impl& world, std::size_t index) : world_(&world), index_(index) {}
  Impl* world_;
  std::size_t index_;
};

class World::Ball {
 public:
  std::uint32_t id() const { return id_; }
  Vector position() const;  ///< of its centre, m
  Vector velocity() const;  ///< m/s
  double radius() const;    ///< m
  /// Goes there within the next step, whatever is in its way, and stays.
  void move_to(const Vector& position);
  /// Flies off, m/s.
  void throw_off(const Vector& velocity);
  void set_friction(double friction);
  void remove();

 private:
  friend class World;
  Ball(Impl& world, std::uint32_t id) : world_(&world), id_(id) {}
  Impl* world_;
  std::uint32_t id_;
};

class World::Obstacle {
 public:
  /// Its place in the scene.
  std::size_t index() const { return index_; }
  Vector position() const;  ///< of its origin, m
  Turn turn() const;
  /// It has a mass: it can be thrown and grabbed.
  bool is_body() const;
  /// Takes the place, and the turn if one is given, within the next step, and stays.
  void move_to(const Vector& position, const std::optional<Turn>& turn = {});
  /// Flies off, m/s and rad/s.
  void throw_off(const Vector& velocity, const Vector& spin = {0, 0, 0});
  /// A hand takes hold of it at `point` of its own axes, m, and pulls with at most `max_force`, N.
  Hand grab(const Vector& point = {0, 0, 0}, double max_force = 100);
  void set_friction(double friction);

 private:
  friend class World;
  Obstacle(Impl& world, std::size_t index) : world_(&world), index_(index) {}
  Impl* world_;
  std::size_t index_;
};

/// Holds a cloth or a body until it is released, or the world reset.
class World::Hand {
 public:
  /// Goes there, m, within the next step.
  void move_to(const Vector& position);
  void release();

 private:
  friend class World;
  Hand(Impl& world, std::uint32_t id) : world_(&world), id_(id) {}
  Impl* world_;
  std::uint32_t id_;
};

}  // namespace weft
