#pragma once
#include "cloth/core/particles.h"

namespace weft {

/// Takes so much energy, J, from the motion of the free nodes, or what there is of it: all are slowed down in
/// proportion. Where no node is held it is their motion beside that of a rigid body with their momentum and
/// angular momentum, so that both stay. Returns what is left of each velocity, relative, from 0 to 1.
template <class Real>
double take_from_motion(Particles<Real>& particles, double energy);

/// Scales `velocity`, m/s, of the free nodes in the same way: what an integrator remembers of the motion.
template <class Real>
void scale_motion(const Particles<Real>& particles, double factor, VectorField<Real>& velocity);

}  // namespace weft
