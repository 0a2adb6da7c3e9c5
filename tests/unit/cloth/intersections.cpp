#include "intersections.h"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>
#include <numeric>

namespace weft::test {
namespace {

template <class Number>
Number determinant(const std::array<std::array<Number, 3>, 3>& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// On which side of the plane through a, b, c the point d lies: -1, 0 or 1.
int side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  std::array<std::array<double, 3>, 3> m{};
  double largest = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<int>(i);
    m[0][i] = a[k] - d[k];
    m[1][i] = b[k] - d[k];
    m[2][i] = c[k] - d[k];
  }
  for (const auto& row : m) {
    largest *= std::max({std::abs(row[0]), std::abs(row[1]), std::abs(row[2])});
  }
  const double value = determinant(m);
  // Six products of three entries, each entry, product and sum rounded: far below 64 roundings of the
  // largest.
  if (std::abs(value) > 64 * 6 * std::numeric_limits<double>::epsilon() * largest) return value > 0 ? 1 : -1;
  using boost::multiprecision::cpp_rational;
  std::array<std::array<cpp_rational, 3>, 3> exact;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<int>(i);
    exact[0][i] = cpp_rational(a[k]) - cpp_rational(d[k]);
    exact[1][i] = cpp_rational(b[k]) - cpp_rational(d[k]);
    exact[2][i] = cpp_rational(c[k]) - cpp_rational(d[k]);
  }
  return determinant(exact).sign();
}

}  // namespace

bool crosses(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  if (side(a, b, c, p) * side(a, b, c, q) >= 0) return false;
  const int ab = side(p, q, a, b), bc = side(p, q, b, c), ca = side(p, q, c, a);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

int count_intersections(const TriangleSoup& soup) {
  const auto& x = soup.points;
  // Sweep along x: a triangle is compared with those that begin before it ends.
  const auto low = [&](const Triangle& t, int k) {
    return std::min({x[t.node[0]][k], x[t.node[1]][k], x[t.node[2]][k]});
  };
  const auto high = [&](const Triangle& t, int k) {
    return std::max({x[t.node[0]][k], x[t.node[1]][k], x[t.node[2]][k]});
  };
  std::vector<Triangle> sorted = soup.triangles;
  std::sort(sorted.begin(), sorted.end(),
            [&](const Triangle& a, const Triangle& b) { return low(a, 0) < low(b, 0); });
  const auto edges_cross = [&](const Triangle& s, const Triangle& t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t p = s.node[i], q = s.node[(i + 1) % 3];
      const auto shared = [&](std::size_t n) { return n == p || n == q; };
      if (std::any_of(t.node.begin(), t.node.end(), shared)) continue;
      if (crosses(x[p], x[q], x[t.node[0]], x[t.node[1]], x[t.node[2]])) return true;
    }
    return false;
  };
  int count = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const Triangle& s = sorted[i];
    const double end = high(s, 0);
    for (std::size_t j = i + 1; j < sorted.size() && low(sorted[j], 0) <= end; ++j) {
      const Triangle& t = sorted[j];
      if (low(t, 1) > high(s, 1) || low(s, 1) > high(t, 1) || low(t, 2) > high(s, 2) ||
          low(s, 2) > high(t, 2))
        continue;
      if (edges_cross(s, t) || edges_cross(t, s)) ++count;
    }
  }
  return count;
}

}  // namespace weft::test
