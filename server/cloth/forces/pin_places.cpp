#include "cloth/forces/pin_places.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// Of a step between nodes: what is nearer to one is at it.
constexpr double kAtNode = 1e-6;

/// Between which two of `count` lines a coordinate lies, and its share of the second.
struct Between {
  int first, second;
  double share;
};

Between between(double x, double first, double step, int count) {
  double line = (x - first) / step;
  if (std::abs(line - std::round(line)) < kAtNode) line = std::round(line);
  const int last = count - 1;
  if (last == 0) return {0, 0, 0};
  if (line < 0 || line > last) return {0, last, line / last};
  const int below = std::min(static_cast<int>(line), last - 1);
  return {below, below + 1, line - below};
}

}  // namespace

template <class Real>
PinPlaces<Real>::PinPlaces(const PinRegion& region, double time, const Particles<Real>& particles) {
  const Grid& grid = particles.grid();
  const std::vector<std::size_t> nodes = nodes_of(region, grid);  // rows of equal length
  const auto stride = static_cast<std::size_t>(grid.stride);
  const std::size_t row = nodes.front() / stride, col = nodes.front() % stride;
  const int rows = static_cast<int>(nodes.back() / stride - row) + 1,
            cols = static_cast<int>(nodes.back() % stride - col) + 1;
  step_u_ = 1.0 / (grid.cols - 1);
  step_v_ = 1.0 / (grid.rows - 1);
  first_u_ = static_cast<double>(col) * step_u_;
  first_v_ = static_cast<double>(row) * step_v_;
  places_ = Particles<Real>(Grid::with_nodes(rows, cols));
  places_.place = particles.place;
  places_.mass.fill(Real(1));
  const auto from = kernels::components(particles.position);
  auto node = nodes.begin();
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c)
      set(kernels::components(places_.position), places_.grid().index(r, c), weft::at<Real>(from, *node++));
  }
  PinRegion whole = region;
  whole.u_min = whole.v_min = 0;
  whole.u_max = whole.v_max = 1;
  pins_ = Pins<Real>({whole}, time, places_);
}

template <class Real>
auto PinPlaces<Real>::stencil(double u, double v) const -> Stencil {
  const Grid& grid = places_.grid();
  const Between along = between(u, first_u_, step_u_, grid.cols),
                down = between(v, first_v_, step_v_, grid.rows);
  return {{grid.index(down.first, along.first), grid.index(down.first, along.second),
           grid.index(down.second, along.first), grid.index(down.second, along.second)},
          {(1 - down.share) * (1 - along.share), (1 - down.share) * along.share,
           down.share * (1 - along.share), down.share * along.share}};
}

template <class Real>
Vec3 PinPlaces<Real>::at(const Stencil& stencil) const {
  const auto places = kernels::components(std::as_const(places_.position));
  Vec3 sum = places_.place;
  for (std::size_t k = 0; k < 4; ++k) sum += stencil.share[k] * weft::at<Real>(places, stencil.index[k]);
  return sum;
}

template class PinPlaces<float>;
template class PinPlaces<double>;

}  // namespace weft
