#include "cloth/kernels/plate_projection_kernels.h"

#include <array>
#include <cstddef>

#include "cloth/core/multiversion.h"

namespace weft::kernels {
namespace {

/// The stiffnesses' places in a row of lanes.
constexpr std::size_t kAlongU = 0, kAlongV = 1, kTwist = 2, kStencils = 3;
constexpr int kGroup = 8;

constexpr int round_up(int n, int to) { return (n + to - 1) / to * to; }

/// What a stencil takes its nodes by: three in line, or a cell's corners.
constexpr std::array<int, 3> kDifference{1, -2, 1};
constexpr std::array<int, 4> kCorners{1, -1, -1, 1};

/// Projects `count` stencils, the first of them on the lanes node[0], node[1], ...; no lane is met twice.
template <class Real, std::size_t nodes>
[[gnu::always_inline]] inline void project_run(const std::array<int, nodes>& a,
                                               const std::array<Real*, nodes>& node,
                                               const Real* __restrict stiffness, std::size_t stride,
                                               int count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (int i = 0; i < count; ++i) {
    Real x = 0, y = 0, z = 0, weight = 0;
    for (std::size_t n = 0; n < nodes; ++n) {
      const Real* at = node[n] + i;
      const Real* moved = at + QuarterRows::kMove * stride;
      const Real factor = static_cast<Real>(a[n]);
      x += factor * (at[0] + moved[0]);
      y += factor * (at[stride] + moved[stride]);
      z += factor * (at[2 * stride] + moved[2 * stride]);
      weight += factor * factor * at[QuarterRows::kInverseMass * stride];
    }
    const Real k = stiffness[i];
    const Real share = -k / (1 + k * weight);
    for (std::size_t n = 0; n < nodes; ++n) {
      Real* moved = node[n] + i + QuarterRows::kMove * stride;
      const Real factor = static_cast<Real>(a[n]) * share *
                          node[n][static_cast<std::size_t>(i) + QuarterRows::kInverseMass * stride];
      moved[0] += factor * x;
      moved[stride] += factor * y;
      moved[2 * stride] += factor * z;
    }
  }
}

template <class Real>
[[gnu::always_inline]] inline void project_any(const QuarterRows& layout, const Real* plate, Real* sheet) {
  const std::size_t stride = layout.stride, row_size = layout.row_size();
  const int whole_row = round_up(4 * layout.width + 1, kGroup);
  const auto row = [&](int r) { return sheet + static_cast<std::size_t>(r) * row_size; };
  const auto stiffness = [&](int r, std::size_t kind) {
    return plate + (static_cast<std::size_t>(r) * kStencils + kind) * stride;
  };
  for (int r = 0; r < layout.rows; ++r) {
    // The stencils on every fourth column do not meet: four colours.
    for (int col = 1; col <= 4; ++col) {
      project_run<Real, 3>(
          kDifference,
          {row(r) + layout.lane(col - 1), row(r) + layout.lane(col), row(r) + layout.lane(col + 1)},
          stiffness(r, kAlongU) + layout.lane(col), stride, layout.width);
    }
  }
  for (int colour = 0; colour < 3; ++colour) {
    for (int r = 1 + colour; r + 1 < layout.rows; r += 3) {
      project_run<Real, 3>(kDifference, {row(r - 1), row(r), row(r + 1)}, stiffness(r, kAlongV), stride,
                           whole_row);
    }
  }
  for (int colour = 0; colour < 2; ++colour) {
    for (int r = colour; r + 1 < layout.rows; r += 2) {
      for (const int col : {0, 2, 1, 3}) {
        const int left = layout.lane(col), right = layout.lane(col + 1);
        project_run<Real, 4>(kCorners, {row(r) + left, row(r) + right, row(r + 1) + left, row(r + 1) + right},
                             stiffness(r, kTwist) + left, stride, layout.width);
      }
    }
  }
}

template <class Real>
void set_any(const QuarterRows& layout, const Grid& grid, const PlateStencils<Real>& plate, Real h_squared,
             Real* lanes) {
  const std::array<const Real*, kStencils> kinds{plate.u, plate.v, plate.twist};
  for (int r = 0; r < grid.rows; ++r) {
    for (const Real* kind : kinds) {
      for (int c = 0; c < grid.cols; ++c) lanes[layout.lane(c)] = h_squared * kind[grid.index(r, c)];
      lanes += layout.stride;
    }
  }
}

}  // namespace

std::size_t plate_lanes_size(const QuarterRows& layout) {
  return static_cast<std::size_t>(layout.rows) * kStencils * layout.stride;
}

void set_plate_lanes(const QuarterRows& layout, const Grid& grid, const PlateStencils<float>& plate,
                     float h_squared, float* lanes) {
  set_any(layout, grid, plate, h_squared, lanes);
}
void set_plate_lanes(const QuarterRows& layout, const Grid& grid, const PlateStencils<double>& plate,
                     double h_squared, double* lanes) {
  set_any(layout, grid, plate, h_squared, lanes);
}

WEFT_MULTIVERSION void project_plate(const QuarterRows& layout, const float* plate_lanes, float* sheet) {
  project_any<float>(layout, plate_lanes, sheet);
}
WEFT_MULTIVERSION void project_plate(const QuarterRows& layout, const double* plate_lanes, double* sheet) {
  project_any<double>(layout, plate_lanes, sheet);
}

}  // namespace weft::kernels
