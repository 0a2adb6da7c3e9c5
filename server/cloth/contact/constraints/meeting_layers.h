#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cloth/contact/constraints/layer_pair.h"
#include "cloth/contact/constraints/layer_parts.h"
#include "cloth/contact/search/feature_search.h"
#include "cloth/core/particles.h"
#include "cloth/core/substep.h"
#include "cloth/kernels/components.h"

namespace weft {

/// The nodes of cloths that are stepped together on their ways in an implicit substep, and which of their
/// features would pass through each other on them.
class MeetingLayers {
 public:
  MeetingLayers(const LayerParts& parts, const LayerParameters& parameters);

  /// What is cut of a part.
  void set_torn(std::size_t part, const std::shared_ptr<const TornLinks>& torn);
  /// A substep begins, with all parts; moving pins are where they will be at its end. `nodes` are those of
  /// all cloths, and `found` the search for the step's pairs among them.
  template <class Real>
  void begin(std::span<const Particles<Real>* const> starts, const Substep& substep, const LayerNodes& nodes,
             const FeatureSearch& found);
  /// What would pass through each other on the way to these positions, m, of each cloth's own place, as it
  /// meets; by nodes as in LayerNodes. Nothing after so many calls in a substep that more would not help.
  template <class Real>
  std::vector<LayerPair> find(std::span<const kernels::Components<const Real>> positions);
  /// The parts' nodes alone, as LayerParts numbers them.
  const LayerNodes& nodes() const { return own_; }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(own_, search_, places_, rounds_);
  }

 private:
  template <class Real>
  void begin(std::size_t part, const Particles<Real>& particles, const Substep& substep,
             const LayerNodes& nodes);
  /// A pair of own_ as it meets on its way; none if it does not.
  std::optional<LayerPair> meeting(const FeaturePair& features) const;

  LayerParts parts_;
  LayerParameters parameters_;
  std::vector<std::shared_ptr<const TornLinks>> torn_;  ///< of each part; nullptr while it is whole
  LayerNodes own_;                                      ///< on their ways in the substep
  FeatureSearch search_;                                ///< among them
  std::vector<Vec3> places_;                            ///< of each part in the substep (Particles::place)
  int rounds_ = 0;                                      ///< searches of the substep
  std::vector<std::uint8_t> pairs_of_;                  ///< that begin with each node, in a round
};

}  // namespace weft
