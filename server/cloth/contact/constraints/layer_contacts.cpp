#include "cloth/contact/constraints/layer_contacts.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>

#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// The least distance at which layers that would pass through each other are held, in their own gap.
constexpr double kMeetingPart = 0.4;

}  // namespace

template <class Real>
LayerContacts<Real>::LayerContacts(const LayerNodes& nodes, const FeatureSearch& found,
                                   const LayerParts& parts, const LayerParameters& parameters)
    : nodes_(&nodes),
      found_(&found),
      parts_(parts),
      parameters_(parameters),
      stiffness_(parts.nodes()),
      given_(parts.nodes(), Vec3(0, 0, 0)),
      meeting_(parts, parameters),
      impulses_(nodes, found, parts[0].grid, parts[0].first, parameters) {}

template <class Real>
void LayerContacts<Real>::take_over(const LayerContacts& before) {
  for (const LayerParts::Part& part : parts_) {
    const auto same = std::find_if(before.parts_.begin(), before.parts_.end(),
                                   [&](const LayerParts::Part& p) { return p.first == part.first; });
    if (same == before.parts_.end()) continue;
    const auto count = static_cast<std::uint32_t>(part.grid.size());
    stiffness_.take_over(before.stiffness_, same->offset, part.offset, count);
    std::copy_n(before.given_.begin() + same->offset, count, given_.begin() + part.offset);
    for (const auto list : {&LayerContacts::struck_, &LayerContacts::held_}) {
      for (const std::uint32_t node : before.*list) {
        if (node >= same->offset && node - same->offset < count)
          (this->*list).push_back(node - same->offset + part.offset);
      }
    }
    std::copy_if(before.forces_.begin(), before.forces_.end(), std::back_inserter(forces_),
                 [&](const PairForce& f) { return f.pair[0] >= part.first && f.pair[0] < part.end(); });
  }
  sort_forces();
}

template <class Real>
void LayerContacts<Real>::sort_forces() {
  std::sort(forces_.begin(), forces_.end(), [](const PairForce& a, const PairForce& b) {
    return std::tie(a.pair, a.force) < std::tie(b.pair, b.force);
  });
}

template <class Real>
void LayerContacts<Real>::set_torn(std::size_t part, const std::shared_ptr<const TornLinks>& torn) {
  meeting_.set_torn(part, torn);
  if (part == 0) impulses_.set_torn(*torn);
}

template <class Real>
bool LayerContacts<Real>::meets_others() const {
  const bool alone = nodes_->first.size() == 2;
  return !alone && (!struck_.empty() || std::any_of(pairs_.begin(), pairs_.end(), [&](const LayerPair& pair) {
    const auto one = parts_.part_of(pair.features.node[0]), other = parts_.part_of(pair.features.node[2]);
    return !one || one != other;
  }));
}

template <class Real>
bool LayerContacts<Real>::meets_outsiders() const {
  const bool all = nodes_->first.size() == parts_.size() + 1;
  return (!all && !struck_.empty()) || std::any_of(pairs_.begin(), pairs_.end(), [&](const LayerPair& pair) {
           return !parts_.part_of(pair.features.node[0]) || !parts_.part_of(pair.features.node[2]);
         });
}

template <class Real>
std::array<std::size_t, 4> LayerContacts<Real>::joined(const LayerConstraint<Real>& constraint) const {
  std::array<std::size_t, 4> nodes{};
  for (std::size_t i = 0; i < 4; ++i)
    nodes[i] = parts_[constraint.coupling.part[i]].offset + constraint.coupling.node[i];
  return nodes;
}

template <class Real>
void LayerContacts<Real>::add_to(std::span<const LayerSystem<Real>> systems, SystemCouplings<Real>& between) {
  std::vector<kernels::Components<const Real>> move;
  move.reserve(systems.size());
  for (const LayerSystem<Real>& system : systems) move.push_back(system.move);
  for (LayerConstraint<Real>& c : constraints_) {
    PairShare share;
    c.for_each_node([&](std::size_t part, std::size_t node, double w) {
      share.add(w, 1 / double(systems[part].diagonal[node]));
    });
    if (share.sum == 0) continue;
    c.stiffness = static_cast<double>(stiffness_.of(joined(c), c.coupling.weight)) / share.bounded();
    c.stiffness = 1 / (1 / c.stiffness + 1 / c.inertia);
    c.friction = 0;
    if (!c.acts) continue;
    const double sliding = std::max(0.0, c.sliding + c.gained.lasting());
    const bool slides = c.holds < c.stiffness * sliding;
    if (c.holds > 0) c.friction = slides ? c.holds / sliding : c.stiffness;
    if (slides) c.grip.setZero();
    const Vec3 force = c.push(move) * c.normal + c.rub(move);
    c.for_each_node(
        [&](std::size_t part, std::size_t node, double w) { add(systems[part].b, node, w * force); });
    c.coupling.stiffness = (c.stiffness - c.friction) * c.normal * c.normal.transpose() +
                           c.friction * Eigen::Matrix3d::Identity();
    if (const auto part = c.only_part()) {
      systems[*part].couplings->add(c.coupling);
    } else {
      between.add(c.coupling);
    }
  }
}

template <class Real>
void LayerContacts<Real>::append_springs(Moves move, Moves change,
                                         std::vector<OneSidedSpring>& springs) const {
  for (const LayerConstraint<Real>& c : constraints_) {
    if (c.stiffness == 0) continue;
    springs.push_back({c.push(move) / c.stiffness, c.spare - c.room(change), c.stiffness, c.acts});
  }
}

template <class Real>
double LayerContacts<Real>::release_pulling(Moves move) {
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
bool LayerContacts<Real>::hold_meeting(Moves position, Moves move) {
  if (constraints_.empty()) return false;
  const std::vector<LayerPair> met = meeting_.find(position);
  if (met.empty()) return false;
  // By the nodes they join, the first where several do. In a crumpled lump thousands of pairs meet among tens
  // of thousands.
  const auto nodes_of = [&](const LayerConstraint<Real>& c) { return std::pair(joined(c), c.edges); };
  std::map<std::pair<std::array<std::size_t, 4>, bool>, std::size_t> known;
  for (std::size_t i = 0; i < constraints_.size(); ++i) known.try_emplace(nodes_of(constraints_[i]), i);
  std::vector<std::uint8_t> stiffer(parts_.nodes(), 0);
  for (const LayerPair& pair : met) {
    LayerConstraint<Real> c = constraint(pair);
    const auto one = parts_.part_of(pair.features.node[0]), other = parts_.part_of(pair.features.node[2]);
    c.wanted = std::max(c.wanted, kMeetingPart * parts_.gap(*one, *other));
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
    for (const std::size_t node : joined(c)) stiffer[node] = 1;
  }
  stiffness_.stiffen(stiffer);
  return true;
}

template <class Real>
void LayerContacts<Real>::adapt(Moves move) {
  stiffness_.begin_adapting();
  for (const LayerConstraint<Real>& c : constraints_) {
    const double part = c.acts ? 1 + (c.room(move) - (c.gap - c.wanted)) / c.gap : 1;
    stiffness_.keeps(part, joined(c), c.coupling.weight);
  }
  for (const std::size_t node : struck_) stiffness_.struck(node);
  stiffness_.adapt();
}

template <class Real>
void LayerContacts<Real>::finish(Moves move) {
  adapt(move);
  struck_.clear();
  held_.clear();
  forces_.clear();
  for (LayerConstraint<Real>& c : constraints_) {
    if (!c.acts) continue;
    const std::array<std::size_t, 4> nodes = joined(c);
    for (std::size_t i = 0; i < 4; ++i) {
      if (c.coupling.weight[i] != 0) held_.push_back(static_cast<std::uint32_t>(nodes[i]));
    }
    const double force = c.push(move);
    const Vec3 friction = c.rub(move);
    c.gained.add(c.slip(move).norm() - c.sliding);
    if (force > 0)
      forces_.push_back({c.key, std::min(force, c.lasting), friction, c.gained, c.between_cloths()});
    if (!c.between_cloths()) continue;
    const Vec3 impulse = substep_.seconds * (force * c.normal + friction);
    for (std::size_t i = 0; i < 4; ++i) given_[nodes[i]] += c.coupling.weight[i] * impulse;
  }
  sort_forces();
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
