#pragma once
#include "cloth/core/particles.h"
#include "cloth/shapes/bounding_sphere.h"

namespace weft {

/// kg, summed in double.
template <class Real>
double total_mass(const Particles<Real>& particles);
/// Of mass, in the world, m, summed in double.
template <class Real>
Vec3 centre_of_mass(const Particles<Real>& particles);
/// kg m/s, summed in double.
template <class Real>
Vec3 linear_momentum(const Particles<Real>& particles);
/// kg m2/s about the world's origin, summed in double.
template <class Real>
Vec3 angular_momentum(const Particles<Real>& particles);
/// kg m2, about a point in the world, summed in double.
template <class Real>
Eigen::Matrix3d inertia_about(const Vec3& point, const Particles<Real>& particles);
/// J, of the free nodes.
template <class Real>
double kinetic_energy(const Particles<Real>& particles);
/// J, zero at the world's height 0: -sum m a . r for the constant acceleration a.
template <class Real>
double gravitational_energy(const Particles<Real>& particles, const Vec3& acceleration);
/// False if any position or velocity is NaN or infinite. Vectorised: a few microseconds at level 6.
template <class Real>
bool is_finite(const Particles<Real>& particles);
/// Mean of the node positions, in the world, m: the cloth's centre for Eq. 7.
template <class Real>
Vec3 centre(const Particles<Real>& particles);
/// The smallest sphere around that centre which holds all nodes.
template <class Real>
BoundingSphere bounding_sphere(const Particles<Real>& particles);

}  // namespace weft
