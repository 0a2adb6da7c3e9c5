#include "cloth/contact/constraints/layer_stiffness.h"

namespace weft {
namespace {

/// Least and greatest stiffness of a contact, as multiples of the inertia of the nodes that meet.
constexpr float kSoft = 50, kStiff = 5000;
/// Factors by which a stiffness grows and falls in a step: it grows where a pair keeps less than kHardlyKept
/// of its gap, and falls where all keep more than kKept.
constexpr float kStiffer = 4, kSofter = 0.7F;
constexpr double kKept = 0.8, kHardlyKept = 0.4;

}  // namespace

LayerStiffness::LayerStiffness(std::size_t nodes) : stiffness_(nodes, kSoft), strain_(nodes, Strain::none) {}

void LayerStiffness::stiffen(const std::vector<std::uint8_t>& nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] != 0) stiffness_[i] = std::min(kStiff, stiffness_[i] * kStiffer);
  }
}

void LayerStiffness::begin_adapting() { std::fill(strain_.begin(), strain_.end(), Strain::none); }

void LayerStiffness::keeps(double part, const std::array<std::size_t, 4>& node,
                           const std::array<double, 4>& weight) {
  if (part > kKept) return;
  for (std::size_t i = 0; i < 4; ++i) {
    Strain& strain = strain_[node[i]];
    if (weight[i] != 0) strain = std::max(strain, part > kHardlyKept ? Strain::some : Strain::hard);
  }
}

void LayerStiffness::adapt() {
  for (std::size_t i = 0; i < stiffness_.size(); ++i) {
    if (strain_[i] == Strain::some) continue;
    const float factor = strain_[i] == Strain::hard ? kStiffer : kSofter;
    stiffness_[i] = std::clamp(stiffness_[i] * factor, kSoft, kStiff);
  }
}

}  // namespace weft
