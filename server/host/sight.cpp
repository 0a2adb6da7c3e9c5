#include "host/sight.h"

#include <algorithm>
#include <cmath>

#include "cloth/sheet/diagnostics.h"
#include "host/frame_encoder.h"

namespace weft::host {
namespace {

/// Nobody has sent its camera.
bool nobody_placed(const std::vector<Seat>& seats) {
  return std::none_of(seats.begin(), seats.end(), [](const Seat& seat) { return seat.placed; });
}

}  // namespace

Sight::Sight(const SimulationDescription& scene, std::size_t frame_bytes)
    : scene_(scene),
      unseen_steps_(std::max(1, static_cast<int>(std::lround(kUnseenTime / scene.time_step)))) {
  finest_sendable_.reserve(scene.cloths.size());
  for (const ClothDescription& cloth : scene.cloths)
    finest_sendable_.push_back(finest_sendable_level(cloth.base_cells, frame_bytes));
}

void Sight::find_bounds(const std::vector<Cloth<float>>& cloths) {
  bounds_.clear();
  for (const Cloth<float>& cloth : cloths) {
    const bool in_full = cloth.description().relevance.unseen != Relevance::Unseen::step;
    bounds_.push_back(in_full ? bounding_sphere(cloth.particles())
                              : BoundingSphere{centre(cloth.particles()), 0});
  }
}

void Sight::look(Seat& seat, int steps) const {
  const LevelPolicy& policy = scene_.level_policy;
  const std::size_t cloths = scene_.cloths.size();
  const bool first = seat.policy_levels.empty();
  seat.distances.resize(cloths);
  seat.policy_levels.resize(cloths);
  seat.levels.resize(cloths);
  seat.steps_unseen.resize(cloths, 0);
  for (std::size_t i = 0; i < cloths; ++i) {
    const double distance = seat.eye ? (*seat.eye - bounds_[i].centre).norm() : seat.distance;
    const int level = first ? policy.level_at(distance) : policy.level_at(distance, seat.policy_levels[i]);
    const ClothDescription& cloth = scene_.cloths[i];
    seat.distances[i] = distance;
    seat.policy_levels[i] = level;
    seat.levels[i] = std::min(std::clamp(level, cloth.min_level, cloth.max_level), finest_sendable_[i]);
    seat.steps_unseen[i] = sees(seat, i) ? 0 : std::min(seat.steps_unseen[i] + steps, unseen_steps_ + 1);
    if (lost(seat, i)) seat.levels[i] = std::min(cloth.min_level, seat.levels[i]);
  }
}

void Sight::look_anew(Seat& seat) const {
  seat.policy_levels.clear();
  seat.steps_unseen.clear();
  look(seat);
}

bool Sight::sees(const Seat& seat, std::size_t cloth) const {
  const Relevance& relevance = scene_.cloths[cloth].relevance;
  if (relevance.unseen == Relevance::Unseen::step) return true;
  const BoundingSphere& bounds = bounds_[cloth];
  return seat.distances[cloth] - bounds.radius <= relevance.far && (!seat.cone || seat.cone->touches(bounds));
}

bool Sight::unseen(const std::vector<Seat>& seats, std::size_t cloth) const {
  const bool all = nobody_placed(seats);
  return std::all_of(seats.begin(), seats.end(),
                     [&](const Seat& seat) { return !(all || seat.placed) || lost(seat, cloth); });
}

std::vector<int> Sight::wanted_levels(const std::vector<Seat>& seats) const {
  std::vector<int> wanted(scene_.cloths.size(), 0);
  const bool all = nobody_placed(seats);
  for (const Seat& seat : seats) {
    if (!all && !seat.placed) continue;
    for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] = std::max(wanted[i], seat.levels[i]);
  }
  return wanted;
}

}  // namespace weft::host
