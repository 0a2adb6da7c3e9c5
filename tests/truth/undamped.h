#pragma once
/// Runs of scenes that nothing damps and nothing drives, and the energy of their state.
#include <iosfwd>
#include <limits>
#include <string>

#include "cloth/world/simulation.h"
#include "methods.h"

namespace weft::test {

struct UndampedRun {
  std::string scene;  ///< a preset, "silk-swing" or "strip"
  Method method;
  int level;
  int rate;        ///< steps a second
  int substeps;    ///< explicit methods choose their own, which bdf2 and backward_euler do not
  double seconds;  ///< at most
  double liveliness = 1, tolerance = Bdf2Description().tolerance;  ///< of implicit methods
  double processor =
      std::numeric_limits<double>::infinity();  ///< s; past it a run of kLeastSeconds or more ends
  bool in_double = false;                       ///< in double precision
};

void PrintTo(const UndampedRun& run, std::ostream* out);

IntegratorDescription method_of(const UndampedRun& run);
SimulationDescription scene_of(const UndampedRun& run);

struct Energy {
  double kinetic = 0, potential = 0;  ///< J
  double sum() const { return kinetic + potential; }
};

/// Kinetic energy and that of springs, plate and height, added up in double from the state alone.
///
/// Symplectic Euler's velocities are those of half a substep before its positions (leapfrog's: Hairer,
/// Lubich, Wanner, Geometric Numerical Integration, I.1.4). Energy is that of both at one time, so they are
/// brought forward by half a substep's force.
template <class Real>
Energy state_energy(const Simulation<Real>& simulation);

}  // namespace weft::test
