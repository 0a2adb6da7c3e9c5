#include "cloth/kernels/contact_kernels.h"

#include <bit>
#include <type_traits>

#include "cloth/core/multiversion.h"

namespace weft::kernels {
namespace {

/// Bit r for each row with a node that `inside` (0 or 1, as wide as the doubles compared) finds.
template <class Real, class Inside>
[[gnu::always_inline]] inline std::uint32_t rows_where(const NodeBlock<Real>& block, Inside inside) {
  std::uint32_t result = 0;
  for (int r = 0; r < block.rows; ++r) {
    const std::size_t first = static_cast<std::size_t>(r) * static_cast<std::size_t>(block.stride);
    std::int64_t any = 0;
    for (int c = 0; c < block.cols; ++c) any |= inside(first + static_cast<std::size_t>(c));
    result |= static_cast<std::uint32_t>(any) << r;
  }
  return result;
}

template <class Real>
[[gnu::always_inline]] inline std::uint32_t rows_inside_any(const NodeBlock<Real>& block,
                                                            const Sphere& ball) {
  const Real *x = block.position.x, *y = block.position.y, *z = block.position.z;
  return rows_where(block, [=](std::size_t i) WEFT_INLINE_LAMBDA -> std::int64_t {
    const double dx = static_cast<double>(x[i]) - ball.x;
    const double dy = static_cast<double>(y[i]) - ball.y;
    const double dz = static_cast<double>(z[i]) - ball.z;
    return dx * dx + dy * dy + dz * dz < ball.squared_radius ? 1 : 0;
  });
}

template <class Real>
[[gnu::always_inline]] inline std::uint32_t rows_wider_any(const NodeBlock<Real>& block, double square) {
  const Real *x = block.position.x, *y = block.position.y, *z = block.position.z;
  const auto below = static_cast<std::size_t>(block.stride);
  return rows_where(block, [=](std::size_t i) WEFT_INLINE_LAMBDA -> std::int64_t {
    const auto apart = [=](std::size_t a, std::size_t b) WEFT_INLINE_LAMBDA {
      const double dx = static_cast<double>(x[a]) - static_cast<double>(x[b]);
      const double dy = static_cast<double>(y[a]) - static_cast<double>(y[b]);
      const double dz = static_cast<double>(z[a]) - static_cast<double>(z[b]);
      return dx * dx + dy * dy + dz * dz;
    };
    return apart(i, i + below + 1) > square || apart(i + 1, i + below) > square ? 1 : 0;
  });
}

/// The point's height over the plane.
template <class Real>
[[gnu::always_inline]] inline double height(const Below& plane, Real x, Real y, Real z) {
  return static_cast<double>(x) * plane.nx + static_cast<double>(y) * plane.ny +
         static_cast<double>(z) * plane.nz - plane.offset;
}

template <class Real>
[[gnu::always_inline]] inline std::uint32_t rows_inside_any(const NodeBlock<Real>& block,
                                                            const Below& half_space) {
  const Real *x = block.position.x, *y = block.position.y, *z = block.position.z;
  return rows_where(block, [=](std::size_t i) WEFT_INLINE_LAMBDA -> std::int64_t {
    return height(half_space, x[i], y[i], z[i]) < 0 ? 1 : 0;
  });
}

template <class Real>
[[gnu::always_inline]] inline std::uint32_t rows_inside_any(const NodeBlock<Real>& block,
                                                            const OrientedBox& box) {
  const Real *x = block.position.x, *y = block.position.y, *z = block.position.z;
  return rows_where(block, [=](std::size_t i) WEFT_INLINE_LAMBDA -> std::int64_t {
    std::int64_t within = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double along = height(box.axis[axis], x[i], y[i], z[i]);
      within &= along < box.half[axis] && along > -box.half[axis] ? 1 : 0;
    }
    return within;
  });
}

template <class Real>
[[gnu::always_inline]] inline std::uint32_t rows_inside_any(const NodeBlock<Real>& block,
                                                            const Stretch& capsule) {
  const Real *x = block.position.x, *y = block.position.y, *z = block.position.z;
  const Vector &start = capsule.start, &axis = capsule.axis;
  return rows_where(block, [=](std::size_t i) WEFT_INLINE_LAMBDA -> std::int64_t {
    const double dx = static_cast<double>(x[i]) - start.x;
    const double dy = static_cast<double>(y[i]) - start.y;
    const double dz = static_cast<double>(z[i]) - start.z;
    double along = dx * axis.x + dy * axis.y + dz * axis.z;
    along = along > 0 ? along : 0.0;
    along = along < capsule.length ? along : capsule.length;
    const double nx = dx - along * axis.x, ny = dy - along * axis.y, nz = dz - along * axis.z;
    return nx * nx + ny * ny + nz * nz < capsule.squared_radius ? 1 : 0;
  });
}

template <class Real>
[[gnu::always_inline]] inline std::uint32_t rows_swept_any(const NodeBlock<Real>& block,
                                                           const BlockWay<Real>& way, const Vector& move,
                                                           const Sphere& ball) {
  const Real *x = block.position.x, *y = block.position.y, *z = block.position.z;
  const Real *ox = way.other.x, *oy = way.other.y, *oz = way.other.z;
  const double own = static_cast<double>(way.own), factor = static_cast<double>(way.factor);
  return rows_where(block, [=](std::size_t i) WEFT_INLINE_LAMBDA -> std::int64_t {
    const double px = static_cast<double>(x[i]), py = static_cast<double>(y[i]),
                 pz = static_cast<double>(z[i]);
    // From the centre to the way's begin; the way.
    const double bx = own * px + factor * static_cast<double>(ox[i]) + move.x - ball.x;
    const double by = own * py + factor * static_cast<double>(oy[i]) + move.y - ball.y;
    const double bz = own * pz + factor * static_cast<double>(oz[i]) + move.z - ball.z;
    const double wx = px - ball.x - bx, wy = py - ball.y - by, wz = pz - ball.z - bz;
    // Nearest to the centre: at 0 <= t <= 1 of the way.
    const double length = wx * wx + wy * wy + wz * wz;
    const double closer = -(bx * wx + by * wy + bz * wz);
    double t = closer / (length > 0 ? length : 1.0);
    t = t > 0 ? t : 0.0;
    t = t < 1 ? t : 1.0;
    const double nx = bx + t * wx, ny = by + t * wy, nz = bz + t * wz;
    return nx * nx + ny * ny + nz * nz < ball.squared_radius ? 1 : 0;
  });
}

template <class Real>
[[gnu::always_inline]] inline double largest_square_any(const Components<const Real>& a,
                                                        const Components<const Real>& b, Real own,
                                                        Real factor, std::size_t count) {
  const Real* __restrict ax = a.x;
  const Real* __restrict ay = a.y;
  const Real* __restrict az = a.z;
  const Real* __restrict bx = b.x;
  const Real* __restrict by = b.y;
  const Real* __restrict bz = b.z;
  // Not below 0: ordered as their bits, whose maximum the compiler vectorises (state_kernels.cpp).
  using Bits = std::conditional_t<sizeof(Real) == sizeof(std::uint32_t), std::uint32_t, std::uint64_t>;
  Bits largest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Real x = own * ax[i] + factor * bx[i], y = own * ay[i] + factor * by[i],
               z = own * az[i] + factor * bz[i];
    const Bits square = std::bit_cast<Bits>(x * x + y * y + z * z);
    largest = square > largest ? square : largest;
  }
  return static_cast<double>(std::bit_cast<Real>(largest));
}

}  // namespace

WEFT_MULTIVERSION std::uint32_t rows_inside(const NodeBlock<float>& block, const Sphere& ball) {
  return rows_inside_any(block, ball);
}
WEFT_MULTIVERSION std::uint32_t rows_inside(const NodeBlock<double>& block, const Sphere& ball) {
  return rows_inside_any(block, ball);
}

WEFT_MULTIVERSION std::uint32_t rows_inside(const NodeBlock<float>& block, const Below& half_space) {
  return rows_inside_any(block, half_space);
}
WEFT_MULTIVERSION std::uint32_t rows_inside(const NodeBlock<double>& block, const Below& half_space) {
  return rows_inside_any(block, half_space);
}

WEFT_MULTIVERSION std::uint32_t rows_inside(const NodeBlock<float>& block, const OrientedBox& box) {
  return rows_inside_any(block, box);
}
WEFT_MULTIVERSION std::uint32_t rows_inside(const NodeBlock<double>& block, const OrientedBox& box) {
  return rows_inside_any(block, box);
}

WEFT_MULTIVERSION std::uint32_t rows_inside(const NodeBlock<float>& block, const Stretch& capsule) {
  return rows_inside_any(block, capsule);
}
WEFT_MULTIVERSION std::uint32_t rows_inside(const NodeBlock<double>& block, const Stretch& capsule) {
  return rows_inside_any(block, capsule);
}
WEFT_MULTIVERSION std::uint32_t rows_wider(const NodeBlock<float>& block, double square) {
  return rows_wider_any(block, square);
}
WEFT_MULTIVERSION std::uint32_t rows_wider(const NodeBlock<double>& block, double square) {
  return rows_wider_any(block, square);
}
WEFT_MULTIVERSION std::uint32_t rows_swept(const NodeBlock<float>& block, const BlockWay<float>& way,
                                           const Vector& move, const Sphere& ball) {
  return rows_swept_any(block, way, move, ball);
}
WEFT_MULTIVERSION std::uint32_t rows_swept(const NodeBlock<double>& block, const BlockWay<double>& way,
                                           const Vector& move, const Sphere& ball) {
  return rows_swept_any(block, way, move, ball);
}

WEFT_MULTIVERSION double largest_square(Components<const float> a, Components<const float> b, float own,
                                        float factor, std::size_t count) {
  return largest_square_any(a, b, own, factor, count);
}
WEFT_MULTIVERSION double largest_square(Components<const double> a, Components<const double> b, double own,
                                        double factor, std::size_t count) {
  return largest_square_any(a, b, own, factor, count);
}

}  // namespace weft::kernels
