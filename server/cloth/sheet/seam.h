#pragma once
#include <vector>

#include "cloth/core/particles.h"
#include "cloth/kernels/components.h"

namespace weft {

/// The seam of a cloth that is folded over along u = 1/2 and sewn together along its open rims: a bag. Node
/// (u, v) of the rim is one with (1 - u, v), with which it has its place, velocity and mass in common; both
/// weigh the same, so that what the two have as one is the mean of what each would have. It holds at every
/// level, and a level's seam passes through the nodes of that below.
template <class Real>
class Seam {
 public:
  struct Pair {
    std::size_t left, right;  ///< indices into the grid's arrays; u < 1/2 and u > 1/2
  };
  explicit Seam(const Grid& grid);

  const std::vector<Pair>& pairs() const { return pairs_; }
  /// Gives both nodes of each pair the mean of their two vectors: the nearest field that has them equal.
  void average(kernels::Components<Real> field) const;
  /// Makes one of each pair's positions, velocities and accelerations. Keeps momentum; of the kinetic energy
  /// what the two had against each other goes.
  void join(Particles<Real>& particles) const;

 private:
  std::vector<Pair> pairs_;
};

extern template class Seam<float>;
extern template class Seam<double>;

}  // namespace weft
