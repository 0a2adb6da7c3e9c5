#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "cloth/core/vec3.h"

namespace weft {

/// Two features of the cloths' triangles that may touch: a node and a triangle, or two edges.
struct FeaturePair {
  enum class Kind : std::uint8_t { node_triangle, edge_edge };
  Kind kind = Kind::node_triangle;
  /// The node and the triangle's three, or the first edge's two and the second one's: indices into
  /// LayerNodes.
  std::array<std::uint32_t, 4> node{};
  double distance = 0;  ///< as the step begins, m
  template <class Archive>
  void serialize(Archive& archive) {
    archive(kind, node, distance);
  }
};

using FourPoints = std::array<Vec3, 4>;

/// How near two features are.
struct Nearness {
  /// Of the nodes, so that sum of weight_i x_i leads from the second feature's nearest point to the first's:
  /// barycentric, the second's negative; their sum is 0.
  std::array<double, 4> weight{};
  Vec3 apart{0, 0, 0};  ///< that vector, m
  template <class Archive>
  void serialize(Archive& archive) {
    archive(weight, apart);
  }
};

/// The nearest points of a pair whose nodes are at these points (Ericson, Real-Time Collision Detection,
/// 2005, 5.1.5 and 5.1.9). Degenerate triangles and edges are taken as what they shrank to.
Nearness nearness(FeaturePair::Kind kind, const FourPoints& points);

/// The direction in which features so near touch, from the second to the first: the triangle's normal where
/// the node is over it, be it beyond its rim by less than it is high, or else the shortest way. (Along the
/// shortest way a sheet that slides would stumble with its rim over every node beneath.) Zero if they meet.
Vec3 contact_normal(FeaturePair::Kind kind, const FourPoints& points, const Nearness& near);

/// Bound on how much nearer features come whose nodes move so, m; the same for a common motion added.
double reach(FeaturePair::Kind kind, const FourPoints& move);

/// The first share of the way, in [0, 1], at which features that go straight from `start` to `start + move`
/// are hardly farther apart than `gap`: farther than `gap`, nearer than 1.5 gaps. None if they never are.
/// Features that begin nearer than that, `distance` apart, may come a tenth nearer.
///
/// Conservative advancement by the nodes' motions along the shortest way (Mirtich, Impulse-based Dynamic
/// Simulation of Rigid Body Systems, 1996, 2.3.2): no root of a cubic is looked for, so that none is missed,
/// and what slides past at a distance is not taken for what comes nearer.
std::optional<double> first_contact(FeaturePair::Kind kind, double distance, const FourPoints& start,
                                    const FourPoints& move, double gap);

}  // namespace weft
