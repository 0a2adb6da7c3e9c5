#pragma once
#include "cloth/integrators/forces.h"

namespace weft {

/// Number of parts, 1 to 64, into which a substep of `h` seconds of an implicit method is divided in strong
/// air. What the air does turns with the faces, which the method's system leaves out (Aerodynamics): how a
/// face turns is found in iterations, which fail where the air would take a node along many times over in one
/// part. In each part the air's damping rate (Effect::max_damping_rate) times the part's length is at most 4,
/// unless 64 are too few.
template <class Real>
int parts_in_strong_air(const Particles<Real>& particles, const Forces<Real>& forces, double h);

/// Sets `velocity`, m/s, to what the nodes will have after a step of `dt` seconds if nothing but the air
/// changes it. The air's force on a node falls to none as it comes to go with the air: that of drag, which
/// goes by the square of the speed beside the air, gives a node at rest dt F / m / (1 + dt rate / 2), its
/// damping rate being 2 F / (m speed).
template <class Real>
void find_velocity_in_air(const Particles<Real>& particles, const Forces<Real>& forces, double dt,
                          VectorField<Real>& velocity);

extern template int parts_in_strong_air(const Particles<float>&, const Forces<float>&, double);
extern template int parts_in_strong_air(const Particles<double>&, const Forces<double>&, double);
extern template void find_velocity_in_air(const Particles<float>&, const Forces<float>&, double,
                                          VectorField<float>&);
extern template void find_velocity_in_air(const Particles<double>&, const Forces<double>&, double,
                                          VectorField<double>&);

}  // namespace weft
