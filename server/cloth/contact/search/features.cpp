#include "cloth/contact/search/features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace weft {
namespace {

/// Steps of conservative advancement after which features that creep up on each other count as touching. Of
/// five million random pairs (moved by 0.01 to 100 times their size) 10 take all of them; 64 would be too few
/// for 350.
constexpr int kMostSteps = 256;
/// What features that are very near keep of their distance.
constexpr double kLeastPart = 0.9;

Nearness weighted(const std::array<double, 4>& weight, const FourPoints& p) {
  return {weight, weight[0] * p[0] + weight[1] * p[1] + weight[2] * p[2] + weight[3] * p[3]};
}

/// Barycentric coordinates of the triangle's point nearest to p[0].
Nearness node_triangle(const FourPoints& p) {
  const Vec3 ab = p[2] - p[1], ac = p[3] - p[1], ap = p[0] - p[1];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return weighted({1, -1, 0, 0}, p);
  const Vec3 bp = p[0] - p[2];
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return weighted({1, 0, -1, 0}, p);
  const Vec3 cp = p[0] - p[3];
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return weighted({1, 0, 0, -1}, p);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double v = d1 / (d1 - d3);
    return weighted({1, v - 1, -v, 0}, p);
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double w = d2 / (d2 - d6);
    return weighted({1, w - 1, 0, -w}, p);
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return weighted({1, 0, w - 1, -w}, p);
  }
  const double sum = va + vb + vc;
  const double v = vb / sum, w = vc / sum;
  return weighted({1, v + w - 1, -v, -w}, p);
}

double share(double part, double whole) { return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0; }

Nearness edge_edge(const FourPoints& p) {
  const Vec3 d1 = p[1] - p[0], d2 = p[3] - p[2], r = p[0] - p[2];
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), b = d1.dot(d2), c = d1.dot(r), f = d2.dot(r);
  double s = share(b * f - c * e, a * e - b * b);
  double t = e > 0 ? (b * s + f) / e : 0.0;
  if (t < 0) {
    t = 0;
    s = share(-c, a);
  } else if (t > 1) {
    t = 1;
    s = share(b - c, a);
  } else if (!(e > 0)) {
    s = share(-c, a);
  }
  return weighted({1 - s, s, t - 1, -t}, p);
}

/// For how long features that move so lie at least `distance` apart along `way`, which leads from the second
/// one to the first. Infinity if they do for ever.
double time_apart(FeaturePair::Kind kind, const FourPoints& points, const FourPoints& move, const Vec3& way,
                  double distance) {
  double time = std::numeric_limits<double>::infinity();
  const std::size_t first_nodes = kind == FeaturePair::Kind::node_triangle ? 1 : 2;
  for (std::size_t i = 0; i < first_nodes; ++i) {
    for (std::size_t j = first_nodes; j < 4; ++j) {
      const double approach = way.dot(move[j] - move[i]);
      if (approach > 0) time = std::min(time, (way.dot(points[i] - points[j]) - distance) / approach);
    }
  }
  return time;
}

double longest(const Vec3& a, const Vec3& b) { return std::sqrt(std::max(a.squaredNorm(), b.squaredNorm())); }

}  // namespace

Nearness nearness(FeaturePair::Kind kind, const FourPoints& points) {
  return kind == FeaturePair::Kind::node_triangle ? node_triangle(points) : edge_edge(points);
}

Vec3 contact_normal(FeaturePair::Kind kind, const FourPoints& points, const Nearness& near) {
  const double distance = near.apart.norm();
  if (distance == 0) return Vec3::Zero();
  if (kind == FeaturePair::Kind::node_triangle) {
    const Vec3 normal = (points[2] - points[1]).cross(points[3] - points[1]).normalized();
    const double height = normal.dot(near.apart);
    if (std::abs(height) > std::numbers::sqrt2 / 2 * distance) return height > 0 ? normal : Vec3(-normal);
  }
  return near.apart / distance;
}

double reach(FeaturePair::Kind kind, const FourPoints& move) {
  const Vec3 common = (move[0] + move[1] + move[2] + move[3]) / 4;
  const FourPoints way{move[0] - common, move[1] - common, move[2] - common, move[3] - common};
  return kind == FeaturePair::Kind::node_triangle
             ? way[0].norm() + std::max(longest(way[1], way[2]), way[3].norm())
             : longest(way[0], way[1]) + longest(way[2], way[3]);
}

std::optional<double> first_contact(FeaturePair::Kind kind, double distance, const FourPoints& start,
                                    const FourPoints& move, double gap) {
  const double least = std::min(gap, kLeastPart * distance);
  const double near = std::min(1.5 * gap, (1 + kLeastPart) / 2 * distance);
  if (distance - reach(kind, move) > near) return std::nullopt;
  double time = 0;
  FourPoints points = start;
  Vec3 apart = nearness(kind, start).apart;
  for (int step = 0; step < kMostSteps && apart.norm() > near; ++step) {
    time += time_apart(kind, points, move, apart.normalized(), (least + near) / 2);
    if (time > 1) return std::nullopt;
    for (std::size_t i = 0; i < 4; ++i) points[i] = start[i] + time * move[i];
    apart = nearness(kind, points).apart;
  }
  return time;
}

}  // namespace weft
