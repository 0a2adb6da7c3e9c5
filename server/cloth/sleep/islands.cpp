#include "cloth/sleep/islands.h"

#include <algorithm>
#include <utility>

#include "cloth/core/disjoint_sets.h"

namespace weft {

void BodyRest::stepped(const Pose& pose, double reach, double distance) {
  const double turned = pose.orientation.angularDistance(began_.orientation);
  const double gone = (pose.position - began_.position).norm() + reach * turned;
  if (quiet_steps_ > 0 && gone < distance) {
    ++quiet_steps_;
    return;
  }
  began_ = pose;
  quiet_steps_ = 1;
}

std::vector<bool> islands_at_rest(const std::vector<Sleeper>& sleepers) {
  // Sweep along x: only boxes that overlap there are compared.
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < sleepers.size(); ++i) {
    if ((sleepers[i].box.min().array() <= sleepers[i].box.max().array()).all()) order.push_back(i);
  }
  const auto low = [&](std::size_t i) { return sleepers[i].box.min().x(); };
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return std::make_pair(low(i), i) < std::make_pair(low(j), j);
  });
  DisjointSets islands(sleepers.size());
  for (auto i = order.begin(); i != order.end(); ++i) {
    for (auto j = i + 1; j != order.end() && low(*j) <= sleepers[*i].box.max().x(); ++j) {
      if (sleepers[*i].box.intersects(sleepers[*j].box)) islands.join(*i, *j);
    }
  }
  std::vector<bool> at_rest(sleepers.size(), true);
  for (std::size_t i = 0; i < sleepers.size(); ++i) {
    if (!sleepers[i].quiet) at_rest[islands.of(i)] = false;
  }
  for (std::size_t i = 0; i < sleepers.size(); ++i) at_rest[i] = at_rest[islands.of(i)];
  return at_rest;
}

}  // namespace weft
