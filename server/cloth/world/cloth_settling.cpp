/// Cloth's settling: what it does before a step that begins where no step has left it.
#include <algorithm>
#include <utility>

#include "cloth/core/interrupt.h"
#include "cloth/levels/keep_sides.h"
#include "cloth/levels/lift_nodes.h"
#include "cloth/sheet/motion.h"
#include "cloth/world/cloth.h"

namespace weft {
namespace {

/// Of one step of relaxation, s, whatever the scene's steps and their parts: a cloth is left in the same
/// state by whichever integrator it is stepped.
constexpr double kLongestRelaxation = 1.0 / 60;

}  // namespace

template <class Real>
bool Cloth<Real>::unsettled(const std::vector<Solid>& solids) {
  const bool just_put = std::any_of(solids.begin(), solids.end(), [](const Solid& s) { return s.just_put; });
  if (just_put && is_put_onto(particles_, contact(), seen(solids))) {
    unsettled_ = Unsettled::by_solid;
    wake();
  }
  return unsettled_ != Unsettled::no && !asleep() && !frozen();
}

template <class Real>
void Cloth<Real>::keep_sides(const std::vector<Solid>& solids) {
  if (!finer_) return;
  if (!weft::keep_sides(*finer_, seen(solids), particles_)) return finer_.reset();
  if (bag_) bag_->join(particles_);
  moved_from_outside();
}

template <class Real>
void Cloth<Real>::settle_down(const std::vector<Solid>& solids, double time) {
  if (unsettled_ == Unsettled::no) return;
  settled_ = std::exchange(unsettled_, Unsettled::no);
  const std::vector<Solid> here = seen(solids);
  bool moved = finer_.has_value();  // it has kept its sides
  if (splits_ > 0 && settled_ == Unsettled::by_level)
    moved = lift_new_free_nodes(splits_, here, shallow(description_, particles_.grid()), particles_) || moved;
  if (moved && bag_) bag_->join(particles_);
  try {
    const WorkLimit limit(most_work_);
    moved = settle(particles_, settled_, forces({.cloth = &description_, .time = time}),
                   here.empty() ? nullptr : &contact(), here, kLongestRelaxation, held_) ||
            moved;
  } catch (const TooMuchWork&) {
    guard_.put_back(particles_);
  }
  // Springs that expand against a pin lift the sheet: at one pin a merge gave 2 m of cloth 0.15 J of height.
  if (moved && settled_ == Unsettled::by_level)
    take_from_motion(particles_, std::max(0.0, elastic_energy() + energy_of_nodes() - had_));
}

template bool Cloth<float>::unsettled(const std::vector<Solid>&);
template void Cloth<float>::keep_sides(const std::vector<Solid>&);
template void Cloth<float>::settle_down(const std::vector<Solid>&, double);
template bool Cloth<double>::unsettled(const std::vector<Solid>&);
template void Cloth<double>::keep_sides(const std::vector<Solid>&);
template void Cloth<double>::settle_down(const std::vector<Solid>&, double);

}  // namespace weft
