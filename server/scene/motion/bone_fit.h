#pragma once
#include <map>
#include <string>
#include <vector>

#include "scene/motion/skeleton.h"
#include "scene/motion/skin.h"

namespace weft::scene {

/// By what rule capsules become as thick as they are. Lengths in m.
struct BoneFitRule {
  double share = 0.15;     ///< radius of a bone without a skin, of its length
  double thinnest = 0.02;  ///< and at least this, of the figure's height
  double thickest = 0.08;  ///< and at most this, of the figure's height
  double shortest = 0.05;  ///< bones shorter than this, of the figure's height, get none: fingers
  double quantile = 0.8;   ///< of a bone's vertices this share is within the capsule's radius
  std::map<std::string, double> radii;  ///< m, by the joint's name, instead of any rule
};

/// A capsule that goes with a joint.
struct BoneCapsule {
  std::size_t node = 0;                             ///< the joint
  double radius = 0, length = 0;                    ///< m, as CapsuleDescription's
  Vec3 position{0, 0, 0};                           ///< of its centre, as seen from the joint, m
  Quaternion orientation = Quaternion::Identity();  ///< of its y axis, to the joint's frame
};

/// Between its highest and its lowest node, at the clip's begin or, without one, as the nodes stand, in the
/// file's lengths.
double height_of(const Skeleton& skeleton, const Skeleton::Clip* clip);

/// A capsule for each bone, which goes from a joint to a child of it or, at a joint without children that has
/// a skin, along that skin's axis from the joint on. Its round ends have their centres at the bone's ends.
/// Where the joint has a skin the radius is the quantile of the distances between the bone's line and those
/// of the joint's vertices that are beside the bone and nearer to it than to the joint's other bones. `scale`
/// as in Placement. Names in `radii` that no bone has are refused by std::invalid_argument.
std::vector<BoneCapsule> fit_capsules(const Skeleton& skeleton, const Skeleton::Clip* clip, const Skin& skin,
                                      double scale, const BoneFitRule& rule);

}  // namespace weft::scene
