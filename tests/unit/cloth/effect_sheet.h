#pragma once
/// A small sheet on its own, to look at one effect's forces on it.
#include <cmath>

#include "cloth/forces/effect.h"
#include "fixtures.h"

namespace weft::test {

/// A 2 m x 1 m sheet of 0.1 kg/m2 on 5 x 9 nodes (cells of 0.25 m) and what an effect may read about it.
struct Sheet {
  ClothDescription cloth;
  Wind wind;
  Particles<double> particles;

  explicit Sheet(Discretization discretization) : particles(test::flat_sheet<double>(5, 9, {2, 1})) {
    cloth.size = {2, 1};
    cloth.discretization = discretization;
    cloth.material.density = 0.1;
    test::share_mass(particles, 0.2, discretization);
  }
  EffectContext context() const { return {&cloth, &wind, 0.0}; }
  VectorField<double> forces(const Effect<double>& effect) const {
    VectorField<double> force(particles.grid());
    effect.add_forces(particles, context(), force);
    return force;
  }
};

inline Vec3 total(const VectorField<double>& force) {
  Vec3 sum = Vec3::Zero();
  each_node(force.grid(), [&](int r, int c) { sum += get(force, r, c); });
  return sum;
}

/// Share of a cell's area that node (r, c) represents: 1 inside, 1/2 on an edge, 1/4 in a corner.
inline double area_share(const Grid& grid, int r, int c) {
  return (r == 0 || r == grid.rows - 1 ? 0.5 : 1.0) * (c == 0 || c == grid.cols - 1 ? 0.5 : 1.0);
}

inline constexpr Discretization kBoth[] = {Discretization::paper, Discretization::continuum};

/// Turns the sheet about the x axis: its normal, (0, 0, 1), becomes (0, -sin, cos).
inline void tilt(Particles<double>& particles, double angle) {
  each_node(particles.grid(), [&](int r, int c) {
    const double y = particles.position_at(r, c).y();
    set(particles.position, r, c,
        {particles.position_at(r, c).x(), y * std::cos(angle), y * std::sin(angle)});
  });
}

}  // namespace weft::test
