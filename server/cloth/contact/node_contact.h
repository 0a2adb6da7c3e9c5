#pragma once
#include <vector>

#include "cloth/contact/contact.h"

namespace weft {

/// Cosine of the angle between the normals of solids that face each other: 120 degrees or more.
inline constexpr double kFacing = -0.5;

/// A solid in a substep.
struct MovingSolid {
  const Solid* solid;
  PlacedShape shape;  ///< at the substep's end
  Vec3 move;          ///< of its centre in the substep, m
  bool fast;          ///< nodes might pass through it unseen: their ways are looked at
  Vec3 velocity;      ///< with what the nodes so far gave it, m/s
  Substep substep;
};

/// One free node while its contacts in a substep are resolved.
template <class Real>
class NodeContact {
 public:
  struct State {
    Particles<Real>& particles;
    VectorField<Real>* rounded_off;  ///< or none (Contact::resolve)
  };
  /// `move` is the node's in the substep.
  NodeContact(const State& state, int row, int col, const Vec3& move, double seconds)
      : particles_(state.particles),
        rounded_off_(state.rounded_off),
        row_(row),
        col_(col),
        position_(state.particles.position_at(row, col)),
        start_(position_ - move),
        move_(move),
        seconds_(seconds) {}

  /// Brings the node out of all solids (pinched between two it stays with the one that moves least), and back
  /// from beyond those it passed through; those that yield get what it gives them, `touches` what it met.
  /// False if it met none.
  bool resolve(std::vector<MovingSolid>& solids, std::vector<Touch>& touches);

 private:
  bool stop_at_first(std::vector<MovingSolid>& solids, std::vector<Touch>& touches);
  /// A solid the node was found in.
  struct Found {
    std::size_t solid;
    Vec3 normal;
  };
  static void note(std::vector<Found>& found, std::size_t solid, const Vec3& normal);
  static std::optional<std::size_t> pinching(const std::vector<Found>& found,
                                             const std::vector<MovingSolid>& solids);
  void hold_at(MovingSolid& still);
  Vec3 lose_velocity(MovingSolid& moving, const Vec3& normal);
  double part_with(const Vec3& lost, MovingSolid& moving);
  bool put_on(const MovingSolid& moving, const Surface& surface);
  void put_outside(const PlacedShape& shape, const Vec3& from, const Vec3& direction, double distance);
  void lead_out(const std::vector<MovingSolid>& solids, const std::vector<Found>& found);
  void set_position(const Vec3& target);
  void set_velocity(const Vec3& velocity);
  Touch touch(const Solid& solid) const { return {particles_.grid().index(row_, col_), solid.id}; }

  Particles<Real>& particles_;
  VectorField<Real>* rounded_off_;
  int row_, col_;
  Vec3 position_, start_, move_;
  double seconds_;
};

extern template class NodeContact<float>;
extern template class NodeContact<double>;

}  // namespace weft
