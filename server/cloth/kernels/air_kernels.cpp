#include "cloth/kernels/air_kernels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cloth/core/multiversion.h"

namespace weft::kernels {
namespace {

/// Faces handled at a time; their forces stay in the first-level cache between the passes.
constexpr int kBlock = 128;

/// Twice the area vector of the face below and right of index i (its front is the sheet's), and four times
/// the mean velocity of its corners: exact factors are left to the caller.
template <class Real>
struct Face {
  Real ax, ay, az;
  Real vx, vy, vz;
};

template <class Real>
[[gnu::always_inline]] inline Face<Real> face_at(const Components<const Real>& p,
                                                 const Components<const Real>& v, std::size_t i,
                                                 std::size_t stride) {
  const std::size_t right = i + 1, below = i + stride, across = i + stride + 1;
  const Real ux = p.x[across] - p.x[i], uy = p.y[across] - p.y[i], uz = p.z[across] - p.z[i];
  const Real wx = p.x[right] - p.x[below], wy = p.y[right] - p.y[below], wz = p.z[right] - p.z[below];
  return {uy * wz - uz * wy,
          uz * wx - ux * wz,
          ux * wy - uy * wx,
          (v.x[i] + v.x[right]) + (v.x[below] + v.x[across]),
          (v.y[i] + v.y[right]) + (v.y[below] + v.y[across]),
          (v.z[i] + v.z[right]) + (v.z[below] + v.z[across])};
}

/// The air's velocity on the face below and right of index i.
template <class Real>
[[gnu::always_inline]] inline Uniform<Real> air_on_face(const Uniform<Real>& air, std::size_t, std::size_t) {
  return air;
}
[[gnu::always_inline]] inline float face_mean(const float* v, std::size_t i, std::size_t stride) {
  return ((v[i] + v[i + 1]) + (v[i + stride] + v[i + stride + 1])) * 0.25F;
}
template <class Real>
[[gnu::always_inline]] inline Uniform<Real> air_on_face(const Components<const float>& air, std::size_t i,
                                                        std::size_t stride) {
  return {face_mean(air.x, i, stride), face_mean(air.y, i, stride), face_mean(air.z, i, stride)};
}
/// kAlong: the plate's `along` is not 0.
template <bool kAlong, class Real, class Air>
[[gnu::always_inline]] inline void force_block(const Components<const Real>& p,
                                               const Components<const Real>& v, std::size_t first,
                                               std::size_t stride, int count, const Air& air,
                                               const Plate<Real>& plate, Real most_flow, Real* __restrict fx,
                                               Real* __restrict fy, Real* __restrict fz) {
  const Real smallest = std::numeric_limits<Real>::min();
  for (int c = 0; c < count; ++c) {
    const std::size_t i = first + static_cast<std::size_t>(c);
    const Face<Real> face = face_at(p, v, i, stride);
    const Uniform<Real> wind = air_on_face<Real>(air, i, stride);
    const Real wx = wind.x - face.vx * Real(0.25);
    const Real wy = wind.y - face.vy * Real(0.25);
    const Real wz = wind.z - face.vz * Real(0.25);
    const Real flow = wx * face.ax + wy * face.ay + wz * face.az;
    const Real squared = face.ax * face.ax + face.ay * face.ay + face.az * face.az;
    // (flow/2)^2 (a/2) / (|a|/2)^2 is half of flow^2 a / |a|^2, and a quarter of it goes to each corner.
    const Real size = std::abs(flow) < 2 * most_flow ? std::abs(flow) : 2 * most_flow;
    const Real scale = Real(0.125) * plate.normal * size * flow / (squared > smallest ? squared : smallest);
    fx[c] = scale * face.ax;
    fy[c] = scale * face.ay;
    fz[c] = scale * face.az;
    if constexpr (kAlong) {
      const Real wind_squared = squared * (wx * wx + wy * wy + wz * wz);
      const Real along = Real(0.125) * plate.along * size * flow * flow /
                         (wind_squared > smallest ? wind_squared : smallest);
      fx[c] += along * wx;
      fy[c] += along * wy;
      fz[c] += along * wz;
    }
  }
}

/// target[c] += what the faces left and right of node c give it, for `count` faces; `faces` has a zero before
/// and after.
template <class Real>
[[gnu::always_inline]] inline void add_to_corners(Real* __restrict target, const Real* __restrict faces,
                                                  int count) {
  for (int c = 0; c <= count; ++c) target[c] += faces[c - 1] + faces[c];
}

/// target += what the faces around each node of a row give it, for `count` faces in the row `above` and in
/// that below; each has a zero before and after. One loop: with six the force took 15 % more instructions.
template <class Real>
[[gnu::always_inline]] inline void add_to_row(Real* __restrict tx, Real* __restrict ty, Real* __restrict tz,
                                              const Components<const Real>& above,
                                              const Components<const Real>& below, int count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (int c = 0; c <= count; ++c) {
    tx[c] = (tx[c] + (above.x[c - 1] + above.x[c])) + (below.x[c - 1] + below.x[c]);
    ty[c] = (ty[c] + (above.y[c - 1] + above.y[c])) + (below.y[c - 1] + below.y[c]);
    tz[c] = (tz[c] + (above.z[c - 1] + above.z[c])) + (below.z[c - 1] + below.z[c]);
  }
}

template <bool kAlong, class Real, class Air>
[[gnu::always_inline]] inline void add_force(const Grid& grid, const Components<const Real>& p,
                                             const Components<const Real>& v, const Air& air,
                                             const Plate<Real>& plate, Real most_flow,
                                             const Components<Real>& force) {
  alignas(64) Real work[2][3][kRowAlign + kBlock + kRowAlign];
  const auto stride = static_cast<std::size_t>(grid.stride);
  for (int begin = 0; begin + 1 < grid.cols; begin += kBlock) {
    const int count = std::min(kBlock, grid.cols - 1 - begin);
    std::fill_n(work[0][0], sizeof work / sizeof(Real), Real(0));
    Components<Real> above{work[0][0] + kRowAlign, work[0][1] + kRowAlign, work[0][2] + kRowAlign};
    Components<Real> below{work[1][0] + kRowAlign, work[1][1] + kRowAlign, work[1][2] + kRowAlign};
    for (int r = 0; r < grid.rows; ++r) {
      const std::size_t first = grid.index(r, begin);
      if (r + 1 < grid.rows) {
        force_block<kAlong>(p, v, first, stride, count, air, plate, most_flow, below.x, below.y, below.z);
      } else {
        for (Real* row : {below.x, below.y, below.z}) std::fill_n(row, count, Real(0));
      }
      add_to_row<Real>(force.x + first, force.y + first, force.z + first, above, below, count);
      std::swap(above, below);
    }
  }
}

/// -dF/dv of each face's corners, see add_air_damping.
template <bool kAlong, class Real, class Air>
[[gnu::always_inline]] inline void damping_block(const Components<const Real>& p,
                                                 const Components<const Real>& v, std::size_t first,
                                                 std::size_t stride, int count, const Air& air,
                                                 const Plate<Real>& plate, const Blocks<Real>& faces) {
  const Real smallest = std::numeric_limits<Real>::min();
  WEFT_INDEPENDENT_ITERATIONS
  for (int c = 0; c < count; ++c) {
    const std::size_t i = first + static_cast<std::size_t>(c);
    const Face<Real> face = face_at(p, v, i, stride);
    const Uniform<Real> wind = air_on_face<Real>(air, i, stride);
    const Real wx = wind.x - face.vx * Real(0.25);
    const Real wy = wind.y - face.vy * Real(0.25);
    const Real wz = wind.z - face.vz * Real(0.25);
    const Real flow = wx * face.ax + wy * face.ay + wz * face.az;
    const Real squared = face.ax * face.ax + face.ay * face.ay + face.az * face.az;
    const Real scale = Real(0.25) * plate.normal * std::abs(flow) / (squared + smallest);
    faces.xx[c] = scale * face.ax * face.ax;
    faces.xy[c] = scale * face.ax * face.ay;
    faces.xz[c] = scale * face.ax * face.az;
    faces.yy[c] = scale * face.ay * face.ay;
    faces.yz[c] = scale * face.ay * face.az;
    faces.zz[c] = scale * face.az * face.az;
    if constexpr (kAlong) {
      // 2.2 |along| (w.A)^2 / (|A| |w|), a quarter of it; flow and area are twice theirs.
      const Real wind_squared = squared * (wx * wx + wy * wy + wz * wz);
      const Real all_ways =
          Real(0.275) * std::abs(plate.along) * flow * flow / std::sqrt(wind_squared + smallest);
      faces.xx[c] += all_ways;
      faces.yy[c] += all_ways;
      faces.zz[c] += all_ways;
    }
  }
}

template <bool kAlong, class Real, class Air>
[[gnu::always_inline]] inline void add_damping(const Grid& grid, const Components<const Real>& p,
                                               const Components<const Real>& v, const Air& air,
                                               const Plate<Real>& plate, const Blocks<Real>& damping) {
  alignas(64) Real work[6][kRowAlign + kBlock + kRowAlign] = {};
  const Blocks<Real> faces{work[0] + kRowAlign, work[1] + kRowAlign, work[2] + kRowAlign,
                           work[3] + kRowAlign, work[4] + kRowAlign, work[5] + kRowAlign};
  const auto stride = static_cast<std::size_t>(grid.stride);
  for (int begin = 0; begin + 1 < grid.cols; begin += kBlock) {
    const int count = std::min(kBlock, grid.cols - 1 - begin);
    for (auto& row : work) row[kRowAlign + count] = Real(0);
    for (int r = 0; r + 1 < grid.rows; ++r) {
      const std::size_t first = grid.index(r, begin);
      damping_block<kAlong>(p, v, first, stride, count, air, plate, faces);
      for (const std::size_t row : {first, first + stride}) {
        add_to_corners(damping.xx + row, faces.xx, count);
        add_to_corners(damping.xy + row, faces.xy, count);
        add_to_corners(damping.xz + row, faces.xz, count);
        add_to_corners(damping.yy + row, faces.yy, count);
        add_to_corners(damping.yz + row, faces.yz, count);
        add_to_corners(damping.zz + row, faces.zz, count);
      }
    }
  }
}

template <class Real, class Air>
[[gnu::always_inline]] inline Real max_flow(const Grid& grid, const Components<const Real>& p,
                                            const Components<const Real>& v, const Air& air) {
  // One running maximum per lane: a single one would have to be compared in order.
  alignas(64) Real most[kBlock] = {};
  const auto stride = static_cast<std::size_t>(grid.stride);
  for (int r = 0; r + 1 < grid.rows; ++r) {
    for (int begin = 0; begin + 1 < grid.cols; begin += kBlock) {
      const int count = std::min(kBlock, grid.cols - 1 - begin);
      const std::size_t first = grid.index(r, begin);
      for (int c = 0; c < count; ++c) {
        const std::size_t i = first + static_cast<std::size_t>(c);
        const Face<Real> face = face_at(p, v, i, stride);
        const Uniform<Real> wind = air_on_face<Real>(air, i, stride);
        const Real flow =
            std::abs((wind.x - face.vx * Real(0.25)) * face.ax + (wind.y - face.vy * Real(0.25)) * face.ay +
                     (wind.z - face.vz * Real(0.25)) * face.az);
        most[c] = flow > most[c] ? flow : most[c];
      }
    }
  }
  return Real(0.5) * *std::max_element(most, most + kBlock);
}

}  // namespace

// target_clones needs each function written out. NOLINTBEGIN(bugprone-macro-parentheses): they are types
#define WEFT_AIR_KERNELS(Real, Air)                                                                        \
  template <>                                                                                              \
  WEFT_MULTIVERSION void add_air_force(const Grid& grid, Components<const Real> position,                  \
                                       Components<const Real> velocity, const Air& air,                    \
                                       const Plate<Real>& plate, Real most_flow, Components<Real> force) { \
    if (plate.along == 0) {                                                                                \
      add_force<false, Real, Air>(grid, position, velocity, air, plate, most_flow, force);                 \
    } else {                                                                                               \
      add_force<true, Real, Air>(grid, position, velocity, air, plate, most_flow, force);                  \
    }                                                                                                      \
  }                                                                                                        \
  template <>                                                                                              \
  WEFT_MULTIVERSION void add_air_damping(const Grid& grid, Components<const Real> position,                \
                                         Components<const Real> velocity, const Air& air,                  \
                                         const Plate<Real>& plate, const Blocks<Real>& damping) {          \
    if (plate.along == 0) {                                                                                \
      add_damping<false, Real, Air>(grid, position, velocity, air, plate, damping);                        \
    } else {                                                                                               \
      add_damping<true, Real, Air>(grid, position, velocity, air, plate, damping);                         \
    }                                                                                                      \
  }                                                                                                        \
  template <>                                                                                              \
  WEFT_MULTIVERSION Real max_air_flow(const Grid& grid, Components<const Real> position,                   \
                                      Components<const Real> velocity, const Air& air) {                   \
    return max_flow<Real, Air>(grid, position, velocity, air);                                             \
  }

WEFT_AIR_KERNELS(float, Uniform<float>)
WEFT_AIR_KERNELS(double, Uniform<double>)
WEFT_AIR_KERNELS(float, Components<const float>)
WEFT_AIR_KERNELS(double, Components<const float>)
#undef WEFT_AIR_KERNELS
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace weft::kernels
