#include "cloth/contact/recovery/substep_net.h"

#include <algorithm>

#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// Of impulses, a substep; and own searches, a step.
constexpr int kSubstepRounds = 4, kSearches = 2;
/// In gaps: pairs that come as near are looked at; and are searched.
constexpr double kSubstepSight = 1.5, kSubstepMargin = 10;
/// Part of what they lack of the gap that they are led apart in a substep.
constexpr double kLedApartASubstep = 0.1;

/// Of way(i) over the free nodes.
template <class Way>
Vec3 mean(const LayerNodes& nodes, Way way) {
  Vec3 sum(0, 0, 0);
  double count = 0;
  for (std::size_t i = 0; i < nodes.start.size(); ++i) {
    if (nodes.inverse_mass[i] == 0) continue;
    sum += way(i);
    ++count;
  }
  return count > 0 ? Vec3(sum / count) : sum;
}

}  // namespace

void SubstepNet::begin_step(const LayerNodes& nodes, const std::vector<double>& inverse_mass,
                            const FeatureSearch& found, std::uint32_t first, std::uint32_t end) {
  const auto copy = [&](const auto& from, auto& to) { to.assign(from.begin() + first, from.begin() + end); };
  copy(nodes.start, own_.start);
  own_.inverse_mass = inverse_mass;
  copy(nodes.tangled, own_.tangled);
  own_.end.resize(own_.start.size());
  copy(nodes.start, found_start_);
  copy(nodes.end, found_end_);
  margin_ = found.margin();
  found_at_ = 0;
  searches_ = 0;
  pairs_.clear();
  for (FeaturePair pair : found.pairs()) {
    const auto own = [&](std::uint32_t n) { return n >= first && n < end; };
    if (!own(pair.node[0]) || !own(pair.node[2])) continue;
    for (std::uint32_t& n : pair.node) n -= first;
    pairs_.push_back(pair);
  }
}

void SubstepNet::measure_ways() {
  const auto way = [&](std::size_t i) { return Vec3(own_.end[i] - own_.start[i]); };
  const Vec3 common = mean(own_, way);
  way_.resize(own_.start.size());
  for (std::size_t i = 0; i < way_.size(); ++i) way_[i] = (way(i) - common).norm();
}

bool SubstepNet::covered(double to) const {
  // Each of two features may have come nearer by half of the room.
  const double room = (margin_ - kSubstepSight * gap_) / 2;
  if (room <= 0) return false;
  const double part = (to - found_at_) / (1 - found_at_);
  const auto stray = [&](std::size_t i) {
    return Vec3(own_.end[i] - found_start_[i] - part * (found_end_[i] - found_start_[i]));
  };
  const Vec3 common = mean(own_, stray);
  for (std::size_t i = 0; i < found_start_.size(); ++i) {
    if ((stray(i) - common).squaredNorm() > room * room) return false;
  }
  return true;
}

void SubstepNet::search(const Substep& substep) {
  ++searches_;
  margin_ = kSubstepMargin * gap_;
  found_at_ = substep.from;
  found_start_ = own_.start;
  found_end_ = own_.end;
  const double rest = (1 - substep.from) / (substep.to - substep.from);  // of the step, in substeps
  for (std::size_t i = 0; i < found_end_.size(); ++i) {
    found_end_[i] = found_start_[i] + rest * (own_.end[i] - own_.start[i]);
  }
  own_.end.swap(found_end_);
  pairs_ = search_.find(own_, margin_);
  own_.end.swap(found_end_);
}

double SubstepNet::nearing(const FeaturePair& pair) const {
  const auto& n = pair.node;
  return pair.kind == FeaturePair::Kind::node_triangle
             ? way_[n[0]] + std::max({way_[n[1]], way_[n[2]], way_[n[3]]})
             : std::max(way_[n[0]], way_[n[1]]) + std::max(way_[n[2]], way_[n[3]]);
}

void SubstepNet::collect() {
  const double sight = kSubstepSight * gap_;
  near_.clear();
  for (FeaturePair& pair : pairs_) {
    const double nearing_by = nearing(pair);
    if (pair.distance - nearing_by > sight) continue;
    const Nearness nearest = nearness(pair.kind, points_of(pair, own_.start));
    pair.distance = nearest.apart.norm();
    if (!(pair.distance > 0) || pair.distance - nearing_by > sight) continue;
    Near near{pair.node, nearest.weight, nearest.apart / pair.distance, pair.distance};
    for (std::size_t i = 0; i < 4; ++i) {
      near.mobility += near.weight[i] * near.weight[i] * own_.inverse_mass[near.node[i]];
    }
    if (near.mobility > 0) near_.push_back(near);
  }
}

bool SubstepNet::push_apart(const Near& near) {
  Vec3 way(0, 0, 0), velocity(0, 0, 0);
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t n = near.node[i];
    way += near.weight[i] * (own_.end[n] - own_.start[n]);
    velocity += near.weight[i] * own_.velocity[n];
  }
  const double wanted =
      near.distance < gap_ ? near.distance + kLedApartASubstep * (gap_ - near.distance) : gap_;
  const double lack = wanted - near.distance - near.normal.dot(way);
  if (!(lack > 0)) return false;
  const double approach = std::max(0.0, -near.normal.dot(velocity));
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t n = near.node[i];
    const double part = near.weight[i] * own_.inverse_mass[n] / near.mobility;
    own_.end[n] += part * lack * near.normal;
    own_.velocity[n] += part * approach * near.normal;
  }
  return true;
}

template <class Real>
void SubstepNet::apply(Particles<Real>& particles, const Substep& substep) {
  const auto position = kernels::components(particles.position),
             velocity = kernels::components(particles.velocity);
  const std::size_t count = own_.start.size();
  for (std::size_t i = 0; i < count; ++i) own_.end[i] = particles.place + at<Real>(position, i);
  if (searches_ < kSearches && !covered(substep.to)) search(substep);
  measure_ways();
  collect();
  if (!near_.empty()) {
    own_.velocity.resize(count);
    for (std::size_t i = 0; i < count; ++i) own_.velocity[i] = at<Real>(velocity, i);
    const std::vector<Vec3> end = own_.end, before = own_.velocity;
    bool met = true;
    for (int round = 0; round < kSubstepRounds && met; ++round) {
      met = false;
      for (const Near& near : near_) met = push_apart(near) || met;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (own_.end[i] == end[i]) continue;
      add(position, i, Vec3(own_.end[i] - end[i]));
      add(velocity, i, Vec3(own_.velocity[i] - before[i]));
      own_.end[i] = particles.place + at<Real>(position, i);
    }
    measure_ways();
  }
  for (FeaturePair& pair : pairs_) pair.distance -= nearing(pair);
  own_.start.swap(own_.end);
}

template void SubstepNet::apply(Particles<float>&, const Substep&);
template void SubstepNet::apply(Particles<double>&, const Substep&);

}  // namespace weft
