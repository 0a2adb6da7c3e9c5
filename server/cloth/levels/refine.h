#pragma once
#include "cloth/core/particles.h"
#include "cloth/sheet/material.h"

namespace weft {

/// Level L to L + 1 (Eq. 8): shared nodes keep their values, a new node on an edge is the mean of its two
/// ends, one in a cell's centre the mean of its four corners; position, velocity and acceleration alike.
/// Masses are not touched: Eq. 9 recomputes them (mass_distribution). `fine` must have 2 rows - 1 by 2 cols -
/// 1 nodes of `coarse`.
template <class Real>
void split(const Particles<Real>& coarse, Particles<Real>& fine);

/// Level L to L - 1, the inverse: shared nodes keep their values, the rest is dropped. merge(split(x)) == x
/// bit for bit.
template <class Real>
void merge(const Particles<Real>& fine, Particles<Real>& coarse);

/// The momentum of fine nodes for the coarse velocities: full weighting by mass, each fine node's shared
/// among the coarse nodes that it lies between (1 a shared node's own, 1/2 and 1/4 a new one's). With masses
/// by area momentum is kept and kinetic energy only falls; taken over node by node (merge) it may rise, and a
/// cloth whose level changes back and forth is pumped. After a split this smooths: merge(split(v)) != v.
template <class Real>
void merge_momentum(const Particles<Real>& fine, Particles<Real>& coarse);

/// Fills `mass` for a sheet of `total_mass` kg. Paper: total/n each (Eq. 9). Continuum: by area, 1 inside,
/// 1/2 on an edge, 1/4 in a corner, so the sum is the total to the last bit at every level of one cloth.
template <class Real>
void mass_distribution(double total_mass, Discretization discretization, Field<Real>& mass);

}  // namespace weft
