#include "cloth/contact/constraints/layer_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// The least distance at which layers that would pass through each other are held, in their own gap.
constexpr double kMeetingPart = 0.4;
/// Share of the gap to which layers near rest are separated. Not all pairs of a contact can have the whole
/// gap at once: separated that far they would push each other to and fro.
constexpr double kWellApart = 0.5;

double led(double distance, double gap, bool near_rest, double part) {
  const double lack = (near_rest ? kWellApart : 1) * gap - distance;
  return lack > 0 ? distance + part * lack : std::min(distance, gap);
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
      first_(nodes.first[cloth]),
      end_(nodes.first[cloth + 1]),
      parameters_(parameters),
      stiffness_(end_ - first_),
      given_(end_ - first_, Vec3(0, 0, 0)),
      meeting_(grid, first_, parameters),
      impulses_(nodes, found, grid, cloth, parameters) {}

template <class Real>
bool LayerContacts<Real>::meets_others() const {
  const bool alone = nodes_->first.size() == 2;
  return !alone && (!struck_.empty() || std::any_of(pairs_.begin(), pairs_.end(), [&](const LayerPair& pair) {
    return !own(pair.features.node[0]) || !own(pair.features.node[2]);
  }));
}

template <class Real>
PairForce LayerContacts<Real>::remembered(const PairKey& key) const {
  const auto found = std::lower_bound(forces_.begin(), forces_.end(), key,
                                      [](const PairForce& f, const PairKey& k) { return f.pair < k; });
  return found != forces_.end() && found->pair == key ? *found : PairForce{.pair = key};
}

template <class Real>
void LayerContacts<Real>::begin(const Particles<Real>& particles, const Substep& substep, bool near_rest) {
  constraints_.clear();
  near_rest_ = near_rest;
  substep_ = substep;
  if (substep.from == 0) given_.assign(given_.size(), Vec3(0, 0, 0));
  meeting_.begin(particles, substep, *nodes_, *found_);
  const double drop = standard_gravity().norm() * substep.seconds * substep.seconds;
  for (const LayerPair& pair : pairs_) {
    LayerConstraint<Real> c = constraint(pair);
    if (c.distance + c.closing - drop > c.gap) continue;
    c.acts = c.memory > 0 || c.distance + c.closing < c.wanted;
    constraints_.push_back(c);
  }
}

template <class Real>
LayerConstraint<Real> LayerContacts<Real>::constraint(const LayerPair& pair) const {
  LayerConstraint<Real> c;
  const LayerNodes& ways = meeting_.nodes();
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
      const Vec3 &start = ways.start[n - first_], &end = ways.end[n - first_];
      if (ways.inverse_mass[n - first_] == 0) {  // a pin's way is no move of the substep's system
        c.distance += w * c.normal.dot(end);
        continue;
      }
      c.distance += w * c.normal.dot(start);
      c.coupling.weight[i] = w;
      slip += w * h * ways.velocity[n - first_];
      own_share += w * w * ways.inverse_mass[n - first_];
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
  c.wanted = led(c.distance, pair.gap, near_rest_ && !stands_still, layers_led_apart(substep_));
  c.spare = c.distance + others_way - c.wanted;
  c.inertia = others_share > 0 ? 1 / (h * h * others_share) : std::numeric_limits<double>::infinity();
  c.slid = across(c.slid, c.normal);
  c.sliding = across(slip, c.normal).norm();
  PairForce last = remembered(c.key);
  if (last.between_cloths != c.between_cloths()) last = {};
  c.memory = c.pressed = last.force;
  if (c.between_cloths()) c.lasting = last.force + standard_gravity().norm() / (own_share + others_share);
  c.holds = parameters_.friction * c.memory;
  if (near_rest_) c.grip = across(last.grip, c.normal);
  if (c.grip.squaredNorm() > c.holds * c.holds) c.grip.setZero();
  return c;
}

template <class Real>
void LayerContacts<Real>::add_to(kernels::Components<Real> b, NodeCouplings<Real>& couplings,
                                 const Real* diagonal, kernels::Components<const Real> move) {
  for (LayerConstraint<Real>& c : constraints_) {
    double share = 0;
    c.for_each_node([&](std::size_t node, double w) { share += w * w / double(diagonal[node]); });
    if (share == 0) continue;
    c.stiffness = static_cast<double>(stiffness_.of(c.coupling.node, c.coupling.weight)) / share;
    c.stiffness = 1 / (1 / c.stiffness + 1 / c.inertia);
    c.friction = 0;
    if (!c.acts) continue;
    const bool slides = c.holds < c.stiffness * c.sliding;
    if (c.holds > 0) c.friction = slides ? c.holds / c.sliding : c.stiffness;
    if (slides) c.grip.setZero();
    const Vec3 force = c.push(move) * c.normal + c.rub(move);
    c.for_each_node([&](std::size_t node, double w) { add(b, node, w * force); });
    c.coupling.stiffness = (c.stiffness - c.friction) * c.normal * c.normal.transpose() +
                           c.friction * Eigen::Matrix3d::Identity();
    couplings.add(c.coupling);
  }
}

template <class Real>
void LayerContacts<Real>::append_springs(kernels::Components<const Real> move,
                                         kernels::Components<const Real> change,
                                         std::vector<OneSidedSpring>& springs) const {
  for (const LayerConstraint<Real>& c : constraints_) {
    if (c.stiffness == 0) continue;
    springs.push_back({c.push(move) / c.stiffness, c.spare - c.room(change), c.stiffness, c.acts});
  }
}

template <class Real>
double LayerContacts<Real>::release_pulling(kernels::Components<const Real> move) {
  double energy = 0;
  for (LayerConstraint<Real>& c : constraints_) {
    const double force = c.push(move);
    if (c.stiffness == 0 || c.acts != (force < 0)) continue;
    c.acts = !c.acts;
    energy += force * force / c.stiffness / 2;
  }
  return energy;
}

template <class Real>
bool LayerContacts<Real>::hold_meeting(kernels::Components<const Real> position,
                                       kernels::Components<const Real> move) {
  if (constraints_.empty()) return false;
  const std::vector<LayerPair> met = meeting_.find(position);
  if (met.empty()) return false;
  // By the nodes they join, the first where several do. In a crumpled lump thousands of pairs meet among tens
  // of thousands.
  const auto nodes_of = [](const LayerConstraint<Real>& c) { return std::pair(c.coupling.node, c.edges); };
  std::map<std::pair<std::array<std::size_t, 4>, bool>, std::size_t> known;
  for (std::size_t i = 0; i < constraints_.size(); ++i) known.try_emplace(nodes_of(constraints_[i]), i);
  std::vector<std::uint8_t> stiffer(end_ - first_, 0);
  for (const LayerPair& pair : met) {
    LayerConstraint<Real> c = constraint(pair);
    c.wanted = std::max(c.wanted, kMeetingPart * parameters_.gap);
    c.spare = c.distance - c.wanted;
    const auto [entry, is_new] = known.try_emplace(nodes_of(c), constraints_.size());
    if (is_new) {
      constraints_.push_back(c);
    } else {
      LayerConstraint<Real>& before = constraints_[entry->second];
      c.pressed = std::max(0.0, before.push(move));
      c.stiffness = before.stiffness;
      before = c;
    }
    for (const std::size_t node : c.coupling.node) stiffer[node] = 1;
  }
  stiffness_.stiffen(stiffer);
  return true;
}

template <class Real>
void LayerContacts<Real>::adapt(kernels::Components<const Real> move) {
  stiffness_.begin_adapting();
  for (const LayerConstraint<Real>& c : constraints_) {
    const double part = c.acts ? 1 + (c.room(move) - (c.gap - c.wanted)) / c.gap : 1;
    stiffness_.keeps(part, c.coupling.node, c.coupling.weight);
  }
  for (const std::size_t node : struck_) stiffness_.struck(node);
  stiffness_.adapt();
}

template <class Real>
void LayerContacts<Real>::finish(kernels::Components<const Real> move) {
  adapt(move);
  struck_.clear();
  held_.clear();
  forces_.clear();
  for (const LayerConstraint<Real>& c : constraints_) {
    if (!c.acts) continue;
    c.for_each_node([&](std::size_t node, double) { held_.push_back(node); });
    const double force = c.push(move);
    const Vec3 friction = c.rub(move);
    if (force > 0) forces_.push_back({c.key, std::min(force, c.lasting), friction, c.between_cloths()});
    if (!c.between_cloths()) continue;
    const Vec3 impulse = substep_.seconds * (force * c.normal + friction);
    for (std::size_t i = 0; i < 4; ++i) given_[c.coupling.node[i]] += c.coupling.weight[i] * impulse;
  }
  std::sort(forces_.begin(), forces_.end(), [](const PairForce& a, const PairForce& b) {
    return std::tie(a.pair, a.force) < std::tie(b.pair, b.force);
  });
}

template <class Real>
void LayerContacts<Real>::resolve(Particles<Real>& particles, const Substep& substep) {
  struck_.clear();
  held_.clear();
  if (substep.from == 0) given_.assign(given_.size(), Vec3(0, 0, 0));
  impulses_.resolve(particles, substep, pairs_, given_);
}

template class LayerContacts<float>;
template class LayerContacts<double>;

}  // namespace weft
