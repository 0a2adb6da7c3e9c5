#include "cloth/kernels/state_kernels.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "cloth/core/multiversion.h"

namespace weft::kernels {
namespace {

/// Numbers that are not below 0 are ordered as their bits are, infinity and NaN above all of them: an integer
/// maximum, which the compiler vectorises, misses neither.
template <class Real>
using Bits = std::conditional_t<sizeof(Real) == sizeof(std::uint32_t), std::uint32_t, std::uint64_t>;

template <class Real>
[[gnu::always_inline]] inline Bits<Real> squared_length(Real x, Real y, Real z) {
  return std::bit_cast<Bits<Real>>(x * x + y * y + z * z);
}

/// Of the distances between scalars i and i + other.
template <class Real>
[[gnu::always_inline]] inline Bits<Real> farthest(const Components<const Real>& row, std::ptrdiff_t other,
                                                  int count, Bits<Real> most) {
  for (int i = 0; i < count; ++i) {
    const Bits<Real> bits =
        squared_length(row.x[i + other] - row.x[i], row.y[i + other] - row.y[i], row.z[i + other] - row.z[i]);
    most = bits > most ? bits : most;
  }
  return most;
}

template <class Real>
[[gnu::always_inline]] inline StateExtremes<Real> state_extremes_any(const Grid& grid,
                                                                     const Components<const Real>& position,
                                                                     const Components<const Real>& velocity) {
  Bits<Real> speed = 0, along_u = 0, along_v = 0;
  for (int r = 0; r < grid.rows; ++r) {
    const Components<const Real> x = position + grid.index(r, 0);
    const Components<const Real> v = velocity + grid.index(r, 0);
    for (int c = 0; c < grid.cols; ++c) {
      const Bits<Real> bits = squared_length(v.x[c], v.y[c], v.z[c]);
      speed = bits > speed ? bits : speed;
    }
    along_u = farthest<Real>(x, 1, grid.cols - 1, along_u);
    if (r + 1 < grid.rows) along_v = farthest<Real>(x, grid.stride, grid.cols, along_v);
  }
  return {std::bit_cast<Real>(speed), std::bit_cast<Real>(along_u), std::bit_cast<Real>(along_v)};
}

/// Squared.
template <class Real>
struct MostOfSprings {
  Bits<Real> strain = 0, speed = 0;
};

/// Springs of one family that start in one row; `other` is where their second ends lie from the first.
template <class Real>
[[gnu::always_inline]] inline void add_row(const SpringColumns<Real>& springs,
                                           const Components<const Real>& x, const Components<const Real>& v,
                                           std::ptrdiff_t other, int count, MostOfSprings<Real>& most) {
  const Real per_length = 1 / springs.rest_length;
  Bits<Real> strain = most.strain, speed = most.speed;
  for (int i = 0; i < count; ++i) {
    // Springs that are cut or absent count as if nothing moved.
    const Real there = springs.stiffness[i] > 0 ? per_length : Real(0);
    const Real dx = x.x[i + other] - x.x[i], dy = x.y[i + other] - x.y[i], dz = x.z[i + other] - x.z[i];
    const Real stretch = there * (std::sqrt(dx * dx + dy * dy + dz * dz) - springs.rest_length);
    const Bits<Real> strained = std::bit_cast<Bits<Real>>(stretch * stretch);
    const Bits<Real> passing =
        squared_length<Real>(there * (v.x[i + other] - v.x[i]), there * (v.y[i + other] - v.y[i]),
                             there * (v.z[i + other] - v.z[i]));
    strain = strained > strain ? strained : strain;
    speed = passing > speed ? passing : speed;
  }
  most = {strain, speed};
}

template <class Real>
[[gnu::always_inline]] inline SpringMotion spring_motion_any(const SpringLattice<Real>& springs,
                                                             const Grid& grid,
                                                             const Components<const Real>& position,
                                                             const Components<const Real>& velocity) {
  MostOfSprings<Real> most;
  for (int r = 0; r < grid.rows; ++r) {
    const Components<const Real> x = position + grid.index(r, 0);
    const Components<const Real> v = velocity + grid.index(r, 0);
    const SpringLattice<Real> own = lattice_of_row(springs, r);
    add_row<Real>(own.along_u, x, v, 1, grid.cols - 1, most);
    if (r + 1 == grid.rows) break;
    add_row<Real>(own.along_v, x, v, grid.stride, grid.cols, most);
    if (!springs.has_shear) continue;
    add_row<Real>(own.falling, x, v, grid.stride + 1, grid.cols - 1, most);
    add_row<Real>(own.rising, x, v, grid.stride - 1, grid.cols, most);
  }
  return {std::sqrt(double(std::bit_cast<Real>(most.strain))),
          std::sqrt(double(std::bit_cast<Real>(most.speed)))};
}

}  // namespace

WEFT_MULTIVERSION StateExtremes<float> state_extremes(const Grid& grid, Components<const float> position,
                                                      Components<const float> velocity) {
  return state_extremes_any<float>(grid, position, velocity);
}
WEFT_MULTIVERSION StateExtremes<double> state_extremes(const Grid& grid, Components<const double> position,
                                                       Components<const double> velocity) {
  return state_extremes_any<double>(grid, position, velocity);
}

WEFT_MULTIVERSION SpringMotion spring_motion(const SpringLattice<float>& springs, const Grid& grid,
                                             Components<const float> position,
                                             Components<const float> velocity) {
  return spring_motion_any<float>(springs, grid, position, velocity);
}
WEFT_MULTIVERSION SpringMotion spring_motion(const SpringLattice<double>& springs, const Grid& grid,
                                             Components<const double> position,
                                             Components<const double> velocity) {
  return spring_motion_any<double>(springs, grid, position, velocity);
}

}  // namespace weft::kernels
