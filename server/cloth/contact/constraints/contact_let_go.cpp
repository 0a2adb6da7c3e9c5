/// Whom ContactConstraints lets go: what slides off a solid's side, and of two solids that pinch a node one.
#include <algorithm>
#include <utility>

#include "cloth/contact/constraints/contact_constraints.h"
#include "cloth/contact/recovery/node_contact.h"
#include "cloth/kernels/node_vector.h"

namespace weft {

template <class Real>
bool ContactConstraints<Real>::let_go_of_slid_off(const Particles<Real>& particles,
                                                  const std::vector<Solid>& solids,
                                                  kernels::Components<const Real> move,
                                                  const AttachedBodies<Real>& bodies) {
  const kernels::Components<const Real> position = kernels::components(particles.position);
  const std::size_t before = not_held_.size();
  for (const Constraint& c : constraints_) {
    if (c.released) continue;
    const Vec3 way = move_of(c, move, bodies);
    if (!((way - c.solid_move).squaredNorm() > c.width * c.width)) continue;
    const Solid& solid = solid_of(c.touch, solids);
    const Vec3 start = c.point.of(position) - c.point.moved_by(move);
    const bool off = is_off_side(solid.placed(substep_.to), start + way);
    if (off && lay_on(solid, start)) not_held_.push_back(c.touch);
  }
  if (not_held_.size() == before) return false;
  std::sort(not_held_.begin(), not_held_.end());
  std::erase_if(constraints_, [&](const Constraint& c) {
    return std::binary_search(not_held_.begin(), not_held_.end(), c.touch);
  });
  return true;
}

template <class Real>
void ContactConstraints<Real>::let_go_of_pinched(kernels::Components<const Real> velocity) {
  const auto room = [&](const Constraint& c) {
    return substep_.seconds * c.normal.dot(c.point.moved_by(velocity)) - c.distance + margin();
  };
  const auto pinched = [&](const Constraint& a, const Constraint& b) {
    return !a.body && !b.body && a.normal.dot(b.normal) <= kFacing && room(a) + room(b) < 0;
  };
  // Of two that stand still the one it is less deep in: there it was held while the other came.
  const auto moves_least = [&](const Constraint& a, const Constraint& b) {
    return std::pair(a.solid_move.squaredNorm(), -room(a)) < std::pair(b.solid_move.squaredNorm(), -room(b));
  };
  std::vector<Constraint> kept;
  for (auto node = constraints_.begin(); node != constraints_.end();) {
    const auto end = std::find_if(node, constraints_.end(), [&](const Constraint& c) {
      return c.touch.point() != node->touch.point();
    });
    const bool stuck = std::any_of(node, end, [&](const Constraint& a) {
      return std::any_of(node, end, [&](const Constraint& b) { return pinched(a, b); });
    });
    if (stuck) {
      kept.push_back(*std::min_element(node, end, moves_least));
      kept.back().pinched = true;
      kept.back().distance -= margin();
    } else {
      kept.insert(kept.end(), node, end);
    }
    node = end;
  }
  constraints_.swap(kept);
}

template bool ContactConstraints<float>::let_go_of_slid_off(const Particles<float>&,
                                                            const std::vector<Solid>&,
                                                            kernels::Components<const float>,
                                                            const AttachedBodies<float>&);
template void ContactConstraints<float>::let_go_of_pinched(kernels::Components<const float>);
template bool ContactConstraints<double>::let_go_of_slid_off(const Particles<double>&,
                                                             const std::vector<Solid>&,
                                                             kernels::Components<const double>,
                                                             const AttachedBodies<double>&);
template void ContactConstraints<double>::let_go_of_pinched(kernels::Components<const double>);

}  // namespace weft
