#pragma once
/// A piece of cloth in a testing instrument.
#include <functional>
#include <memory>
#include <stdexcept>
#include <vector>

#include "cloth/integrators/integrator.h"

namespace weft::fabric {

/// No rest was found: the instrument cannot tell a number.
class NoRest : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct SpecimenPlan {
  Material material;
  Vec2 size{0, 0};          ///< along u and v, m
  int rows = 0, cols = 0;   ///< nodes
  double gravity = 0;       ///< m/s2, downwards
  bool bends = true;        ///< resists bending by the material's rigidity
  bool limited = false;     ///< threads are pulled straight at the material's limit (StrainLimitEffect)
  double tolerance = 1e-4;  ///< of each step (ImplicitParameters)
  /// Which nodes an instrument holds, and which there are; nullptr: all.
  std::function<bool(int r, int c)> held = nullptr, there = nullptr;
};

/// A sheet in double precision that comes to rest between what holds it. It begins flat: u along x, v along
/// z, its first node at the origin, y up. What is not there is cut off and held, and so bears nothing.
class Specimen {
 public:
  explicit Specimen(const SpecimenPlan& plan);
  Specimen(const Specimen&) = delete;
  Specimen& operator=(const Specimen&) = delete;

  const Grid& grid() const { return particles_.grid(); }
  Vec3 at(int r, int c) const { return particles_.local_position_at(r, c); }
  void put(int r, int c, const Vec3& position);
  bool there(int r, int c) const;
  /// The face right of and below node (r, c) has all its corners.
  bool face_there(int r, int c) const;

  /// A step of so many seconds by backward Euler, which damps; how far the node moved that moved farthest, m.
  /// Throws NoRest if there is no next state.
  double advance(double step);
  /// Steps of `step` seconds until no node moves farther than `still` in one,
  /// m; at most `most`. Throws NoRest if it moves still.
  void rest(double step, double still, int most);
  /// What the springs do to every node, N, those that are held included.
  VectorField<double> pull() const;
  /// Of the bent plate, J.
  double bending_energy() const;

 private:
  Forces<double> forces(double time) const;
  /// Of the node in there_.
  std::size_t place_of(int r, int c) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(grid().cols) + static_cast<std::size_t>(c);
  }

  ClothDescription cloth_;
  Wind calm_;
  Particles<double> particles_;
  Sheet<double> sheet_;
  std::vector<std::unique_ptr<Effect<double>>> effects_;
  std::unique_ptr<Integrator<double>> integrator_;
  std::vector<Solid> no_solids_;
  std::vector<char> there_;
  double time_ = 0;  ///< s
};

/// The material with warp and weft changed over: what a strip of the weft is, laid along u.
Material turned(const Material& material);

}  // namespace weft::fabric
