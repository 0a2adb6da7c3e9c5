#include "cloth/contact/recovery/layer_order.h"

#include "cloth/contact/constraints/layer_pair.h"

namespace weft {
namespace {

/// Times that all pairs are put right, one after the other, at most.
constexpr int kOrderings = 30;

}  // namespace

bool keep_order(std::span<const OrderedLayers> layers, const std::vector<double>& inverse_mass,
                std::vector<Vec3>& positions) {
  bool any = false;
  for (int time = 0; time < kOrderings; ++time) {
    bool moved = false;
    for (const OrderedLayers& pair : layers) {
      double lack = pair.apart;
      PairShare share;
      for (const auto& [node, weight] : pair.nodes) {
        lack -= weight * pair.normal.dot(positions[node]);
        share.add(weight, inverse_mass[node]);
      }
      if (lack <= 0 || share.sum == 0) continue;
      for (const auto& [node, weight] : pair.nodes)
        positions[node] += lack * weight * inverse_mass[node] / share.bounded() * pair.normal;
      moved = true;
    }
    if (!moved) break;
    any = true;
  }
  return any;
}

}  // namespace weft
