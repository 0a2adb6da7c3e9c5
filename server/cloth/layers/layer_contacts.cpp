#include "cloth/layers/layer_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/solver/node_vector.h"

namespace weft {
namespace {

/// Stiffness of a contact, as a multiple of the inertia of the nodes that meet. The least leaves a depth of g
/// h^2 / 50 under a layer's own weight, 55 micrometres at 60 Hz; conjugate gradients take the longer the more
/// it is.
constexpr float kSoft = 50, kStiff = 5000;
/// By how much it changes in a step, and the parts of the gap above and below which it does.
constexpr float kStiffer = 4, kSofter = 0.7F;
constexpr double kKept = 0.8, kHardlyKept = 0.4;
/// Part of what layers lack of their gap that they are led apart in a step.
constexpr double kLedApart = 0.1;

double led(double distance, double gap) {
  return distance < gap ? distance + kLedApart * (gap - distance) : gap;
}

Vec3 across(const Vec3& v, const Vec3& normal) { return v - v.dot(normal) * normal; }

}  // namespace

template <class Real>
LayerContacts<Real>::LayerContacts(const LayerNodes& nodes, std::size_t cloth,
                                   const LayerParameters& parameters)
    : nodes_(nodes),
      first_(nodes.first[cloth]),
      end_(nodes.first[cloth + 1]),
      parameters_(parameters),
      force_(2 * static_cast<std::size_t>(end_ - first_), 0.0F),
      stiffness_(end_ - first_, kSoft),
      strained_(end_ - first_, 0),
      given_(end_ - first_, Vec3(0, 0, 0)) {}

template <class Real>
int LayerContacts<Real>::memory_of(const LayerPair& pair) const {
  const std::uint32_t node = pair.features.node[0];
  if (pair.features.kind != FeaturePair::Kind::node_triangle || !own(node)) return -1;
  return static_cast<int>(2 * (node - first_)) + pair.side;
}

template <class Real>
void LayerContacts<Real>::begin(const Particles<Real>& particles, const Substep& substep) {
  constraints_.clear();
  seconds_ = substep.seconds;
  if (substep.from == 0) given_.assign(given_.size(), Vec3(0, 0, 0));
  const auto position = kernels::components(particles.position),
             velocity = kernels::components(particles.velocity);
  const double past = substep.from * substep.step_seconds(), h = substep.seconds;
  const double drop = standard_gravity().norm() * h * h;
  for (const LayerPair& pair : pairs_) {
    Constraint c;
    c.normal = pair.normal;
    c.memory = memory_of(pair);
    double distance = 0, others = 0, others_share = 0;  // share: inverse mass along the normal
    Vec3 slip(0, 0, 0);
    c.slid.setZero();
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t n = pair.features.node[i];
      const double w = pair.near.weight[i];
      if (own(n)) {
        c.coupling.node[i] = n - first_;
        distance += w * c.normal.dot(at(position, n - first_));
        if (nodes_.inverse_mass[n] == 0) continue;
        c.coupling.weight[i] = w;
        slip += w * h * at(velocity, n - first_);
        continue;
      }
      const Vec3 v = nodes_.velocity[n] + past * nodes_.acceleration[n];
      const Vec3 way = h * (v + h * nodes_.acceleration[n]);
      distance += w * c.normal.dot(nodes_.start[n] + past * v);
      others += w * c.normal.dot(way);
      others_share += w * w * nodes_.inverse_mass[n];
      c.slid += w * way;
    }
    slip += c.slid;
    const double wanted = led(distance, pair.gap), closing = c.normal.dot(slip);
    if (distance + closing - drop > pair.gap) continue;
    c.room = distance + others - wanted;
    c.gap = pair.gap;
    c.kept = pair.gap - wanted;
    c.inertia = others_share > 0 ? 1 / (h * h * others_share) : std::numeric_limits<double>::infinity();
    const float pressed = c.memory >= 0 ? force_[static_cast<std::size_t>(c.memory)] : 0.0F;
    c.acts = pressed > 0 || distance + closing < wanted;
    c.slid = across(c.slid, c.normal);
    c.sliding = across(slip, c.normal).norm();
    c.holds = parameters_.friction * static_cast<double>(pressed);
    constraints_.push_back(c);
  }
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
Vec3 LayerContacts<Real>::force_at(const Constraint& c, kernels::Components<const Real> move) const {
  return -c.stiffness * room(c, move) * c.normal - c.friction * slip(c, move);
}

template <class Real>
void LayerContacts<Real>::add_to(kernels::Components<Real> b, NodeCouplings<Real>& couplings,
                                 const Real* diagonal, kernels::Components<const Real> move) {
  couplings.clear();
  for (Constraint& c : constraints_) {
    double share = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const double w = c.coupling.weight[i];
      if (w != 0) share += w * w / double(diagonal[c.coupling.node[i]]);
    }
    if (!c.acts || share == 0) continue;
    float multiple = kSoft;
    for (std::size_t i = 0; i < 4; ++i) {
      if (c.coupling.weight[i] != 0) multiple = std::max(multiple, stiffness_[c.coupling.node[i]]);
    }
    c.stiffness = static_cast<double>(multiple) / share;
    c.stiffness = 1 / (1 / c.stiffness + 1 / c.inertia);
    c.friction = 0;
    if (c.holds > 0) c.friction = c.holds < c.stiffness * c.sliding ? c.holds / c.sliding : c.stiffness;
    const Vec3 force = force_at(c, move);
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
    springs.push_back({-room(c, move), c.room - room(c, change), c.stiffness, c.acts});
  }
}

template <class Real>
double LayerContacts<Real>::release_pulling(kernels::Components<const Real> move) {
  double energy = 0;
  for (Constraint& c : constraints_) {
    const double beyond = room(c, move);
    if (c.acts != (beyond > 0)) continue;
    c.acts = !c.acts;
    energy += c.stiffness * beyond * beyond / 2;
  }
  return energy;
}

template <class Real>
void LayerContacts<Real>::adapt(kernels::Components<const Real> move) {
  std::fill(strained_.begin(), strained_.end(), 0);
  for (const Constraint& c : constraints_) {
    const double part = c.acts ? 1 + (room(c, move) - c.kept) / c.gap : 1;
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
  std::fill(force_.begin(), force_.end(), 0.0F);
  for (const Constraint& c : constraints_) {
    if (!c.acts) continue;
    const double force = -c.stiffness * room(c, move);
    if (c.memory >= 0 && force > 0) force_[static_cast<std::size_t>(c.memory)] = static_cast<float>(force);
    if (!std::isfinite(c.inertia)) continue;
    const Vec3 impulse = seconds_ * force_at(c, move);
    for (std::size_t i = 0; i < 4; ++i) given_[c.coupling.node[i]] += c.coupling.weight[i] * impulse;
  }
}

template <class Real>
void LayerContacts<Real>::resolve(Particles<Real>& particles, const Substep& substep) {
  struck_.clear();
  const auto position = kernels::components(particles.position),
             velocity = kernels::components(particles.velocity);
  const double past = substep.to * substep.step_seconds();
  const double part = 1 - std::pow(1 - kLedApart, substep.to - substep.from);
  for (const LayerPair& pair : pairs_) {
    FourPoints x, v;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t n = pair.features.node[i];
      if (own(n)) {
        x[i] = at<Real>(position, n - first_);
        v[i] = at<Real>(velocity, n - first_);
      } else {
        v[i] = nodes_.velocity[n];
        x[i] = nodes_.start[n] + past * v[i];
      }
    }
    const Nearness near = nearness(pair.features.kind, x);
    Vec3 normal = contact_normal(pair.features.kind, x, near);
    double distance = normal.dot(near.apart);
    if (distance == 0) continue;
    if (normal.dot(pair.normal) < 0) {  // they have passed each other
      normal = -normal;
      distance = -distance;
    }
    if (distance >= pair.gap) continue;
    double share = 0;  // inverse mass along the normal
    Vec3 relative(0, 0, 0);
    for (std::size_t i = 0; i < 4; ++i) {
      const double w = near.weight[i];
      share += w * w * nodes_.inverse_mass[pair.features.node[i]];
      relative += w * v[i];
    }
    if (share == 0) continue;
    const double approach = std::max(0.0, -relative.dot(normal));
    Vec3 impulse(0, 0, 0);
    if (approach > 0) {
      const Vec3 sliding = across(relative, normal);
      const double speed = sliding.norm();
      impulse = approach / share * normal;
      if (speed > 0) impulse -= std::min(parameters_.friction * approach / speed, 1.0) / share * sliding;
    }
    // Back by as much as they came nearer in the substep, and a part of what they lack.
    const double apart =
        std::min(pair.gap - distance, approach * substep.seconds + part * (pair.gap - distance));
    const Vec3 push = apart / share * normal;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t n = pair.features.node[i];
      const double w = near.weight[i] * nodes_.inverse_mass[n];
      if (!own(n) || w == 0) continue;
      add(velocity, n - first_, w * impulse);
      add(position, n - first_, w * push);
    }
  }
}

template class LayerContacts<float>;
template class LayerContacts<double>;

}  // namespace weft
