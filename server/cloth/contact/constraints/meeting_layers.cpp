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

MeetingLayers::MeetingLayers(const LayerParts& parts, const LayerParameters& parameters)
    : parts_(parts), parameters_(parameters), torn_(parts.size()), places_(parts.size(), Vec3(0, 0, 0)) {
  std::vector<Grid> grids;
  grids.reserve(parts.size());
  for (const LayerParts::Part& part : parts) grids.push_back(part.grid);
  search_.set_grids(grids);
}

void MeetingLayers::set_torn(std::size_t part, const std::shared_ptr<const TornLinks>& torn) {
  torn_[part] = torn;
  search_.set_torn(part, *torn);
}

template <class Real>
void MeetingLayers::begin(std::span<const Particles<Real>* const> starts, const Substep& substep,
                          const LayerNodes& nodes, const FeatureSearch& found) {
  rounds_ = 0;
  const std::size_t count = parts_.nodes();
  own_.start.resize(count);
  own_.velocity.resize(count);
  own_.end.resize(count);
  own_.inverse_mass.resize(count);
  own_.tangled.resize(count);
  for (std::size_t part = 0; part < parts_.size(); ++part) begin(part, *starts[part], substep, nodes);
  if (substep.from > 0) return search_.forget();
  std::vector<std::uint32_t> first;
  first.reserve(parts_.size());
  for (const LayerParts::Part& part : parts_) first.push_back(part.first);
  search_.take_over(found, first, own_);
}

template <class Real>
void MeetingLayers::begin(std::size_t part, const Particles<Real>& particles, const Substep& substep,
                          const LayerNodes& nodes) {
  const LayerParts::Part& of = parts_[part];
  places_[part] = particles.place;
  const auto position = kernels::components(particles.position),
             velocity = kernels::components(particles.velocity);
  // Not LayerNodes': to others the cloth stood still as the step began, though it may have woken in it.
  const auto& inverse_mass = particles.inverse_mass.values();
  for (std::size_t i = 0; i < of.grid.size(); ++i) {
    const std::size_t n = of.offset + i;
    own_.inverse_mass[n] = double(inverse_mass[i]);
    own_.tangled[n] = nodes.tangled[of.first + i];
    own_.velocity[n] = at(velocity, i);
    own_.start[n] = particles.place + at(position, i);
    // A pin is at the substep's end already.
    if (own_.inverse_mass[n] == 0) {
      own_.end[n] = own_.start[n];
      own_.start[n] += (1 - substep.from / substep.to) * (nodes.start[of.first + i] - own_.start[n]);
    }
  }
}

template <class Real>
std::vector<LayerPair> MeetingLayers::find(std::span<const kernels::Components<const Real>> positions) {
  std::vector<LayerPair> found;
  if (rounds_ == kMostRounds) return found;
  ++rounds_;
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    const LayerParts::Part& of = parts_[part];
    for (std::size_t i = 0; i < of.grid.size(); ++i)
      own_.end[of.offset + i] = places_[part] + at(positions[part], i);
  }
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
  const std::size_t one = parts_.part_of_joined(features.node[0]);
  pair.gap = parts_.gap(one, parts_.part_of_joined(features.node[2]));
  if (features.kind == FeaturePair::Kind::edge_edge) {
    pair.gap *= kEdgePart;
  } else {
    const LayerParts::Part& part = parts_[one];
    pair.side = side_of_sheet(part.grid, own_.start.data() + part.offset, features.node[0] - part.offset,
                              pair.normal, torn_[one].get());
  }
  pair.features = features;
  for (std::uint32_t& node : pair.features.node) {
    const LayerParts::Part& part = parts_[parts_.part_of_joined(node)];
    node += part.first - part.offset;
  }
  return pair;
}

template void MeetingLayers::begin(std::span<const Particles<float>* const>, const Substep&,
                                   const LayerNodes&, const FeatureSearch&);
template void MeetingLayers::begin(std::span<const Particles<double>* const>, const Substep&,
                                   const LayerNodes&, const FeatureSearch&);
template std::vector<LayerPair> MeetingLayers::find(std::span<const kernels::Components<const float>>);
template std::vector<LayerPair> MeetingLayers::find(std::span<const kernels::Components<const double>>);

}  // namespace weft
