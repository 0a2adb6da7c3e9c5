#pragma once
#include <memory>
#include <vector>

#include "cloth/bodies/body_contact.h"
#include "cloth/bodies/pinned_node.h"
#include "cloth/shapes/solid.h"

namespace weft {

/// Finds where solids, one of which yields, meet in a step. FCL's tree of their boxes, swept over their ways,
/// leaves few pairs. Of these two convex shapes are looked at where they end, by FCL's collision of shapes:
/// along its normal, or a better one, the faces that touch are cut (manifold_of); where it finds none they
/// are by the face that parts them (manifold_before). A half-space, which FCL tells one point of,
/// and a ball are looked at by their distances. Of a mesh that is not convex the corners and those of the
/// other are looked at, and besides where their surfaces cross, as FCL tells. What moves so far that it might
/// have passed through is looked at along its way (conservative advancement: Mirtich, Impulse-based Dynamic
/// Simulation, 1996): then its corners and a ball in its middle count.
///
/// Pinned nodes of cloths are balls of no radius, which the tree does not hold: whoever knows them tells
/// which of them are near.
///
/// Nothing is remembered but FCL's form of the meshes: the contacts follow from the solids alone.
class BodyCollision {
 public:
  BodyCollision();
  ~BodyCollision();
  BodyCollision(const BodyCollision&) = delete;
  BodyCollision& operator=(const BodyCollision&) = delete;

  /// In a step of dt, s, in which the solids go as they say. Ordered: between two that yield first, with what
  /// never moves last, so that this is given way to least; then by solid. The indices of `pins` follow those
  /// of the solids. None if a solid that yields is not at a finite place. Meshes must outlive this. Valid
  /// until the next call.
  const std::vector<BodyContact>& find(const std::vector<Solid>& solids, double dt,
                                       const std::vector<PinnedNode>& pins = {});
  /// What the last call found.
  const std::vector<BodyContact>& found() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft
