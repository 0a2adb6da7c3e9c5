#include "cloth/contact/recovery/contact.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <span>

#include "cloth/contact/recovery/node_contact.h"
#include "cloth/contact/recovery/struck_rows.h"
#include "cloth/core/interrupt.h"
#include "cloth/kernels/node_kernels.h"

namespace weft {
template <class Real>
int Contact<Real>::resolve(Particles<Real>& particles, std::vector<Solid>& solids, const Substep& substep,
                           const VectorField<Real>* start, VectorField<Real>* rounded_off) {
  touches_.clear();
  auto way = start != nullptr ? Way<Real>::to(*start) : Way<Real>::by(particles.velocity, -substep.seconds);
  const double longest = way.longest(particles.position);
  std::vector<MovingSolid> moving;
  moving.reserve(solids.size());
  double reach = 0;  // of the nodes, beyond their last places, m
  for (const Solid& solid : solids) {
    const Vec3 move = solid.at(substep.to) - solid.at(substep.from);
    const double sweep = sweep_of(solid, substep);
    const bool fast = longest + sweep > kSlowMove * inner_radius(solid.shape);
    if (fast) reach = longest;
    moving.push_back({&solid, solid.placed(substep.to), move, sweep, 0, fast,
                      kSlowMove * inner_radius(solid.shape), solid.velocity, solid.spin, substep,
                      solid.move(substep.from, substep.to)});
  }
  const Sweep sweep{substep.from, substep.to, reach};
  std::vector<TileSolidPair> pairs = broad_phase_.find_pairs(particles.position, solids, sweep);
  std::vector<std::size_t> may_meet;
  const typename NodeContact<Real>::State state{particles, rounded_off, start != nullptr, not_held_,
                                                kept_aside_};

  int in_contact = 0;
  // Nodes come last: none is left inside. What moves points moves them: their ways begin where they did.
  const std::vector<NearPoint> between = points_near(particles, particles.position, pairs, solids, sweep);
  // A node that its cell's points take along goes farther than its motion says.
  for (const NearPoint& near : between) moving[near.solid].fast = true;
  if (!between.empty() && start == nullptr) {
    began_ = particles.position;
    kernels::add_scaled(kernels::components(began_), kernels::components(std::as_const(particles.velocity)),
                        static_cast<Real>(-substep.seconds), particles.grid().size());
    way = Way<Real>::to(began_);
  }
  for (auto begin = between.begin(); begin != between.end();) {
    const PointId id = begin->point;
    for (may_meet.clear(); begin != between.end() && begin->point == id; ++begin)
      may_meet.push_back(begin->solid);
    Vec3 move(0, 0, 0);
    ClothPoint<Real>(id, particles).for_each_node([&](std::size_t i, double weight) {
      move += weight * way.move(at(kernels::components(std::as_const(particles.position)), i), i);
    });
    if (NodeContact<Real>(state, id, may_meet, move).resolve(moving, touches_)) ++in_contact;
  }
  if (!between.empty()) pairs = broad_phase_.find_pairs(particles.position, solids, sweep);
  const double farthest = between.empty() ? longest : way.longest(particles.position);
  for (MovingSolid& each : moving) {
    // A node is at most that much farther from its centre than what turns with it.
    const double turn = (substep.to - substep.from) * each.solid->turn.norm();
    each.reach = farthest + each.sweep + turn * (farthest + each.move.norm());
  }
  may_meet.resize(solids.size());
  std::iota(may_meet.begin(), may_meet.end(), 0);
  for_each_struck(
      particles.position, broad_phase_.tiles(), pairs, counters_,
      [&](const TileSolidPair& pair, const kernels::NodeBlock<Real>& block, std::size_t first) {
        return rows_struck(block, moving[static_cast<std::size_t>(pair.solid)], way, first);
      },
      [&](int row, int col, std::span<const std::size_t>) {
        if (particles.inverse_mass.at(row, col) == Real(0)) return;
        const std::size_t i = particles.grid().index(row, col);
        const Vec3 move = way.move(particles.local_position_at(row, col), i);
        if (NodeContact<Real>(state, {i}, may_meet, move).resolve(moving, touches_)) ++in_contact;
      });
  for (std::size_t i = 0; i < solids.size(); ++i) {
    if (moving[i].velocity == solids[i].velocity && moving[i].spin == solids[i].spin) continue;
    solids[i].go_on(moving[i].velocity, moving[i].spin, substep.to, substep.step_seconds());
  }
  not_held_.clear();
  kept_aside_.clear();
  counters_.nodes_in_contact += static_cast<std::uint64_t>(in_contact);
  check_interrupt(kWorkOfContact * static_cast<double>(in_contact) * static_cast<double>(solids.size()));
  return in_contact;
}

template <class Real>
int Contact<Real>::keep(const std::vector<Touch>& pressed) {
  if (pressed.empty()) return 0;
  std::vector<Touch> found = touches_;
  std::sort(found.begin(), found.end());
  std::set_difference(pressed.begin(), pressed.end(), found.begin(), found.end(),
                      std::back_inserter(touches_));
  const std::size_t kept = touches_.size() - found.size();
  counters_.nodes_in_contact += kept;
  return static_cast<int>(kept);
}

template class Contact<float>;
template class Contact<double>;

}  // namespace weft
