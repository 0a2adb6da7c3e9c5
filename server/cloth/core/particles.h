#pragma once
#include "cloth/core/grid.h"
#include "cloth/core/vec3.h"

namespace weft {

/// The state of one cloth at one level: structure of arrays on the grid, SI units.
/// A pinned node has inverse_mass 0 and keeps its mass (Eq. 9 counts every particle).
///
/// Positions are relative to a place near the cloth (place.h), so that they have the same digits wherever in
/// the world the cloth is. Axes are the world's.
template <class Real>
struct Particles {
  Vec3 place{0, 0, 0};             ///< of the positions' origin in the world, m
  VectorField<Real> position;      ///< m, from the place
  VectorField<Real> velocity;      ///< m/s
  VectorField<Real> acceleration;  ///< m/s2, of the last substep (Eq. 6), split like the rest (Eq. 8)
  Field<Real> mass;                ///< kg
  Field<Real> inverse_mass;        ///< 1/kg, 0 where pinned

  Particles() = default;
  explicit Particles(const Grid& grid)
      : position(grid), velocity(grid), acceleration(grid), mass(grid), inverse_mass(grid) {}
  const Grid& grid() const { return position.grid(); }
  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(place, position, velocity, acceleration, mass, inverse_mass);
  }

  /// From the place, m.
  Vec3 local_position_at(int r, int c) const {
    return {double(position.x.at(r, c)), double(position.y.at(r, c)), double(position.z.at(r, c))};
  }
  /// In the world, m.
  Vec3 position_at(int r, int c) const { return place + local_position_at(r, c); }
  Vec3 velocity_at(int r, int c) const {
    return {double(velocity.x.at(r, c)), double(velocity.y.at(r, c)), double(velocity.z.at(r, c))};
  }
};

}  // namespace weft
