#include "cloth/contact/constraints/layer_impulses.h"

#include <algorithm>
#include <cmath>

#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// What separates slower in an explicit substep is slowed, m/s, as much as bears a layer's own weight at that
/// speed. Undamped, two of 18 small heaps of XPBD were awake after 20 s, and with this one of them.
constexpr double kSlowlyApart = 0.04;

}  // namespace

template <class Real>
LayerImpulses<Real>::LayerImpulses(const LayerNodes& nodes, const FeatureSearch& found, const Grid& grid,
                                   std::uint32_t first, const LayerParameters& parameters)
    : nodes_(&nodes),
      found_(&found),
      first_(first),
      end_(first + static_cast<std::uint32_t>(grid.size())),
      friction_(parameters.friction),
      substep_net_(grid, parameters.net_gap) {}

template <class Real>
void LayerImpulses<Real>::resolve(Particles<Real>& particles, const Substep& substep,
                                  const std::vector<LayerPair>& pairs, std::vector<Vec3>& given) {
  if (substep.from == 0) {
    find_others(pairs);
    // Not LayerNodes': to others the cloth stood still as the step began, though it may have woken in it.
    const auto& values = particles.inverse_mass.values();
    inverse_mass_.assign(values.begin(), values.end());
  }
  move_others(substep);
  const Shares shares{layers_led_apart(substep),
                      1 - std::exp(-standard_gravity().norm() / kSlowlyApart * substep.seconds)};
  for (const LayerPair& pair : pairs) {
    const Ends ends = ends_of(pair, particles);
    const Nearness near = nearness(pair.features.kind, ends.position);
    // As they lie now: in folds they may have turned since the step began.
    const Vec3 normal = contact_normal(pair.features.kind, ends.position, near);
    const double distance = normal.dot(near.apart);
    if (distance == 0 || distance >= pair.gap) continue;
    PairShare share;
    for (std::size_t i = 0; i < 4; ++i) share.add(near.weight[i], ends.inverse_mass[i]);
    if (share.sum == 0) continue;
    const Hit each = hit(ends, near, {normal, share.bounded(), pair.gap - distance}, shares, substep.seconds);
    give(each, pair, near, ends, particles, given);
  }
  if (substep.from == 0) substep_net_.begin_step(*nodes_, inverse_mass_, *found_, first_, end_);
  substep_net_.apply(particles, substep);
}

template <class Real>
void LayerImpulses<Real>::find_others(const std::vector<LayerPair>& pairs) {
  others_.clear();
  for (const LayerPair& pair : pairs) {
    for (const std::uint32_t n : pair.features.node) {
      if (own(n)) continue;
      const double inverse_mass = nodes_->lies[n] != 0 ? 0.0 : nodes_->inverse_mass[n];
      others_.push_back({n, nodes_->start[n], nodes_->velocity[n], inverse_mass});
    }
  }
  std::sort(others_.begin(), others_.end(), [](const Other& a, const Other& b) { return a.node < b.node; });
  others_.erase(std::unique(others_.begin(), others_.end(),
                            [](const Other& a, const Other& b) { return a.node == b.node; }),
                others_.end());
}

template <class Real>
void LayerImpulses<Real>::move_others(const Substep& substep) {
  for (Other& each : others_) {
    if (each.inverse_mass > 0) each.velocity += substep.seconds * nodes_->support[each.node];
    each.position += substep.seconds * each.velocity;
  }
}

template <class Real>
auto LayerImpulses<Real>::other(std::uint32_t node) -> Other& {
  return *std::lower_bound(others_.begin(), others_.end(), node,
                           [](const Other& each, std::uint32_t n) { return each.node < n; });
}

template <class Real>
auto LayerImpulses<Real>::ends_of(const LayerPair& pair, const Particles<Real>& particles) -> Ends {
  const auto position = kernels::components(particles.position),
             velocity = kernels::components(particles.velocity);
  Ends ends;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t n = pair.features.node[i];
    if (own(n)) {
      ends.position[i] = particles.place + at(position, n - first_);
      ends.velocity[i] = at(velocity, n - first_);
      ends.inverse_mass[i] = inverse_mass_[n - first_];
    } else {
      const Other& each = other(n);
      ends.position[i] = each.position;
      ends.velocity[i] = each.velocity;
      ends.inverse_mass[i] = each.inverse_mass;
    }
  }
  return ends;
}

template <class Real>
auto LayerImpulses<Real>::hit(const Ends& ends, const Nearness& near, const Touching& touching,
                              const Shares& shares, double h) const -> Hit {
  const Vec3& normal = touching.normal;
  Vec3 relative(0, 0, 0);
  for (std::size_t i = 0; i < 4; ++i) relative += near.weight[i] * ends.velocity[i];
  const double away = relative.dot(normal), approach = std::max(0.0, -away);
  Vec3 impulse(0, 0, 0), rubbed(0, 0, 0);
  if (away > 0 && away < kSlowlyApart) impulse = -shares.slowed * away / touching.share * normal;
  if (approach > 0) {
    const Vec3 sliding = across(relative, normal);
    const double speed = sliding.norm();
    impulse = approach / touching.share * normal;
    if (speed > 0) rubbed = -std::min(friction_ * approach / speed, 1.0) / touching.share * sliding;
    impulse += rubbed;
  }
  // Back by as much as they came nearer in the substep, and a part of what they lack; and by what friction
  // did not let them slide: what sticks would creep else, at g h.
  const double apart = std::min(touching.lack, approach * h + shares.led_apart * touching.lack);
  return {impulse, apart / touching.share * normal + h * rubbed};
}

template <class Real>
void LayerImpulses<Real>::give(const Hit& hit, const LayerPair& pair, const Nearness& near, const Ends& ends,
                               Particles<Real>& particles, std::vector<Vec3>& given) {
  const auto position = kernels::components(particles.position),
             velocity = kernels::components(particles.velocity);
  const bool between_cloths = own(pair.features.node[0]) != own(pair.features.node[2]);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t n = pair.features.node[i];
    const double w = near.weight[i] * ends.inverse_mass[i];
    if (w == 0) continue;
    if (own(n)) {
      if (between_cloths) given[n - first_] += near.weight[i] * hit.impulse;
      add(velocity, n - first_, w * hit.impulse);
      add(position, n - first_, w * hit.push);
    } else {
      other(n).velocity += w * hit.impulse;
      other(n).position += w * hit.push;
    }
  }
}

template class LayerImpulses<float>;
template class LayerImpulses<double>;

}  // namespace weft
