#include "cloth/contact/constraints/layer_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// Least and greatest stiffness of a contact, as multiples of the inertia of the nodes that meet.
constexpr float kSoft = 50, kStiff = 5000;
/// Searches for pairs that would meet, a substep. Distances, in gaps of the net, at which pairs are looked at
/// and are searched; and the least distance at which those that would meet are held, in their own gap.
constexpr int kMostRounds = 4;
constexpr double kPairsInSight = 1.5, kPairsFound = 8, kMeetingPart = 0.4;
/// Most pairs of a node, or of the edges that begin at it, that a round adds: bounds memory.
constexpr std::uint8_t kMostOfNode = 128;
/// Factors by which a stiffness grows and falls in a step: it grows where a pair keeps less than kHardlyKept
/// of its gap, and falls where all keep more than kKept.
constexpr float kStiffer = 4, kSofter = 0.7F;
constexpr double kKept = 0.8, kHardlyKept = 0.4;
/// Share of the gap to which layers near rest are separated. Not all pairs of a contact can have the whole
/// gap at once: separated that far they would push each other to and fro.
constexpr double kWellApart = 0.5;

double led(double distance, double gap, bool near_rest) {
  const double lack = (near_rest ? kWellApart : 1) * gap - distance;
  return lack > 0 ? distance + kLayersLedApart * lack : std::min(distance, gap);
}

PairKey key_of(const LayerPair& pair) {
  if (pair.features.kind == FeaturePair::Kind::edge_edge) return pair.features.node;
  const std::uint32_t node = pair.features.node[0];  // twice: of no edge
  return {node, node, static_cast<std::uint32_t>(pair.side), 0};
}

}  // namespace

template <class Real>
LayerContacts<Real>::LayerContacts(const LayerNodes& nodes, const FeatureSearch& found, const Grid& grid,
                                   std::size_t cloth, const LayerParameters& parameters)
    : nodes_(&nodes),
      found_(&found),
      grid_(grid),
      first_(nodes.first[cloth]),
      end_(nodes.first[cloth + 1]),
      parameters_(parameters),
      stiffness_(end_ - first_, kSoft),
      strained_(end_ - first_, 0),
      given_(end_ - first_, Vec3(0, 0, 0)),
      substep_net_(grid, parameters.net_gap) {
  search_.set_grids({grid});
}

template <class Real>
PairForce LayerContacts<Real>::remembered(const PairKey& key) const {
  const auto found = std::lower_bound(forces_.begin(), forces_.end(), key,
                                      [](const PairForce& f, const PairKey& k) { return f.pair < k; });
  return found != forces_.end() && found->pair == key ? *found : PairForce{.pair = key};
}

template <class Real>
void LayerContacts<Real>::read_masses(const Particles<Real>& particles) {
  const auto& values = particles.inverse_mass.values();
  own_.inverse_mass.assign(values.begin(), values.end());
}

template <class Real>
void LayerContacts<Real>::begin(const Particles<Real>& particles, const Substep& substep, bool near_rest) {
  constraints_.clear();
  near_rest_ = near_rest;
  rounds_ = 0;
  substep_ = substep;
  place_ = particles.place;
  if (substep.from == 0) given_.assign(given_.size(), Vec3(0, 0, 0));
  const auto position = kernels::components(particles.position),
             velocity = kernels::components(particles.velocity);
  const std::size_t count = end_ - first_;
  own_.start.resize(count);
  own_.velocity.resize(count);
  own_.end.resize(count);
  read_masses(particles);
  own_.tangled.assign(nodes_->tangled.begin() + first_, nodes_->tangled.begin() + end_);
  for (std::size_t i = 0; i < count; ++i) {
    own_.velocity[i] = at(velocity, i);
    own_.start[i] = place_ + at(position, i);
    // A pin is at the substep's end already.
    if (own_.inverse_mass[i] == 0) {
      own_.end[i] = own_.start[i];
      own_.start[i] += (1 - substep.from / substep.to) * (nodes_->start[first_ + i] - own_.start[i]);
    }
  }
  if (substep.from == 0) {
    search_.take_over(*found_, first_, own_);
  } else {
    search_.forget();
  }
  const double drop = standard_gravity().norm() * substep.seconds * substep.seconds;
  for (const LayerPair& pair : pairs_) {
    Constraint c = constraint(pair);
    if (c.distance + c.closing - drop > c.gap) continue;
    c.acts = c.memory > 0 || c.distance + c.closing < c.wanted;
    constraints_.push_back(c);
  }
}

template <class Real>
auto LayerContacts<Real>::constraint(const LayerPair& pair) const -> Constraint {
  Constraint c;
  c.key = key_of(pair);
  c.edges = pair.features.kind == FeaturePair::Kind::edge_edge;
  c.normal = pair.normal;
  const double past = substep_.from * substep_.step_seconds(), h = substep_.seconds;
  bool others = false;                                     // nodes of another cloth
  double others_way = 0, others_share = 0, own_share = 0;  // share: inverse mass along the normal
  Vec3 slip(0, 0, 0);
  c.slid.setZero();
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t n = pair.features.node[i];
    const double w = pair.near.weight[i];
    if (own(n)) {
      c.coupling.node[i] = n - first_;
      const Vec3 &start = own_.start[n - first_], &end = own_.end[n - first_];
      if (own_.inverse_mass[n - first_] == 0) {  // a pin's way is no move of the substep's system
        c.distance += w * c.normal.dot(end);
        continue;
      }
      c.distance += w * c.normal.dot(start);
      c.coupling.weight[i] = w;
      slip += w * h * own_.velocity[n - first_];
      own_share += w * w * own_.inverse_mass[n - first_];
      continue;
    }
    const Vec3 v = nodes_->velocity[n] + past * nodes_->acceleration[n];
    const Vec3 way = h * (v + h * nodes_->acceleration[n]);
    c.distance += w * c.normal.dot(nodes_->start[n] + past * v);
    others = true;
    others_way += w * c.normal.dot(way);
    others_share += w * w * nodes_->inverse_mass[n];
    c.slid += w * way;
  }
  slip += c.slid;
  c.closing = c.normal.dot(slip);
  c.gap = pair.gap;
  const bool stands_still = others && others_share == 0;
  c.wanted = led(c.distance, pair.gap, near_rest_ && !stands_still);
  c.room = c.distance + others_way - c.wanted;
  c.inertia = others_share > 0 ? 1 / (h * h * others_share) : std::numeric_limits<double>::infinity();
  c.slid = across(c.slid, c.normal);
  c.sliding = across(slip, c.normal).norm();
  PairForce last = remembered(c.key);
  const bool between_cloths = std::isfinite(c.inertia);
  if (last.between_cloths != between_cloths) last = {};
  c.memory = c.pressed = last.force;
  if (between_cloths) c.lasting = last.force + standard_gravity().norm() / (own_share + others_share);
  c.holds = parameters_.friction * c.memory;
  if (near_rest_) c.grip = across(last.grip, c.normal);
  if (c.grip.squaredNorm() > c.holds * c.holds) c.grip.setZero();
  return c;
}

template <class Real>
double LayerContacts<Real>::room(const Constraint& c, kernels::Components<const Real> move) const {
  double sum = c.room;
  for (std::size_t i = 0; i < 4; ++i) {
    if (c.coupling.weight[i] != 0) sum += c.coupling.weight[i] * c.normal.dot(at(move, c.coupling.node[i]));
  }
  return sum;
}

template <class Real>
Vec3 LayerContacts<Real>::slip(const Constraint& c, kernels::Components<const Real> move) const {
  Vec3 sum(0, 0, 0);
  for (std::size_t i = 0; i < 4; ++i) {
    if (c.coupling.weight[i] != 0) sum += c.coupling.weight[i] * at(move, c.coupling.node[i]);
  }
  return c.slid + across(sum, c.normal);
}

template <class Real>
void LayerContacts<Real>::add_to(kernels::Components<Real> b, NodeCouplings<Real>& couplings,
                                 const Real* diagonal, kernels::Components<const Real> move) {
  for (Constraint& c : constraints_) {
    double share = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double w = c.coupling.weight[i];
      if (w != 0) share += w * w / double(diagonal[c.coupling.node[i]]);
    }
    if (share == 0) continue;
    float multiple = kSoft;
    for (std::size_t i = 0; i < 4; ++i) {
      if (c.coupling.weight[i] != 0) multiple = std::max(multiple, stiffness_[c.coupling.node[i]]);
    }
    c.stiffness = static_cast<double>(multiple) / share;
    c.stiffness = 1 / (1 / c.stiffness + 1 / c.inertia);
    c.friction = 0;
    if (!c.acts) continue;
    const bool slides = c.holds < c.stiffness * c.sliding;
    if (c.holds > 0) c.friction = slides ? c.holds / c.sliding : c.stiffness;
    if (slides) c.grip.setZero();
    const Vec3 force = push(c, move) * c.normal + rub(c, move);
    for (std::size_t i = 0; i < 4; ++i) {
      if (c.coupling.weight[i] != 0) add(b, c.coupling.node[i], c.coupling.weight[i] * force);
    }
    c.coupling.stiffness = (c.stiffness - c.friction) * c.normal * c.normal.transpose() +
                           c.friction * Eigen::Matrix3d::Identity();
    couplings.add(c.coupling);
  }
}

template <class Real>
void LayerContacts<Real>::append_springs(kernels::Components<const Real> move,
                                         kernels::Components<const Real> change,
                                         std::vector<OneSidedSpring>& springs) const {
  for (const Constraint& c : constraints_) {
    if (c.stiffness == 0) continue;
    springs.push_back({push(c, move) / c.stiffness, c.room - room(c, change), c.stiffness, c.acts});
  }
}

template <class Real>
double LayerContacts<Real>::release_pulling(kernels::Components<const Real> move) {
  double energy = 0;
  for (Constraint& c : constraints_) {
    const double force = push(c, move);
    if (c.stiffness == 0 || c.acts != (force < 0)) continue;
    c.acts = !c.acts;
    energy += force * force / c.stiffness / 2;
  }
  return energy;
}

template <class Real>
bool LayerContacts<Real>::hold_meeting(kernels::Components<const Real> position,
                                       kernels::Components<const Real> move) {
  if (constraints_.empty() || rounds_ == kMostRounds) return false;
  ++rounds_;
  for (std::size_t i = 0; i < own_.end.size(); ++i) own_.end[i] = place_ + at(position, i);
  met_.assign(own_.end.size(), 0);
  // By the nodes they join, the first where several do; made when something meets. In a crumpled lump
  // thousands of pairs meet among tens of thousands.
  std::map<std::pair<std::array<std::size_t, 4>, bool>, std::size_t> known;
  const auto nodes_of = [](const Constraint& c) { return std::pair(c.coupling.node, c.edges); };
  bool any = false;
  for (const FeaturePair& features :
       search_.found(own_, kPairsInSight * parameters_.net_gap, kPairsFound * parameters_.net_gap)) {
    if (met_[features.node[0]] == kMostOfNode) continue;
    const std::optional<LayerPair> pair = meeting(features);
    if (!pair) continue;
    Constraint c = constraint(*pair);
    c.wanted = std::max(c.wanted, kMeetingPart * parameters_.gap);
    c.room = c.distance - c.wanted;
    if (!any) {
      for (std::size_t i = 0; i < constraints_.size(); ++i) known.try_emplace(nodes_of(constraints_[i]), i);
    }
    const auto [entry, is_new] = known.try_emplace(nodes_of(c), constraints_.size());
    if (is_new) {
      constraints_.push_back(c);
    } else {
      Constraint& before = constraints_[entry->second];
      c.pressed = std::max(0.0, push(before, move));
      c.stiffness = before.stiffness;
      before = c;
    }
    for (const std::size_t node : c.coupling.node) met_[node] = std::max<std::uint8_t>(met_[node], 1);
    ++met_[features.node[0]];
    any = true;
  }
  for (std::size_t i = 0; i < met_.size(); ++i) {
    if (met_[i] != 0) stiffness_[i] = std::min(kStiff, stiffness_[i] * kStiffer);
  }
  return any;
}

template <class Real>
std::optional<LayerPair> LayerContacts<Real>::meeting(const FeaturePair& features) const {
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

template <class Real>
void LayerContacts<Real>::adapt(kernels::Components<const Real> move) {
  std::fill(strained_.begin(), strained_.end(), 0);
  for (const Constraint& c : constraints_) {
    const double part = c.acts ? 1 + (room(c, move) - (c.gap - c.wanted)) / c.gap : 1;
    if (part > kKept) continue;
    for (std::size_t i = 0; i < 4; ++i) {
      char& strained = strained_[c.coupling.node[i]];
      if (c.coupling.weight[i] != 0)
        strained = std::max(strained, static_cast<char>(part > kHardlyKept ? 1 : 2));
    }
  }
  for (const std::size_t node : struck_) strained_[node] = 2;
  for (std::size_t i = 0; i < stiffness_.size(); ++i) {
    if (strained_[i] == 1) continue;
    stiffness_[i] = std::clamp(stiffness_[i] * (strained_[i] == 2 ? kStiffer : kSofter), kSoft, kStiff);
  }
}

template <class Real>
void LayerContacts<Real>::finish(kernels::Components<const Real> move) {
  adapt(move);
  struck_.clear();
  held_.clear();
  forces_.clear();
  for (const Constraint& c : constraints_) {
    if (!c.acts) continue;
    for (std::size_t i = 0; i < 4; ++i) {
      if (c.coupling.weight[i] != 0) held_.push_back(c.coupling.node[i]);
    }
    const bool between_cloths = std::isfinite(c.inertia);
    const double force = push(c, move);
    const Vec3 friction = rub(c, move);
    if (force > 0) forces_.push_back({c.key, std::min(force, c.lasting), friction, between_cloths});
    if (!between_cloths) continue;
    const Vec3 impulse = substep_.seconds * (force * c.normal + friction);
    for (std::size_t i = 0; i < 4; ++i) given_[c.coupling.node[i]] += c.coupling.weight[i] * impulse;
  }
  std::sort(forces_.begin(), forces_.end(), [](const PairForce& a, const PairForce& b) {
    return std::tie(a.pair, a.force) < std::tie(b.pair, b.force);
  });
}

template class LayerContacts<float>;
template class LayerContacts<double>;

}  // namespace weft
