#pragma once
#include <Eigen/Core>
#include <vector>

#include "cloth/core/particles.h"

namespace weft {

/// Where what stands firm pushes a cloth: at `point` along `normal`, both ways.
struct Push {
  Vec3 point;   ///< m
  Vec3 normal;  ///< of length 1
};

/// The rigid motions of a cloth against which nothing pushes that holds it or that it leans on, as a space of
/// screws. Forces from there work on none of them, so the momentum and angular momentum that belong to them
/// are what the effects make of them.
class Freedom {
 public:
  using Screw = Eigen::Matrix<double, 6, 1>;

  /// All: nothing holds it.
  static Freedom all();
  /// None: a node is held.
  static Freedom none() { return {}; }
  /// Those of particles that bring none of the points nearer to what pushes there, nor farther from it. A
  /// motion is free if it does so by less than kFree of its own speed, in the mean over the points.
  static Freedom beside(const std::vector<Push>& pushes, const Vec3& centre, double radius);

  bool is_none() const { return screws_.cols() == 0; }
  bool is_all() const { return screws_.cols() == 6; }
  /// The free rigid motion with that part of the momentum, N s, and the angular momentum about `centre`, N m
  /// s, which belongs to free ones, of a body of this mass, kg, and inertia about its centre, kg m2: the
  /// velocity of the centre, m/s, and the spin, rad/s.
  Screw motion(const Screw& momentum, double mass, const Eigen::Matrix3d& inertia) const;

 private:
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, 6> screws_{6, 0};  ///< m/s, rad/s
};

/// By whether a node is held.
template <class Real>
Freedom freedom_of(const Particles<Real>& particles);
/// Of particles of which no node is held, beside what pushes them.
template <class Real>
Freedom freedom_beside(const std::vector<Push>& pushes, const Particles<Real>& particles);

}  // namespace weft
