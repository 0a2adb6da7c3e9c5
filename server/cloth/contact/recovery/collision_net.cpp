#include "cloth/contact/recovery/collision_net.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Dense>

namespace weft {
namespace {

/// Rounds of impulses before zones are made; and in all.
constexpr int kImpulseRounds = 8, kRounds = 60;
/// Pairs that come as near as so many gaps are looked at; and are found, so that nodes may be moved.
constexpr double kInSight = 1.5, kMargin = 8;
/// Mass of a pinned node to that of a free one, in a rigid zone.
constexpr double kPinnedMass = 1e3;

}  // namespace

bool CollisionNet::meets(const FeaturePair& pair, const LayerNodes& nodes) const {
  FourPoints start, move;
  for (std::size_t i = 0; i < 4; ++i) {
    start[i] = nodes.start[pair.node[i]];
    move[i] = nodes.end[pair.node[i]] - start[i];
  }
  return first_contact(pair.kind, pair.distance, start, move, gap_).has_value();
}

bool CollisionNet::push_apart(const FeaturePair& pair, LayerNodes& nodes) {
  FourPoints start, move;
  for (std::size_t i = 0; i < 4; ++i) {
    start[i] = nodes.start[pair.node[i]];
    move[i] = nodes.end[pair.node[i]] - start[i];
  }
  const auto time = first_contact(pair.kind, pair.distance, start, move, gap_);
  if (!time) return false;
  FourPoints points;
  for (std::size_t i = 0; i < 4; ++i) points[i] = start[i] + *time * move[i];
  const Nearness near = nearness(pair.kind, points);
  const double distance = near.apart.norm();
  double share = 0, largest = 0;
  Vec3 moved(0, 0, 0);
  for (std::size_t i = 0; i < 4; ++i) {
    const double w = near.weight[i] * nodes.inverse_mass[pair.node[i]];
    share += near.weight[i] * w;
    largest = std::max(largest, std::abs(w));
    moved += near.weight[i] * move[i];
  }
  if (share == 0 || distance == 0) return true;
  // None goes farther than what is lacking. Of equal masses none would; but where only a node of a small
  // weight can move, beside pinned ones, it would go by the inverse of that, and on from pair to pair.
  share = std::max(share, largest);
  const Vec3 normal = near.apart / distance;
  // From the meeting on they are not to approach; and with a little room, so that they do not meet again.
  const double room = std::max(distance / 2, (2 * gap_ - distance) / 4);
  const double lack = room - (1 - *time) * moved.dot(normal);
  if (lack <= 0) return true;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t n = pair.node[i];
    const double w = near.weight[i] * nodes.inverse_mass[n];
    if (w == 0) continue;
    nodes.end[n] += w * lack / share * normal;
    changing_[n] = 1;
  }
  return true;
}

bool CollisionNet::apply(FeatureSearch& search, LayerNodes& nodes) {
  const std::size_t count = nodes.start.size();
  const std::vector<FeaturePair>* pairs = &search.found(nodes, kInSight * gap_, kMargin * gap_);
  if (pairs->empty()) return false;
  untouched_ = nodes.end;
  changed_.assign(count, 1);
  zone_.clear();
  for (int round = 0; round < kRounds; ++round) {
    changing_.assign(count, 0);
    const bool zones = round >= kImpulseRounds;
    bool met = false;
    for (const FeaturePair& pair : *pairs) {
      const auto changed = [&](std::uint32_t n) { return changed_[n] != 0 || changing_[n] != 0; };
      if (std::none_of(pair.node.begin(), pair.node.end(), changed)) continue;
      if (!zones) {
        met = push_apart(pair, nodes) || met;
      } else if (!one_zone(pair) && meets(pair, nodes)) {
        met = true;
        join(pair);
      }
    }
    if (!met) return round > 0;
    if (zones) move_zones(nodes);
    changed_.swap(changing_);
    const std::size_t searches = search.searches();
    pairs = &search.found(nodes, kInSight * gap_, kMargin * gap_);
    if (search.searches() != searches) changed_.assign(count, 1);
  }
  nodes.end = nodes.start;
  return true;
}

std::uint32_t CollisionNet::root(std::uint32_t node) {
  while (zone_[node] != node) node = zone_[node] = zone_[zone_[node]];
  return node;
}

bool CollisionNet::one_zone(const FeaturePair& pair) {
  return !zone_.empty() && root(pair.node[1]) == root(pair.node[0]) &&
         root(pair.node[2]) == root(pair.node[0]) && root(pair.node[3]) == root(pair.node[0]);
}

void CollisionNet::join(const FeaturePair& pair) {
  if (zone_.empty()) {
    zone_.resize(changed_.size());
    std::iota(zone_.begin(), zone_.end(), 0U);
  }
  for (std::size_t i = 1; i < 4; ++i) {
    const std::uint32_t a = root(pair.node[0]), b = root(pair.node[i]);
    zone_[std::max(a, b)] = std::min(a, b);
  }
  changing_[root(pair.node[0])] = 1;
}

void CollisionNet::move_zones(LayerNodes& nodes) {
  std::vector<std::uint32_t> members;
  for (std::uint32_t i = 0; i < zone_.size(); ++i) {
    if (zone_[i] != i || root(i) != i) members.push_back(i);
  }
  // Roots with members are members, too.
  const std::size_t others = members.size();
  for (std::size_t i = 0; i < others; ++i) members.push_back(root(members[i]));
  std::sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t ra = root(a), rb = root(b);
    return ra != rb ? ra < rb : a < b;
  });
  members.erase(std::unique(members.begin(), members.end()), members.end());
  const std::vector<char> grown = changing_;
  std::vector<std::uint32_t> zone;
  for (std::size_t i = 0; i < members.size();) {
    const std::uint32_t r = root(members[i]);
    zone.clear();
    bool any = false;
    for (; i < members.size() && root(members[i]) == r; ++i) {
      zone.push_back(members[i]);
      any = any || grown[members[i]] != 0;
    }
    if (any) move_rigidly(zone, nodes);
  }
}

void CollisionNet::move_rigidly(const std::vector<std::uint32_t>& zone, LayerNodes& nodes) {
  double mass = 0, largest = 0;
  for (const std::uint32_t n : zone) {
    if (nodes.inverse_mass[n] > 0) largest = std::max(largest, 1 / nodes.inverse_mass[n]);
  }
  const auto mass_of = [&](std::uint32_t n) {
    return nodes.inverse_mass[n] > 0 ? 1 / nodes.inverse_mass[n] : kPinnedMass * std::max(largest, 1.0);
  };
  Vec3 centre(0, 0, 0), move(0, 0, 0);
  for (const std::uint32_t n : zone) {
    mass += mass_of(n);
    centre += mass_of(n) * nodes.start[n];
    move += mass_of(n) * (nodes.end[n] - nodes.start[n]);
  }
  centre /= mass;
  move /= mass;
  Vec3 momentum(0, 0, 0);
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (const std::uint32_t n : zone) {
    const Vec3 arm = nodes.start[n] - centre, way = nodes.end[n] - nodes.start[n];
    momentum += mass_of(n) * arm.cross(way);
    inertia += mass_of(n) * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }
  // A zone on a line does not turn about it.
  inertia += 1e-9 * inertia.trace() * Eigen::Matrix3d::Identity();
  Vec3 turn(0, 0, 0);
  if (inertia.trace() > 0) turn = inertia.inverse() * momentum;
  const double angle = std::min(turn.norm(), 1.0);  // rad
  const Eigen::Matrix3d rotation = angle > 0 ? Eigen::AngleAxisd(angle, turn.normalized()).toRotationMatrix()
                                             : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  for (const std::uint32_t n : zone) {
    nodes.end[n] = centre + move + rotation * (nodes.start[n] - centre);
    changing_[n] = 1;
  }
}

}  // namespace weft
