/// The pairs: which features each cloth's step is given.
#include <algorithm>
#include <numbers>
#include <optional>
#include <utility>

#include "cloth/world/cloth.h"
#include "cloth/world/cloth_contact.h"

namespace weft {
namespace {

/// Nearer features may have passed through each other by rounding, m.
constexpr double kTouching = 1e-6;

/// A cloth that moves faster wakes a sleeping one that it touches, m/s.
constexpr double kRousing = 0.01;

/// Explicit substeps hold all pairs within this times their gap: beyond a triangle's rim the distance of a
/// node is its height (contact_normal), which may be smaller by this factor. If only the nearest pairs by
/// velocity were held, as in implicit steps, those that pressed in the step before would be missed.
constexpr double kAslant = std::numbers::sqrt2;

/// Most pairs of edges that are held of those that begin at one node: bounds memory.
constexpr std::uint16_t kMostEdges = 128;

/// The features as they will lie, or, if they would pass through each other, as they meet: what slides past
/// something on its way does not touch it. And how far apart they end, m.
std::pair<LayerPair, double> foreseen(const FeaturePair& features, const LayerNodes& nodes, double net_gap) {
  std::pair<LayerPair, double> result;
  auto& [pair, distance] = result;
  pair.features = features;
  const FourPoints ends = points_of(features, nodes.end);
  FourPoints points = points_of(features, nodes.start);
  const FourPoints way{ends[0] - points[0], ends[1] - points[1], ends[2] - points[2], ends[3] - points[3]};
  const auto meet = first_contact(features.kind, features.distance, points, way, net_gap);
  for (std::size_t i = 0; i < 4; ++i) points[i] += meet.value_or(1) * way[i];
  pair.near = nearness(features.kind, points);
  pair.normal = contact_normal(features.kind, points, pair.near);
  for (std::size_t i = 0; i < 4; ++i) distance += pair.near.weight[i] * pair.normal.dot(ends[i]);
  return result;
}

/// Of each node and side of its sheet the pair that ends nearest.
class NearestPairs {
 public:
  explicit NearestPairs(std::size_t nodes) : slots_(2 * nodes, -1) {}

  void add(const LayerPair& pair, double distance) {
    int& slot = slots_[2 * std::size_t{pair.features.node[0]} + static_cast<std::size_t>(pair.side)];
    if (slot < 0) {
      slot = static_cast<int>(found_.size());
      found_.emplace_back(pair, distance);
    } else if (distance < found_[static_cast<std::size_t>(slot)].second) {
      found_[static_cast<std::size_t>(slot)] = {pair, distance};
    }
  }
  const std::vector<std::pair<LayerPair, double>>& found() const { return found_; }

 private:
  std::vector<int> slots_;  ///< by node and side; -1: none
  std::vector<std::pair<LayerPair, double>> found_;
};

}  // namespace

template <class Real>
std::size_t ClothContact<Real>::sheet_of(std::uint32_t node) const {
  return static_cast<std::size_t>(std::upper_bound(nodes_.first.begin(), nodes_.first.end(), node) -
                                  nodes_.first.begin()) -
         1;
}

template <class Real>
bool ClothContact<Real>::rouses(const LayerPair& pair) const {
  return std::any_of(pair.features.node.begin(), pair.features.node.end(),
                     [&](std::uint32_t n) { return nodes_.velocity[n].norm() > kRousing; });
}

template <class Real>
double ClothContact<Real>::pass(const LayerPair& pair) const {
  Vec3 relative(0, 0, 0);
  for (std::size_t i = 0; i < 4; ++i)
    relative += pair.near.weight[i] * nodes_.velocity[pair.features.node[i]];
  const std::size_t one = sheet_of(pair.features.node[0]), other = sheet_of(pair.features.node[2]);
  return relative.norm() / std::min(cells_[one], cells_[other]);
}

template <class Real>
void ClothContact<Real>::find_pairs(std::vector<Cloth<Real>>& cloths, double dt) {
  const auto implicitly = [&](std::size_t sheet) { return cloths[sheet].steps_implicitly(); };
  DisjointSets islands(cloths.size());
  pairs_.clear();
  // For those of its cloths that step so.
  const auto add = [&](const LayerPair& pair, bool for_implicit) {
    pairs_.push_back({pair, for_implicit});
    const std::size_t one = sheet_of(pair.features.node[0]), other = sheet_of(pair.features.node[2]);
    if (other == one) return;
    cells_passed_ = std::max(cells_passed_, pass(pair));
    islands.join(one, other);
    if (for_implicit != implicitly(one) && for_implicit != implicitly(other)) return;
    for (const std::size_t sheet : {one, other}) {
      if (cloths[sheet].asleep() && rouses(pair)) cloths[sheet].wake();
    }
  };
  cells_passed_ = 0;
  bool all_implicit = true;
  for (std::size_t i = 0; i < cloths.size(); ++i) all_implicit = all_implicit && implicitly(i);
  const double widest = (all_implicit ? 1 : kAslant) * *std::max_element(gaps_.begin(), gaps_.end());
  const double drop = standard_gravity().norm() * dt * dt;
  NearestPairs nearest(nodes_.start.size());
  std::vector<LayerPair> edges;
  std::vector<std::uint16_t> of_node(nodes_.start.size());
  for (const FeaturePair& features : search_.find(nodes_, widest + drop)) {
    const std::size_t one = sheet_of(features.node[0]), other = sheet_of(features.node[2]);
    if (features.distance < kTouching) may_be_tangled_ = true;
    auto [pair, distance] = foreseen(features, nodes_, net_.gap());
    pair.gap = std::min(gaps_[one], gaps_[other]);
    const bool node_on_triangle = features.kind == FeaturePair::Kind::node_triangle;
    if (!node_on_triangle) pair.gap *= kEdgePart;
    const bool explicitly = !implicitly(one) || !implicitly(other);
    if ((explicitly ? std::min(distance, features.distance) : distance) - drop > pair.gap) continue;
    if (node_on_triangle) {
      if (explicitly) add(pair, false);
      if (!implicitly(one) && !implicitly(other)) continue;
      pair.side = side_of_sheet(grids_[one], nodes_.start.data() + nodes_.first[one],
                                features.node[0] - nodes_.first[one], pair.normal, torn_[one].get());
      nearest.add(pair, distance);
    } else if (of_node[features.node[0]]++ < kMostEdges) {
      edges.push_back(pair);
    } else {
      crowded_[one] = 1;
    }
  }
  for (std::size_t i = 0; i < cloths.size(); ++i) {
    if (search_.crowded(i)) crowded_[i] = 1;
  }
  for (const auto& [pair, distance] : nearest.found()) add(pair, true);
  for (const LayerPair& pair : edges) {
    add(pair, true);
    add(pair, false);
  }
  let_sleep(cloths, islands);
}

template <class Real>
void ClothContact<Real>::make_groups(std::vector<Cloth<Real>>& cloths, const std::vector<char>& steps) {
  const auto implicitly = [&](std::size_t sheet) { return cloths[sheet].steps_implicitly(); };
  const auto together = [&](std::size_t sheet) { return steps[sheet] != 0 && implicitly(sheet); };
  DisjointSets joined(cloths.size());
  for (const FoundPair& found : pairs_) {
    const std::size_t one = sheet_of(found.pair.features.node[0]),
                      other = sheet_of(found.pair.features.node[2]);
    if (found.implicitly && one != other && together(one) && together(other)) joined.join(one, other);
  }
  std::vector<std::vector<std::size_t>> groups;
  std::vector<std::optional<std::size_t>> group_of_set(cloths.size());
  for (std::size_t i = 0; i < cloths.size(); ++i) {
    std::optional<std::size_t>& group = group_of_set[joined.of(i)];
    if (!group) {
      group = groups.size();
      groups.emplace_back();
    }
    groups[*group].push_back(i);
  }
  if (groups != groups_) set_groups(std::move(groups), cloths);
  std::vector<std::vector<LayerPair>> shares(groups_.size());
  for (const FoundPair& found : pairs_) {
    const std::size_t one = sheet_of(found.pair.features.node[0]),
                      other = sheet_of(found.pair.features.node[2]);
    if (implicitly(one) == found.implicitly) shares[place_[one].group].push_back(found.pair);
    if (place_[one].group != place_[other].group && implicitly(other) == found.implicitly)
      shares[place_[other].group].push_back(found.pair);
  }
  for (std::size_t i = 0; i < groups_.size(); ++i) contacts_[i]->set_pairs(std::move(shares[i]));
}

template <class Real>
void ClothContact<Real>::set_groups(std::vector<std::vector<std::size_t>> groups,
                                    std::vector<Cloth<Real>>& cloths) {
  auto before = std::exchange(contacts_, {});
  const auto groups_before = std::exchange(groups_, std::move(groups));
  place_.resize(cloths.size());
  for (std::size_t group = 0; group < groups_.size(); ++group) {
    const auto same = std::find(groups_before.begin(), groups_before.end(), groups_[group]);
    if (same != groups_before.end()) {
      contacts_.push_back(std::move(before[static_cast<std::size_t>(same - groups_before.begin())]));
      for (const std::size_t cloth : groups_[group]) place_[cloth].group = group;
      continue;
    }
    std::vector<LayerParts::Part> parts;
    parts.reserve(groups_[group].size());
    for (const std::size_t cloth : groups_[group]) {
      parts.push_back({grids_[cloth], nodes_.first[cloth], gaps_[cloth]});
    }
    contacts_.push_back(std::make_unique<LayerContacts<Real>>(
        nodes_, search_, LayerParts(std::move(parts)), LayerParameters{net_.gap(), parameters_.friction}));
    LayerContacts<Real>& contacts = *contacts_.back();
    for (std::size_t part = 0; part < groups_[group].size(); ++part) {
      const std::size_t cloth = groups_[group][part];
      place_[cloth] = {group, part};
      if (torn_[cloth] != nullptr) contacts.set_torn(part, torn_[cloth]);
      cloths[cloth].set_layers(&contacts, part);
    }
    for (const auto& old : before) {
      if (old != nullptr) contacts.take_over(*old);
    }
  }
}

template <class Real>
void ClothContact<Real>::let_sleep(std::vector<Cloth<Real>>& cloths, DisjointSets& islands) const {
  std::vector<std::size_t> size(cloths.size(), 0), quiet(cloths.size(), 0);
  for (std::size_t i = 0; i < cloths.size(); ++i) {
    ++size[islands.of(i)];
    if (cloths[i].quiet()) ++quiet[islands.of(i)];
  }
  for (std::size_t i = 0; i < cloths.size(); ++i) {
    const std::size_t island = islands.of(i);
    cloths[i].set_company(size[island] == 1               ? Sleep::Company::none
                          : quiet[island] == size[island] ? Sleep::Company::quiet
                                                          : Sleep::Company::restless);
  }
}

template std::size_t ClothContact<float>::sheet_of(std::uint32_t) const;
template bool ClothContact<float>::rouses(const LayerPair&) const;
template double ClothContact<float>::pass(const LayerPair&) const;
template void ClothContact<float>::find_pairs(std::vector<Cloth<float>>&, double);
template void ClothContact<float>::make_groups(std::vector<Cloth<float>>&, const std::vector<char>&);
template void ClothContact<float>::set_groups(std::vector<std::vector<std::size_t>>,
                                              std::vector<Cloth<float>>&);
template void ClothContact<float>::let_sleep(std::vector<Cloth<float>>&, DisjointSets&) const;
template std::size_t ClothContact<double>::sheet_of(std::uint32_t) const;
template bool ClothContact<double>::rouses(const LayerPair&) const;
template double ClothContact<double>::pass(const LayerPair&) const;
template void ClothContact<double>::find_pairs(std::vector<Cloth<double>>&, double);
template void ClothContact<double>::make_groups(std::vector<Cloth<double>>&, const std::vector<char>&);
template void ClothContact<double>::set_groups(std::vector<std::vector<std::size_t>>,
                                               std::vector<Cloth<double>>&);
template void ClothContact<double>::let_sleep(std::vector<Cloth<double>>&, DisjointSets&) const;

}  // namespace weft
