#include "cloth/contact/constraints/meeting_layers.h"

#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// Searches for pairs that would meet, a substep.
constexpr int kMostRounds = 4;
/// Distances, in gaps of the net, at which pairs are looked at and are searched.
constexpr double kPairsInSight = 1.5, kPairsFound = 8;
/// Most pairs of a node, or of the edges that begin at it, that a round finds: bounds memory.
constexpr std::uint8_t kMostOfNode = 127;

}  // namespace

MeetingLayers::MeetingLayers(const Grid& grid, std::uint32_t first, const LayerParameters& parameters)
    : grid_(grid), first_(first), parameters_(parameters) {
  search_.set_grids({grid});
}

void MeetingLayers::set_torn(const std::shared_ptr<const TornLinks>& torn) {
  torn_ = torn;
  search_.set_torn(0, *torn);
}

template <class Real>
void MeetingLayers::begin(const Particles<Real>& particles, const Substep& substep, const LayerNodes& nodes,
                          const FeatureSearch& found) {
  rounds_ = 0;
  place_ = particles.place;
  const auto position = kernels::components(particles.position),
             velocity = kernels::components(particles.velocity);
  const std::size_t count = grid_.size();
  own_.start.resize(count);
  own_.velocity.resize(count);
  own_.end.resize(count);
  // Not LayerNodes': to others the cloth stood still as the step began, though it may have woken in it.
  const auto& inverse_mass = particles.inverse_mass.values();
  own_.inverse_mass.assign(inverse_mass.begin(), inverse_mass.end());
  const auto tangled = nodes.tangled.begin() + first_;
  own_.tangled.assign(tangled, tangled + static_cast<std::ptrdiff_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    own_.velocity[i] = at(velocity, i);
    own_.start[i] = place_ + at(position, i);
    // A pin is at the substep's end already.
    if (own_.inverse_mass[i] == 0) {
      own_.end[i] = own_.start[i];
      own_.start[i] += (1 - substep.from / substep.to) * (nodes.start[first_ + i] - own_.start[i]);
    }
  }
  if (substep.from == 0) {
    search_.take_over(found, first_, own_);
  } else {
    search_.forget();
  }
}

template <class Real>
std::vector<LayerPair> MeetingLayers::find(kernels::Components<const Real> position) {
  std::vector<LayerPair> found;
  if (rounds_ == kMostRounds) return found;
  ++rounds_;
  for (std::size_t i = 0; i < own_.end.size(); ++i) own_.end[i] = place_ + at(position, i);
  pairs_of_.assign(own_.end.size(), 0);
  for (const FeaturePair& features :
       search_.found(own_, kPairsInSight * parameters_.net_gap, kPairsFound * parameters_.net_gap)) {
    std::uint8_t& pairs = pairs_of_[features.node[0]];
    if (pairs == kMostOfNode) continue;
    const std::optional<LayerPair> pair = meeting(features);
    if (!pair) continue;
    ++pairs;
    found.push_back(*pair);
  }
  return found;
}

std::optional<LayerPair> MeetingLayers::meeting(const FeaturePair& features) const {
  FourPoints points = points_of(features, own_.start), way = points_of(features, own_.end);
  for (std::size_t i = 0; i < 4; ++i) way[i] -= points[i];
  const auto time = first_contact(features.kind, features.distance, points, way, parameters_.net_gap);
  if (!time) return std::nullopt;
  for (std::size_t i = 0; i < 4; ++i) points[i] += *time * way[i];
  LayerPair pair;
  pair.near = nearness(features.kind, points);
  const double distance = pair.near.apart.norm();
  if (distance == 0) return std::nullopt;
  pair.normal = pair.near.apart / distance;
  pair.gap = parameters_.gap;
  if (features.kind == FeaturePair::Kind::edge_edge) {
    pair.gap *= kEdgePart;
  } else {
    pair.side = side_of_sheet(grid_, own_.start.data(), features.node[0], pair.normal, torn_.get());
  }
  pair.features = features;
  for (std::uint32_t& node : pair.features.node) node += first_;
  return pair;
}

template void MeetingLayers::begin(const Particles<float>&, const Substep&, const LayerNodes&,
                                   const FeatureSearch&);
template void MeetingLayers::begin(const Particles<double>&, const Substep&, const LayerNodes&,
                                   const FeatureSearch&);
template std::vector<LayerPair> MeetingLayers::find(kernels::Components<const float>);
template std::vector<LayerPair> MeetingLayers::find(kernels::Components<const double>);

}  // namespace weft
