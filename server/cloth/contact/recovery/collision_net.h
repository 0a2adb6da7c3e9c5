#pragma once
#include "cloth/contact/search/feature_search.h"

namespace weft {

/// Sees to it that no cloth passes through itself or another: after a step that began without intersections
/// there are none, unless solids take back what it did (ClothContact). Features whose straight ways meet are
/// given inelastic impulses along the normal, pair by pair; those that still meet become rigid impact zones,
/// each of which goes on as the rigid body of its nodes' momentum and angular momentum, growing until nothing
/// meets (Bridson, Fedkiw, Anderson, Robust Treatment of Collisions, Contact and Friction for Cloth
/// Animation, 2002, sections 7.2 to 7.5; Provot 1997). A rigid move by less than half a turn, made straight,
/// is affine and never singular, so that a zone cannot meet itself. As a last resort, which only rounding can
/// call for, all nodes stay.
///
/// It changes LayerNodes::end; impulses and zones lower the kinetic energy of the mean velocities.
class CollisionNet {
 public:
  /// Features are kept at least `gap` apart, m, or half as near as they were.
  explicit CollisionNet(double gap) : gap_(gap) {}

  double gap() const { return gap_; }

  /// False if no ways met: nothing was changed.
  bool apply(FeatureSearch& search, LayerNodes& nodes);
  /// Of the last apply(): by how much each node was moved is end - this.
  const std::vector<Vec3>& untouched_end() const { return untouched_; }

 private:
  /// Meets in the step as the ends are now.
  bool meets(const FeaturePair& pair, const LayerNodes& nodes) const;
  bool push_apart(const FeaturePair& pair, LayerNodes& nodes);
  std::uint32_t root(std::uint32_t node);
  bool one_zone(const FeaturePair& pair);
  void join(const FeaturePair& pair);
  void move_zones(LayerNodes& nodes);
  void move_rigidly(const std::vector<std::uint32_t>& zone, LayerNodes& nodes);

  double gap_;
  std::vector<Vec3> untouched_;
  std::vector<char> changed_, changing_;  ///< nodes, in the last round and in this one
  std::vector<std::uint32_t> zone_;       ///< union-find: parents
};

}  // namespace weft
