#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "cloth/contact/constraints/layer_pair.h"
#include "cloth/contact/search/feature_search.h"
#include "cloth/core/particles.h"
#include "cloth/core/substep.h"
#include "cloth/kernels/components.h"

namespace weft {

/// One cloth's nodes on their ways in an implicit substep, and which of its own features would pass through
/// each other on them.
class MeetingLayers {
 public:
  /// The cloth's nodes are those from `first` on in LayerNodes.
  MeetingLayers(const Grid& grid, std::uint32_t first, const LayerParameters& parameters);

  /// What is cut of the cloth.
  void set_torn(const std::shared_ptr<const TornLinks>& torn);
  /// A substep begins; moving pins are where they will be at its end. `nodes` are those of all cloths, and
  /// `found` the search for the step's pairs among them.
  template <class Real>
  void begin(const Particles<Real>& particles, const Substep& substep, const LayerNodes& nodes,
             const FeatureSearch& found);
  /// What would pass through each other on the way to these positions, m, of the cloth's own place, as it
  /// meets; by nodes as in LayerNodes. Nothing after so many calls in a substep that more would not help.
  template <class Real>
  std::vector<LayerPair> find(kernels::Components<const Real> position);
  /// The cloth's nodes alone, from 0.
  const LayerNodes& nodes() const { return own_; }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(own_, search_, place_, rounds_);
  }

 private:
  /// A pair of own_ as it meets on its way; none if it does not.
  std::optional<LayerPair> meeting(const FeaturePair& features) const;

  Grid grid_;
  std::uint32_t first_;
  LayerParameters parameters_;
  std::shared_ptr<const TornLinks> torn_;  ///< nullptr while the cloth is whole
  LayerNodes own_;                         ///< on their ways in the substep
  FeatureSearch search_;                   ///< among them
  Vec3 place_{0, 0, 0};                    ///< of the cloth in the substep (Particles::place)
  int rounds_ = 0;                         ///< searches of the substep
  std::vector<std::uint8_t> pairs_of_;     ///< that begin with each node, in a round
};

}  // namespace weft
