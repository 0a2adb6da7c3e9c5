#pragma once
#include <vector>

#include "cloth/integrators/forces.h"
#include "cloth/integrators/integrator.h"
#include "cloth/shapes/solid.h"

namespace weft {

/// Of a solid that yields, J.
double kinetic_energy(const Solid& solid);

/// What a cloth may gain in a step by the bodies that it meets: hardly more than they lose, J. A solve that
/// ends before it has found what a hard blow leaves may gain far more, as nodes that it has not held are put
/// out of bodies without work.
template <class Real>
class BodyEnergy {
 public:
  /// As a step of dt seconds begins; `solids` as they fly in it.
  void begin(const Particles<Real>& particles, const Forces<Real>& forces, const std::vector<Solid>& solids,
             double dt);
  /// As it ends: reports if the cloth has gained more than the bodies and its effects, hands among them,
  /// could give (AdvanceReport::gained); of the effects' forces at the step's begin and end those count that
  /// do more work, as air's are gone at the end of a step that has brought the cloth up to its speed. Never
  /// if something else may do work on it: pins, other solids that move, other cloths, gas.
  void judge(const Particles<Real>& particles, const Forces<Real>& forces, const std::vector<Solid>& solids,
             AdvanceReport& report);

 private:
  bool applies_ = false;
  double cloth_ = 0, bodies_ = 0;  ///< as the step begins, J
  /// What standard gravity gives in the step to all that is at rest, J: the springs that keep things apart
  /// hold about as much where weights rest.
  double pressed_ = 0;
  VectorField<Real> start_;         ///< the nodes' places as the step begins, m
  VectorField<Real> first_, last_;  ///< the effects' forces as it begins and ends, N
};

extern template class BodyEnergy<float>;
extern template class BodyEnergy<double>;

}  // namespace weft
