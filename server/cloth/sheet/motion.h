#pragma once
#include "cloth/sheet/freedom.h"

namespace weft {

/// A node is. What stands firm takes up momentum, too, where a cloth leans on it: the functions below may be
/// told which rigid motions are free nonetheless.
template <class Real>
bool is_held(const Particles<Real>& particles);

/// Kinetic energy of the free nodes, J.
struct MotionEnergy {
  double beside_centre;  ///< without that of the centre of mass, if all rigid motions are free; else all
  double inner;          ///< without that of the free rigid motion that has its part of their momenta
};
template <class Real>
MotionEnergy motion_energy(const Particles<Real>& particles, const Freedom& freedom);

/// Work of `force`, N, on free nodes that have gone `way`, m, in J; where no node is held without the work of
/// the forces' sum on the centre of mass.
template <class Real>
double work_beside_centre(const Particles<Real>& particles, const VectorField<Real>& force,
                          const VectorField<Real>& way, bool held);

/// Adds to the velocities of the free nodes what `force`, N, does to them in so many seconds.
template <class Real>
void accelerate(Particles<Real>& particles, const VectorField<Real>& force, double seconds);

/// Gives the motion of the free nodes so much energy, J, or takes it where that is below 0, as far as there
/// is any: all velocities are scaled alike, but for the free rigid motion, so that what it has of momentum
/// and angular momentum stays. Returns the scale, from 0; 1 where nothing moves so.
template <class Real>
double add_to_motion(Particles<Real>& particles, double energy, const Freedom& freedom);

/// The same for energy that is taken, but nothing is given.
template <class Real>
double take_from_motion(Particles<Real>& particles, double energy, const Freedom& freedom);

/// Scales `velocity`, m/s, of the free nodes in the same way: what an integrator remembers of the motion.
template <class Real>
void scale_motion(const Particles<Real>& particles, double factor, VectorField<Real>& velocity,
                  const Freedom& freedom);

/// The same by whether a node is held.
template <class Real>
MotionEnergy motion_energy(const Particles<Real>& particles) {
  return motion_energy(particles, freedom_of(particles));
}
template <class Real>
double work_beside_centre(const Particles<Real>& particles, const VectorField<Real>& force,
                          const VectorField<Real>& way) {
  return work_beside_centre(particles, force, way, is_held(particles));
}
template <class Real>
double add_to_motion(Particles<Real>& particles, double energy) {
  return add_to_motion(particles, energy, freedom_of(particles));
}
template <class Real>
double take_from_motion(Particles<Real>& particles, double energy) {
  return take_from_motion(particles, energy, freedom_of(particles));
}
template <class Real>
void scale_motion(const Particles<Real>& particles, double factor, VectorField<Real>& velocity) {
  scale_motion(particles, factor, velocity, freedom_of(particles));
}

}  // namespace weft
