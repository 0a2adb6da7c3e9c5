#include "cloth/sheet/seam.h"

namespace weft {

template <class Real>
Seam<Real>::Seam(const Grid& grid) {
  const int last = grid.cols - 1;
  const auto sew = [&](int r, int c) { pairs_.push_back({grid.index(r, c), grid.index(r, last - c)}); };
  for (int r = 0; r < grid.rows; ++r) sew(r, 0);
  for (const int r : {0, grid.rows - 1}) {
    for (int c = 1; 2 * c < last; ++c) sew(r, c);
  }
}

template <class Real>
void Seam<Real>::average(kernels::Components<Real> field) const {
  for (Real* component : {field.x, field.y, field.z}) {
    for (const Pair& pair : pairs_) {
      component[pair.left] = component[pair.right] = (component[pair.left] + component[pair.right]) / 2;
    }
  }
}

template <class Real>
void Seam<Real>::join(Particles<Real>& particles) const {
  average(kernels::components(particles.position));
  average(kernels::components(particles.velocity));
  average(kernels::components(particles.acceleration));
}

template class Seam<float>;
template class Seam<double>;

}  // namespace weft
