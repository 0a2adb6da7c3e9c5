#include "cloth/contact/recovery/untangling.h"

#include <cmath>

namespace weft {
namespace {

/// The direction in which the triangle beside the edge leads away from it in the plane of normal `across`;
/// zero where they lie in one plane.
Vec3 inwards(const Vec3& along, const Vec3& to_third, const Vec3& across) {
  const Vec3 line = across.cross(along.cross(to_third));
  const double length = line.norm();
  if (!(length > 1e-9 * to_third.norm())) return Vec3::Zero();
  const Vec3 inner = to_third - to_third.dot(along) * along;
  return line.dot(inner) > 0 ? Vec3(line / length) : Vec3(-line / length);
}

/// Of the length of the line of intersection, by the edge's move against the triangle, downwards.
Vec3 shortening(const Crossing& crossing, const std::vector<Vec3>& x, const Vec3& normal) {
  const Vec3 &p = x[crossing.edge[0]], along = (x[crossing.edge[1]] - p).normalized();
  const double steepness = along.dot(normal);
  const bool rim = crossing.across[0] == crossing.across[1];
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < (rim ? 1U : 2U); ++i) {
    const Vec3 line = inwards(along, x[crossing.across[i]] - p, normal);
    sum += line;
    if (steepness != 0) sum -= 2 * along.dot(line) / steepness * normal;
  }
  return sum;
}

}  // namespace

std::vector<Vec3> untangling_moves(const std::vector<Crossing>& crossings, const LayerNodes& nodes,
                                   double longest) {
  const std::vector<Vec3>& x = nodes.start;
  std::vector<Vec3> moves(x.size(), Vec3(0, 0, 0));
  std::vector<double> shares(x.size(), 0.0);
  for (const Crossing& crossing : crossings) {
    const auto [a, b, c] = crossing.triangle;
    const auto [p, q] = crossing.edge;
    const Vec3 face = (x[b] - x[a]).cross(x[c] - x[a]);
    const double area = face.norm();
    if (area == 0) continue;
    const Vec3 normal = face / area;
    const Vec3 way = shortening(crossing, x, normal);
    if (!way.allFinite()) continue;
    // Where they cross: of the edge, and of the triangle.
    const double below = normal.dot(x[a] - x[p]), whole = normal.dot(x[q] - x[p]);
    const double s = whole != 0 ? below / whole : 0.5;
    const Vec3 place = x[p] + s * (x[q] - x[p]);
    const double wb = (place - x[a]).cross(x[c] - x[a]).dot(normal) / area,
                 wc = (x[b] - x[a]).cross(place - x[a]).dot(normal) / area;
    const std::array<std::uint32_t, 5> node{p, q, a, b, c};
    const std::array<double, 5> weight{1 - s, s, wb + wc - 1, -wb, -wc};
    double share = 0;
    for (std::size_t i = 0; i < 5; ++i) share += weight[i] * weight[i] * nodes.inverse_mass[node[i]];
    if (!(share > 0)) continue;
    const Vec3 move = longest / std::sqrt(1 + way.squaredNorm()) / share * way;
    for (std::size_t i = 0; i < 5; ++i) {
      const double part = weight[i] * nodes.inverse_mass[node[i]];
      moves[node[i]] += part * move;
      shares[node[i]] += std::abs(part) / share;
    }
  }
  for (std::size_t i = 0; i < moves.size(); ++i) {
    if (shares[i] > 1) moves[i] /= shares[i];
    const double length = moves[i].norm();
    if (length > longest) moves[i] *= longest / length;
  }
  return moves;
}

}  // namespace weft
