#pragma once
#include "cloth/kernels/components.h"
#include "cloth/kernels/link_kernels.h"
#include "cloth/kernels/uniform.h"

namespace weft::kernels {

/// What a face gives the air that flows through it: 1/2 rho times the coefficients.
template <class Real>
struct Plate {
  Real normal;  ///< 1/2 rho C_L: along the normal
  Real along;   ///< 1/2 rho (C_D - C_L): besides, along the relative wind
};

// Below, Air is the air's velocity: Uniform, or Components<const float> of every node.

/// The force on every face (cell), a quarter of it on each corner: normal |w.A| (w.A) A / |A|^2 +
/// along |w.A| (w.A)^2 w / (|A|^2 |w|^2) with A the face's area vector, half the cross product of its
/// diagonals, and w the air's velocity relative to the mean of the corners'. The first |w.A| counts no more
/// than `most_flow`, m3/s: the force then grows with speed no longer by its square.
template <class Real, class Air>
void add_air_force(const Grid& grid, Components<const Real> position, Components<const Real> velocity,
                   const Air& air, const Plate<Real>& plate, Real most_flow, Components<Real> force);

/// Adds -dF/dv of add_air_force (without a limit to the flow), or what is no less, to every node's matrix,
/// N s/m, a quarter of each face's to each corner as if only that corner moved the face's air. The part along
/// the normal has 2 normal |w.A| n n^T. The other one's is neither symmetric nor definite; with c = w_n/|w|
/// the largest eigenvalue of its symmetric part is |w.A| times at most 2.19 |along c|, so it gets
/// 2.2 |along c w.A| in all directions.
template <class Real, class Air>
void add_air_damping(const Grid& grid, Components<const Real> position, Components<const Real> velocity,
                     const Air& air, const Plate<Real>& plate, const Blocks<Real>& damping);

/// Largest |w.A| of any face, m3/s.
template <class Real, class Air>
Real max_air_flow(const Grid& grid, Components<const Real> position, Components<const Real> velocity,
                  const Air& air);

}  // namespace weft::kernels
