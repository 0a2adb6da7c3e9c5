#pragma once
#include <cstdint>

#include "cloth/kernels/components.h"

namespace weft::kernels {

/// The largest |own a + factor b|^2 of `count` nodes.
double largest_square(Components<const float> a, Components<const float> b, float own, float factor,
                      std::size_t count);
double largest_square(Components<const double> a, Components<const double> b, double own, double factor,
                      std::size_t count);

/// A block of at most 32 rows; `position` is its first node, a row is `stride` further.
template <class Real>
struct NodeBlock {
  Components<const Real> position;
  int rows, stride, cols;
};

// Solids are in double whatever the nodes' precision.

struct Vector {
  double x, y, z;
};
/// A ball.
struct Sphere {
  double x, y, z;
  double squared_radius;
};
/// The points below a plane: x nx + y ny + z nz < offset.
struct Below {
  double nx, ny, nz;
  double offset;
};
/// The points within half[i] of offset along each of the unit vectors axis[i].
struct OrientedBox {
  Below axis[3];
  double half[3];
};

/// The points near the stretch from `start` along the unit vector `axis`.
struct Stretch {
  Vector start, axis;
  double length;
  double squared_radius;
};

/// Which of a block's rows have a node inside: bit r for row r.
std::uint32_t rows_inside(const NodeBlock<float>& block, const Sphere& ball);
std::uint32_t rows_inside(const NodeBlock<double>& block, const Sphere& ball);
std::uint32_t rows_inside(const NodeBlock<float>& block, const Below& half_space);
std::uint32_t rows_inside(const NodeBlock<double>& block, const Below& half_space);
std::uint32_t rows_inside(const NodeBlock<float>& block, const OrientedBox& box);
std::uint32_t rows_inside(const NodeBlock<double>& block, const OrientedBox& box);
std::uint32_t rows_inside(const NodeBlock<float>& block, const Stretch& capsule);
std::uint32_t rows_inside(const NodeBlock<double>& block, const Stretch& capsule);

/// Which of a block's rows have a cell with a diagonal whose square, m2, is more: bit r for the cells that
/// begin at row r. The nodes right of and below the block are read, too.
std::uint32_t rows_wider(const NodeBlock<float>& block, double square);
std::uint32_t rows_wider(const NodeBlock<double>& block, double square);

/// Where a block's nodes come from: own * position + factor * other.
template <class Real>
struct BlockWay {
  Components<const Real> other;
  Real own, factor;
};
/// Which of a block's rows have a node whose way, as seen from the ball, which makes a `move` of its own,
/// leads through it.
std::uint32_t rows_swept(const NodeBlock<float>& block, const BlockWay<float>& way, const Vector& move,
                         const Sphere& ball);
std::uint32_t rows_swept(const NodeBlock<double>& block, const BlockWay<double>& way, const Vector& move,
                         const Sphere& ball);

}  // namespace weft::kernels
