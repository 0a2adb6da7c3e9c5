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
  const int last = count - 1;
  double line = std::clamp((x - first) / step, 0.0, static_cast<double>(last));
  if (std::abs(line - std::round(line)) < kAtNode) line = std::round(line);
  const int below = static_cast<int>(line);
  return {below, std::min(below + 1, last), line - below};
}

}  // namespace

template <class Real>
PinPlaces::PinPlaces(const PinRegion& region, double time, const Particles<Real>& particles) {
  const Grid& grid = particles.grid();
  const std::vector<std::size_t> nodes = nodes_of(region, grid);  // rows of equal length
  const auto stride = static_cast<std::size_t>(grid.stride);
  // With one more on each side finer levels' nodes in the region lie between these.
  const int top = std::max(static_cast<int>(nodes.front() / stride) - 1, 0),
            left = std::max(static_cast<int>(nodes.front() % stride) - 1, 0);
  const int bottom = std::min(static_cast<int>(nodes.back() / stride) + 1, grid.rows - 1),
            right = std::min(static_cast<int>(nodes.back() % stride) + 1, grid.cols - 1);
  step_u_ = 1.0 / (grid.cols - 1);
  step_v_ = 1.0 / (grid.rows - 1);
  first_u_ = left * step_u_;
  first_v_ = top * step_v_;
  places_ = Particles<double>(Grid::with_nodes(bottom - top + 1, right - left + 1));
  places_.mass.fill(1);
  for (int r = top; r <= bottom; ++r) {
    for (int c = left; c <= right; ++c) {
      set(kernels::components(places_.position), places_.grid().index(r - top, c - left),
          particles.position_at(r, c));
    }
  }
  PinRegion whole = region;
  whole.u_min = whole.v_min = 0;
  whole.u_max = whole.v_max = 1;
  pins_ = Pins<double>({whole}, time, places_);
}

auto PinPlaces::stencil(double u, double v) const -> Stencil {
  const Grid& grid = places_.grid();
  const Between along = between(u, first_u_, step_u_, grid.cols),
                down = between(v, first_v_, step_v_, grid.rows);
  return {{grid.index(down.first, along.first), grid.index(down.first, along.second),
           grid.index(down.second, along.first), grid.index(down.second, along.second)},
          {(1 - down.share) * (1 - along.share), (1 - down.share) * along.share,
           down.share * (1 - along.share), down.share * along.share}};
}

Vec3 PinPlaces::at(const Stencil& stencil) const {
  const auto places = kernels::components(std::as_const(places_.position));
  Vec3 sum = places_.place;
  for (std::size_t k = 0; k < 4; ++k) sum += stencil.share[k] * weft::at<double>(places, stencil.index[k]);
  return sum;
}

template PinPlaces::PinPlaces(const PinRegion&, double, const Particles<float>&);
template PinPlaces::PinPlaces(const PinRegion&, double, const Particles<double>&);

}  // namespace weft
