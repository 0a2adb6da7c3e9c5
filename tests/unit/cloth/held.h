#pragma once
/// The work of those who hold a cloth.
#include <vector>

#include "cloth/world/cloth.h"

namespace weft::test {

/// Where a cloth is held, and the force, N, by which its springs and weight pull there.
struct Held {
  std::vector<Vec3> position, force;

  template <class Real>
  static Held of(const Cloth<Real>& cloth) {
    const Particles<Real>& particles = cloth.particles();
    const Grid& grid = particles.grid();
    VectorField<Real> springs(grid);
    cloth.springs().add_forces(particles.position, springs);
    Held held;
    for (int r = 0; r < grid.rows; ++r) {
      for (int c = 0; c < grid.cols; ++c) {
        if (particles.inverse_mass.at(r, c) != 0) continue;
        held.position.push_back(particles.position_at(r, c));
        const Vec3 pull(double(springs.x.at(r, c)), double(springs.y.at(r, c)), double(springs.z.at(r, c)));
        held.force.push_back(pull + double(particles.mass.at(r, c)) * standard_gravity());
      }
    }
    return held;
  }
};

/// J, that who holds the cloth puts in from one state to another: force times way, by the trapezoidal rule.
inline double work(const Held& from, const Held& to) {
  double sum = 0;
  for (std::size_t i = 0; i < from.position.size(); ++i) {
    sum -= (from.force[i] + to.force[i]).dot(to.position[i] - from.position[i]) / 2;
  }
  return sum;
}

}  // namespace weft::test
