/// LayerContacts' constraints as a substep begins.
#include <algorithm>
#include <limits>

#include "cloth/contact/constraints/layer_contacts.h"

namespace weft {
namespace {

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
PairForce LayerContacts<Real>::remembered(const PairKey& key) const {
  const auto found = std::lower_bound(forces_.begin(), forces_.end(), key,
                                      [](const PairForce& f, const PairKey& k) { return f.pair < k; });
  return found != forces_.end() && found->pair == key ? *found : PairForce{.pair = key};
}

template <class Real>
void LayerContacts<Real>::begin(std::span<const Particles<Real>* const> starts, const Substep& substep,
                                bool near_rest) {
  constraints_.clear();
  near_rest_ = near_rest;
  substep_ = substep;
  if (substep.from == 0) given_.assign(given_.size(), Vec3(0, 0, 0));
  meeting_.begin(starts, substep, *nodes_, *found_);
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
  bool others = false;  // nodes of cloth that is stepped apart
  double others_way = 0, others_share = 0;
  PairShare share;
  Vec3 slip(0, 0, 0);
  c.slid.setZero();
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t n = pair.features.node[i];
    const double w = pair.near.weight[i];
    if (const auto part = parts_.part_of(n)) {
      const LayerParts::Part& of = parts_[*part];
      const std::size_t own = n - of.first + of.offset;
      c.coupling.part[i] = *part;
      c.coupling.node[i] = n - of.first;
      const Vec3 &start = ways.start[own], &end = ways.end[own];
      if (ways.inverse_mass[own] == 0) {  // a pin's way is no move of the substep's system
        c.distance += w * c.normal.dot(end);
        continue;
      }
      c.distance += w * c.normal.dot(start);
      c.coupling.weight[i] = w;
      slip += w * h * ways.velocity[own];
      share.add(w, ways.inverse_mass[own]);
      continue;
    }
    const Vec3 v = nodes_->velocity[n] + past * nodes_->acceleration[n];
    const Vec3 way = h * (v + h * nodes_->acceleration[n]);
    c.distance += w * c.normal.dot(nodes_->start[n] + past * v);
    others = true;
    others_way += w * c.normal.dot(way);
    others_share += w * w * nodes_->inverse_mass[n];
    share.add(w, nodes_->inverse_mass[n]);
    c.slid += w * way;
  }
  slip += c.slid;
  c.closing = c.normal.dot(slip);
  c.gap = pair.gap;
  const bool stands_still = others && others_share == 0;
  c.wanted =
      led(c.distance, pair.gap, near_rest_ && !stands_still, share.part() * layers_led_apart(substep_));
  c.spare = c.distance + others_way - c.wanted;
  c.inertia = others_share > 0 ? 1 / (h * h * others_share) : std::numeric_limits<double>::infinity();
  c.slid = across(c.slid, c.normal);
  c.sliding = across(slip, c.normal).norm();
  PairForce last = remembered(c.key);
  if (last.between_cloths != c.between_cloths()) last = {};
  c.gained = last.gained;
  c.memory = c.pressed = last.force;
  if (c.between_cloths()) c.lasting = last.force + standard_gravity().norm() / share.sum;
  c.holds = parameters_.friction * c.memory;
  if (near_rest_) c.grip = across(last.grip, c.normal);
  if (c.grip.squaredNorm() > c.holds * c.holds) c.grip.setZero();
  return c;
}

template PairForce LayerContacts<float>::remembered(const PairKey&) const;
template void LayerContacts<float>::begin(std::span<const Particles<float>* const>, const Substep&, bool);
template LayerConstraint<float> LayerContacts<float>::constraint(const LayerPair&) const;
template PairForce LayerContacts<double>::remembered(const PairKey&) const;
template void LayerContacts<double>::begin(std::span<const Particles<double>* const>, const Substep&, bool);
template LayerConstraint<double> LayerContacts<double>::constraint(const LayerPair&) const;

}  // namespace weft
