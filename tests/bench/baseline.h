#pragma once
/// The paper's method written plainly, the yardstick of every speed-up: one object per particle, a list of
/// springs, explicit Euler (Eq. 6) with fixed substeps, every particle tested against every ball. No grid, no
/// vector loops, no boxes. It shares nothing with the library but the scene's description and the balls'
/// motion.
#include <vector>

#include "cloth/world/simulation.h"

namespace weft::bench {

template <class Real>
struct Vector {
  Real x{}, y{}, z{};
};

template <class Real>
struct Particle {
  Vector<Real> position, velocity, acceleration, force;
  Real mass{};
  bool pinned = false;
};

/// Between two particles, by their places in the list.
template <class Real>
struct Spring {
  std::size_t a = 0, b = 0;
  Real rest_length{}, stiffness{};
};

template <class Real>
class Baseline {
 public:
  /// Goes on from where `simulation` is now, with its one cloth at its present level, its balls and its wind.
  /// Throws std::invalid_argument for what the paper's method does not know: another discretization, other
  /// effects, wind along the cloth's normal, several cloths.
  Baseline(const Simulation<Real>& simulation, int substeps);

  void step();
  const std::vector<Particle<Real>>& particles() const { return particles_; }  ///< row by row
  const std::vector<Spring<Real>>& springs() const { return springs_; }

 private:
  void connect(int rows, int cols, const ClothDescription& cloth);
  void clear_forces();
  void add_spring_forces();
  void add_other_forces();
  void integrate(Real h);
  void collide(double fraction);

  std::vector<Particle<Real>> particles_;
  std::vector<Spring<Real>> springs_;
  Colliders colliders_;
  int substeps_;
  double time_, time_step_;
  Vec3 ball_gravity_;
  Vector<Real> gravity_, wind_force_;
  Real damping_{};
};

extern template class Baseline<float>;
extern template class Baseline<double>;

}  // namespace weft::bench
