/// Contact around settling (levels/settle.h), which moves each cloth as if it were alone.
#include <algorithm>

#include "cloth/contact/recovery/layer_order.h"
#include "cloth/kernels/node_vector.h"
#include "cloth/levels/chord.h"
#include "cloth/world/cloth.h"
#include "cloth/world/cloth_contact.h"

namespace weft {
namespace {

/// Times that what a change of level has entangled is led out of each other before it settles.
constexpr int kUntanglings = 20;

/// Some of the cloths.
bool coarser(const std::vector<Grid>& before, const std::vector<Grid>& now) {
  return !std::equal(before.begin(), before.end(), now.begin(), now.end(),
                     [](const Grid& was, const Grid& is) { return was.rows <= is.rows; });
}

/// Of their gap, that layers which have come to lie on coarser grids are at least led apart: as much as
/// layers near rest are.
constexpr double kOrderlyApart = 0.5;

}  // namespace

template <class Real>
std::vector<OrderedLayers> ClothContact<Real>::layers_now(const std::vector<FoundPair>& pairs,
                                                          const std::vector<Grid>& grids) const {
  std::vector<std::uint32_t> first{0};
  for (const Grid& grid : grids) first.push_back(first.back() + static_cast<std::uint32_t>(grid.size()));
  std::vector<OrderedLayers> layers;
  for (const auto& [pair, implicitly] : pairs) {
    OrderedLayers now{{}, pair.normal, kOrderlyApart * pair.gap};
    const auto add = [&](std::uint32_t node, double weight) {
      const auto same = std::find_if(now.nodes.begin(), now.nodes.end(),
                                     [&](const OrderedLayers::Node& n) { return n.node == node; });
      if (same == now.nodes.end()) {
        now.nodes.push_back({node, weight});
      } else {
        same->weight += weight;
      }
    };
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t node = pair.features.node[i];
      const auto sheet =
          static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), node) - first.begin() - 1);
      const Chord chord = chord_of(node - first[sheet], grids[sheet], grids_[sheet]);
      for (std::size_t k = 0; k < 4; ++k) {
        if (chord.weight[k] == 0) continue;
        add(nodes_.first[sheet] + static_cast<std::uint32_t>(chord.node[k]),
            pair.near.weight[i] * chord.weight[k]);
      }
    }
    layers.push_back(std::move(now));
  }
  return layers;
}

template <class Real>
void ClothContact<Real>::keep_order(const std::vector<OrderedLayers>& layers,
                                    std::vector<Cloth<Real>>& cloths) {
  read(cloths, nodes_.start);
  const std::vector<Vec3> before = nodes_.start;
  if (!weft::keep_order(layers, nodes_.inverse_mass, nodes_.start)) return;
  for (std::size_t k = 0; k < cloths.size(); ++k) {
    for (std::size_t i = 0; i < grids_[k].size(); ++i) {
      const std::size_t n = nodes_.first[k] + i;
      add(kernels::components(cloths[k].particles().position), i, Vec3(nodes_.start[n] - before[n]));
    }
    cloths[k].moved_from_outside();
  }
}

template <class Real>
void ClothContact<Real>::begin_settling(std::vector<Cloth<Real>>& cloths) {
  const std::vector<Grid> grids = grids_;
  const std::vector<FoundPair> pairs = pairs_;
  lay_out(cloths);
  take_over_tears(cloths);
  search_.forget();
  read_masses(cloths);
  if (coarser(grids, grids_)) keep_order(layers_now(pairs, grids), cloths);
  may_be_tangled_ = true;
  for (int time = 0; time < kUntanglings && may_be_tangled_; ++time) {
    read(cloths, nodes_.start);
    nodes_.end = nodes_.start;
    untangle(cloths);
  }
  read(cloths, nodes_.start);
}

template <class Real>
void ClothContact<Real>::end_settling(std::vector<Cloth<Real>>& cloths, double dt) {
  std::vector<VectorField<Real>> velocities;
  velocities.reserve(cloths.size());
  for (const Cloth<Real>& cloth : cloths) velocities.push_back(cloth.particles().velocity);
  read(cloths, nodes_.end);
  stop_what_meets(cloths, dt);
  for (std::size_t k = 0; k < cloths.size(); ++k) cloths[k].particles().velocity = std::move(velocities[k]);
}

template std::vector<OrderedLayers> ClothContact<float>::layers_now(const std::vector<FoundPair>&,
                                                                    const std::vector<Grid>&) const;
template void ClothContact<float>::keep_order(const std::vector<OrderedLayers>&, std::vector<Cloth<float>>&);
template void ClothContact<float>::begin_settling(std::vector<Cloth<float>>&);
template void ClothContact<float>::end_settling(std::vector<Cloth<float>>&, double);
template std::vector<OrderedLayers> ClothContact<double>::layers_now(const std::vector<FoundPair>&,
                                                                     const std::vector<Grid>&) const;
template void ClothContact<double>::keep_order(const std::vector<OrderedLayers>&,
                                               std::vector<Cloth<double>>&);
template void ClothContact<double>::begin_settling(std::vector<Cloth<double>>&);
template void ClothContact<double>::end_settling(std::vector<Cloth<double>>&, double);

}  // namespace weft
