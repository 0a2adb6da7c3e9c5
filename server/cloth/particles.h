#pragma once
#include "cloth/grid.h"
#include "cloth/vec3.h"

namespace weft {

/// The state of one cloth at one level: structure of arrays on the grid, SI units.
/// A pinned node has inverse_mass 0 and keeps its mass (Eq. 9 counts every particle).
template <class Real>
struct Particles {
  VectorField<Real> position;      ///< m
  VectorField<Real> velocity;      ///< m/s
  VectorField<Real> acceleration;  ///< m/s2, of the last substep (Eq. 6), split like the rest (Eq. 8)
  Field<Real> mass;                ///< kg
  Field<Real> inverse_mass;        ///< 1/kg, 0 where pinned

  Particles() = default;
  explicit Particles(const Grid& grid)
      : position(grid), velocity(grid), acceleration(grid), mass(grid), inverse_mass(grid) {}
  const Grid& grid() const { return position.grid(); }

  Vec3 position_at(int r, int c) const {
    return {double(position.x.at(r, c)), double(position.y.at(r, c)), double(position.z.at(r, c))};
  }
  Vec3 velocity_at(int r, int c) const {
    return {double(velocity.x.at(r, c)), double(velocity.y.at(r, c)), double(velocity.z.at(r, c))};
  }
};

}  // namespace weft
