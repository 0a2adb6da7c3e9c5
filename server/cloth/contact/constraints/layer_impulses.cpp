/// LayerContacts in an explicit substep.
#include <algorithm>
#include <cmath>

#include "cloth/contact/constraints/layer_contacts.h"
#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// What separates slower in an explicit substep is slowed, m/s, as much as bears a layer's own weight at that
/// speed. Undamped, two of 18 small heaps of XPBD were awake after 20 s, and with this one of them.
constexpr double kSlowlyApart = 0.04;

}  // namespace

template <class Real>
void LayerContacts<Real>::move_others(const Substep& substep) {
  if (substep.from == 0) {
    others_.clear();
    for (const LayerPair& pair : pairs_) {
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
  for (Other& each : others_) {
    if (each.inverse_mass > 0) each.velocity += substep.seconds * nodes_->support[each.node];
    each.position += substep.seconds * each.velocity;
  }
}

template <class Real>
void LayerContacts<Real>::resolve(Particles<Real>& particles, const Substep& substep) {
  struck_.clear();
  held_.clear();
  const auto position = kernels::components(particles.position),
             velocity = kernels::components(particles.velocity);
  move_others(substep);
  if (substep.from == 0) {
    read_masses(particles);
    given_.assign(given_.size(), Vec3(0, 0, 0));
  }
  const double part = 1 - std::pow(1 - kLayersLedApart, substep.to - substep.from);
  const double slowed = 1 - std::exp(-standard_gravity().norm() / kSlowlyApart * substep.seconds);
  for (const LayerPair& pair : pairs_) {
    FourPoints x, v;
    std::array<double, 4> inverse_mass;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t n = pair.features.node[i];
      if (own(n)) {
        x[i] = particles.place + at<Real>(position, n - first_);
        v[i] = at<Real>(velocity, n - first_);
        inverse_mass[i] = own_.inverse_mass[n - first_];
      } else {
        const Other& each = other(n);
        x[i] = each.position;
        v[i] = each.velocity;
        inverse_mass[i] = each.inverse_mass;
      }
    }
    const Nearness near = nearness(pair.features.kind, x);
    // As they lie now: in folds they may have turned since the step began.
    const Vec3 normal = contact_normal(pair.features.kind, x, near);
    const double distance = normal.dot(near.apart);
    if (distance == 0 || distance >= pair.gap) continue;
    double share = 0;  // inverse mass along the normal
    Vec3 relative(0, 0, 0);
    for (std::size_t i = 0; i < 4; ++i) {
      const double w = near.weight[i];
      share += w * w * inverse_mass[i];
      relative += w * v[i];
    }
    if (share == 0) continue;
    const double away = relative.dot(normal), approach = std::max(0.0, -away);
    Vec3 impulse(0, 0, 0), rubbed(0, 0, 0);
    if (away > 0 && away < kSlowlyApart) impulse = -slowed * away / share * normal;
    if (approach > 0) {
      const Vec3 sliding = across(relative, normal);
      const double speed = sliding.norm();
      impulse = approach / share * normal;
      if (speed > 0) rubbed = -std::min(parameters_.friction * approach / speed, 1.0) / share * sliding;
      impulse += rubbed;
    }
    // Back by as much as they came nearer in the substep, and a part of what they lack; and by what friction
    // did not let them slide: what sticks would creep else, at g h.
    const double apart =
        std::min(pair.gap - distance, approach * substep.seconds + part * (pair.gap - distance));
    const Vec3 push = apart / share * normal + substep.seconds * rubbed;
    const bool between_cloths = own(pair.features.node[0]) != own(pair.features.node[2]);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t n = pair.features.node[i];
      const double w = near.weight[i] * inverse_mass[i];
      if (w == 0) continue;
      if (own(n)) {
        if (between_cloths) given_[n - first_] += near.weight[i] * impulse;
        add(velocity, n - first_, w * impulse);
        add(position, n - first_, w * push);
      } else {
        other(n).velocity += w * impulse;
        other(n).position += w * push;
      }
    }
  }
  if (substep.from == 0) substep_net_.begin_step(*nodes_, own_.inverse_mass, *found_, first_, end_);
  substep_net_.apply(particles, substep);
}

template void LayerContacts<float>::move_others(const Substep&);
template void LayerContacts<float>::resolve(Particles<float>&, const Substep&);
template void LayerContacts<double>::move_others(const Substep&);
template void LayerContacts<double>::resolve(Particles<double>&, const Substep&);

}  // namespace weft
