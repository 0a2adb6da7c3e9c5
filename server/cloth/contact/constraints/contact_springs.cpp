/// ContactConstraints as springs of a step's linear system.
#include <algorithm>
#include <cmath>
#include <utility>

#include "cloth/contact/constraints/contact_constraints.h"
#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// To which a contact's usual force presses its spring, of the way that gravity gives in a substep: so stiff
/// that it follows within a substep, and no stiffer, since a solve must tell its force (ContactConstraints).
constexpr double kDepth = 1.0 / 32;
/// A spring bears from so many depths outside of the surface.
constexpr double kBearsFrom = 2;
/// At most, as a multiple of the links' stiffness at the node; more would cost digits in single precision.
constexpr double kLinkMultiple = 1;
/// A body is held by that and this multiple of the node's inertia: it bears far more than the node weighs.
constexpr double kBodyMultiple = 100;

/// At most so many times the inertia of a torn piece is a contact's part of the links. A flake of a node or
/// two has but its inertia along a surface, and the last digits of the stiffness across it: with all of it
/// some that lay on a plane were taken tens of metres away in a step.
constexpr double kPieceMultiple = 1e4;

/// along n n^T + across (I - n n^T).
Eigen::Matrix3d stiffness_of(const Vec3& n, double along, double across) {
  const double both = along - across;
  const double xy = both * n.x() * n.y(), xz = both * n.x() * n.z(), yz = both * n.y() * n.z();
  return Eigen::Matrix3d{{across + both * n.x() * n.x(), xy, xz},
                         {xy, across + both * n.y() * n.y(), yz},
                         {xz, yz, across + both * n.z() * n.z()}};
}

template <class Real>
void add_block(const kernels::Blocks<Real>& blocks, std::size_t i, const Eigen::Matrix3d& block) {
  blocks.xx[i] += static_cast<Real>(block(0, 0));
  blocks.xy[i] += static_cast<Real>(block(0, 1));
  blocks.xz[i] += static_cast<Real>(block(0, 2));
  blocks.yy[i] += static_cast<Real>(block(1, 1));
  blocks.yz[i] += static_cast<Real>(block(1, 2));
  blocks.zz[i] += static_cast<Real>(block(2, 2));
}

}  // namespace

template <class Real>
double ContactConstraints<Real>::depth() const {
  return kDepth * standard_gravity().norm() * substep_.seconds * substep_.seconds;
}

template <class Real>
double ContactConstraints<Real>::margin() const {
  return kBearsFrom * depth();
}

template <class Real>
double ContactConstraints<Real>::Constraint::force_at(const Vec3& moved) const {
  const double depth = distance - normal.dot(moved);
  return released ? 0 : stiffness * (pinched ? std::abs(depth) : std::max(0.0, depth));
}

/// Before a first solve of the substep by the usual force. A body's springs are so stiff that no solve tells
/// their force: there it is the usual one all along, and friction is looked for once a substep.
template <class Real>
double ContactConstraints<Real>::Constraint::holds(const Vec3& moved) const {
  if (body) return coefficient * usual_force();
  if (solved) return coefficient * force_at(moved);
  return coefficient * (force_before < 0 ? std::max(0.0, last_force) : usual_force());
}

/// As seen from a solid whose way is not bent.
template <class Real>
Vec3 ContactConstraints<Real>::move_of(const Constraint& c, kernels::Components<const Real> move,
                                       const AttachedBodies<Real>& bodies) {
  const Vec3 moved = c.point.moved_by(move);
  return c.body ? Vec3(moved - bodies.move(*c.body, c.arm)) : moved;
}

template <class Real>
void ContactConstraints<Real>::stiffen(Constraint& c, const Vec3& moved, double links, double inertia) const {
  const double least = c.point.mass() / (kDepth * substep_.seconds * substep_.seconds);
  c.most = kLinkMultiple * links + (c.body ? kBodyMultiple * inertia : least);
  if (c.body || c.pinched) {
    c.stiffness = c.most;
    return;
  }
  const double bears = std::max(c.usual_force(), c.solved ? c.force_at(moved) : 0);
  const bool keeps = near_rest_ && bears <= margin() * c.stiffness;
  c.stiffness = std::clamp(keeps ? c.stiffness : bears / depth(), least, c.most);
}

template <class Real>
void ContactConstraints<Real>::add_to(kernels::Blocks<Real> blocks, NodeCouplings<Real>& couplings,
                                      kernels::Components<Real> b, AttachedBodies<Real>& bodies,
                                      const Real* diagonal, double links_stiffness,
                                      const std::vector<double>& piece_mass,
                                      kernels::Components<const Real> move) {
  bodies.detach();
  const double inertia_rate = kPieceMultiple / (substep_.seconds * substep_.seconds);
  for (Constraint& c : constraints_) {
    if (c.released) continue;
    double links = links_stiffness;
    c.point.for_each_node([&](std::size_t i, double) {
      if (!piece_mass.empty()) links = std::min(links, inertia_rate * piece_mass[i]);
    });
    const double inertia = c.point.resistance(diagonal);
    const Vec3 moved = move_of(c, move, bodies), slip = c.slip(moved);
    const double holds = c.holds(moved);
    stiffen(c, moved, links, inertia);
    if (!c.body || !c.solved) c.friction.linearise(slip, holds, c.stiffness, inertia);
    c.solved = true;
    const Eigen::Matrix3d stiffness = stiffness_of(c.normal, c.stiffness, c.friction.rate());
    const Vec3 force = c.stiffness * (c.distance - c.normal.dot(moved)) * c.normal + c.friction.force(slip);
    if (c.touch.point().between_nodes()) {
      couplings.add({c.point.nodes(), c.point.moves(), stiffness});
    } else {
      add_block(blocks, c.touch.node, stiffness);
    }
    c.point.add_force(b, force);
    if (c.body) bodies.attach(*c.body, c.point, c.arm, stiffness, force);
  }
  for (const Hung& hung : hung_) {
    const BodySpring& spring = hung.spring;
    const Vec3 by_body = spring.stiffness * bodies.move(hung.body, spring.arm),
               force = spring.stiffness * (spring.apart - hung.point.moved_by(move)) + by_body;
    hung.point.add_force(b, by_body);
    bodies.attach(hung.body, hung.point, spring.arm, spring.stiffness * Eigen::Matrix3d::Identity(), force);
  }
  bodies.eliminate(b);
}

template <class Real>
void ContactConstraints<Real>::append_springs(kernels::Components<const Real> move,
                                              kernels::Components<const Real> change,
                                              const AttachedBodies<Real>& bodies,
                                              std::vector<OneSidedSpring>& springs) const {
  for (const Constraint& c : constraints_) {
    if (c.pinched) continue;
    Vec3 way = c.point.moved_by(change);
    if (c.body) way -= bodies.change(*c.body, c.arm);
    springs.push_back(
        {c.distance - c.normal.dot(move_of(c, move, bodies)), -c.normal.dot(way), c.stiffness, !c.released});
  }
}

template <class Real>
auto ContactConstraints<Real>::error(kernels::Components<const Real> move,
                                     const AttachedBodies<Real>& bodies) const -> Misjudged {
  Misjudged sum;
  for (const Constraint& c : constraints_) {
    if (c.released || !c.solved) continue;
    const Vec3 moved = move_of(c, move, bodies);
    double energy = c.body ? 0 : c.friction.error(c.slip(moved), c.holds(moved));
    const double inside = c.distance - c.normal.dot(moved) - margin();
    if (inside > 0 && c.stiffness < c.most && !c.pinched) energy += c.most * inside * inside / 2;
    sum.all += energy;
    if (!c.body && c.force_before < 0) sum.begun += energy;
  }
  return sum;
}

template <class Real>
double ContactConstraints<Real>::release_pulling(kernels::Components<const Real> move,
                                                 const AttachedBodies<Real>& bodies) {
  double energy = 0;
  for (Constraint& c : constraints_) {
    const double beyond = c.normal.dot(move_of(c, move, bodies)) - c.distance;
    if (c.pinched || c.released == (beyond > 0)) continue;
    c.released = !c.released;
    energy += c.stiffness * beyond * beyond / 2;
  }
  return energy;
}

template <class Real>
const std::vector<Touch>& ContactConstraints<Real>::finish(kernels::Components<const Real> move,
                                                           const AttachedBodies<Real>& bodies,
                                                           std::vector<Solid>& solids) {
  pressed_.clear();
  kept_aside_.clear();
  for (Constraint& c : constraints_) {
    const Vec3 moved = move_of(c, move, bodies);
    c.force = c.force_at(moved);
    c.friction.end(c.slip(moved), c.holds(moved));
    if (c.force > 0) pressed_.push_back(c.touch);
    const bool turning = c.body && solid_of(c.touch, solids).yields_turning();
    // A node that passes less than half through a solid is not pushed back to the face that it came from:
    // around an edge that would stretch its links.
    const bool near = !c.body && (moved - c.solid_move).squaredNorm() < c.width * c.width;
    if (turning || near) kept_aside_.push_back(c.touch);
  }
  solids = bent(std::move(solids), bodies);
  return pressed_;
}

template <class Real>
auto ContactConstraints<Real>::work(kernels::Components<const Real> move, const Velocities& velocities,
                                    const AttachedBodies<Real>& bodies) const -> Work {
  Work work;
  for (const Constraint& c : constraints_) {
    const Vec3 way = move_of(c, move, bodies) - c.solid_move;
    const Vec3 was = c.point.moved_by(velocities.start);
    Vec3 slip = across(way, c.normal);
    if (c.lasts()) {
      // The normal is that of the step's end: what goes along a curved surface has a part along it that no
      // force has worked on.
      work.taken -= c.force * (c.normal.dot(way) - c.curves);
      if (velocities.lead != nullptr)
        slip -=
            double(velocities.lead[c.touch.node]) * across(c.point.moved_by(velocities.end) - was, c.normal);
    } else if (c.force > 0) {
      const double approach =
          std::max(0.0, c.normal.dot(c.solid_move) / substep_.seconds - c.normal.dot(was));
      work.taken += c.point.mass() * approach * approach / 2;
    }
    work.taken -= c.friction.grip().dot(slip);
    work.led_out += c.force * c.led_out;
  }
  return work;
}

template <class Real>
std::vector<Solid> ContactConstraints<Real>::bent(std::vector<Solid> solids,
                                                  const AttachedBodies<Real>& bodies) const {
  for (std::size_t body = 0; body < yielding_.size(); ++body) {
    Solid& solid = solids[yielding_[body]];
    const int index = static_cast<int>(body);
    solid.go_on(solid.velocity + bodies.move(index) / substep_.seconds,
                solid.spin + bodies.turn(index) / substep_.seconds, substep_.from, substep_.step_seconds());
  }
  return solids;
}

template <class Real>
void ContactConstraints<Real>::keep_velocities(kernels::Components<Real> velocity) const {
  for (const Constraint& c : constraints_) {
    if (!c.released && !c.body) c.point.shift(velocity, -c.led_out / substep_.seconds * c.normal);
  }
}

template double ContactConstraints<float>::depth() const;
template double ContactConstraints<float>::Constraint::force_at(const Vec3&) const;
template double ContactConstraints<float>::Constraint::holds(const Vec3&) const;
template double ContactConstraints<float>::margin() const;
template Vec3 ContactConstraints<float>::move_of(const Constraint&, kernels::Components<const float>,
                                                 const AttachedBodies<float>&);
template void ContactConstraints<float>::stiffen(Constraint&, const Vec3&, double, double) const;
template void ContactConstraints<float>::add_to(kernels::Blocks<float>, NodeCouplings<float>&,
                                                kernels::Components<float>, AttachedBodies<float>&,
                                                const float*, double, const std::vector<double>&,
                                                kernels::Components<const float>);
template void ContactConstraints<float>::append_springs(kernels::Components<const float>,
                                                        kernels::Components<const float>,
                                                        const AttachedBodies<float>&,
                                                        std::vector<OneSidedSpring>&) const;
template auto ContactConstraints<float>::error(kernels::Components<const float>,
                                               const AttachedBodies<float>&) const -> Misjudged;
template double ContactConstraints<float>::release_pulling(kernels::Components<const float>,
                                                           const AttachedBodies<float>&);
template const std::vector<Touch>& ContactConstraints<float>::finish(kernels::Components<const float>,
                                                                     const AttachedBodies<float>&,
                                                                     std::vector<Solid>&);
template auto ContactConstraints<float>::work(kernels::Components<const float>, const Velocities&,
                                              const AttachedBodies<float>&) const -> Work;
template std::vector<Solid> ContactConstraints<float>::bent(std::vector<Solid>,
                                                            const AttachedBodies<float>&) const;
template void ContactConstraints<float>::keep_velocities(kernels::Components<float>) const;
template double ContactConstraints<double>::depth() const;
template double ContactConstraints<double>::Constraint::force_at(const Vec3&) const;
template double ContactConstraints<double>::Constraint::holds(const Vec3&) const;
template double ContactConstraints<double>::margin() const;
template Vec3 ContactConstraints<double>::move_of(const Constraint&, kernels::Components<const double>,
                                                  const AttachedBodies<double>&);
template void ContactConstraints<double>::stiffen(Constraint&, const Vec3&, double, double) const;
template void ContactConstraints<double>::add_to(kernels::Blocks<double>, NodeCouplings<double>&,
                                                 kernels::Components<double>, AttachedBodies<double>&,
                                                 const double*, double, const std::vector<double>&,
                                                 kernels::Components<const double>);
template void ContactConstraints<double>::append_springs(kernels::Components<const double>,
                                                         kernels::Components<const double>,
                                                         const AttachedBodies<double>&,
                                                         std::vector<OneSidedSpring>&) const;
template auto ContactConstraints<double>::error(kernels::Components<const double>,
                                                const AttachedBodies<double>&) const -> Misjudged;
template double ContactConstraints<double>::release_pulling(kernels::Components<const double>,
                                                            const AttachedBodies<double>&);
template const std::vector<Touch>& ContactConstraints<double>::finish(kernels::Components<const double>,
                                                                      const AttachedBodies<double>&,
                                                                      std::vector<Solid>&);
template auto ContactConstraints<double>::work(kernels::Components<const double>, const Velocities&,
                                               const AttachedBodies<double>&) const -> Work;
template std::vector<Solid> ContactConstraints<double>::bent(std::vector<Solid>,
                                                             const AttachedBodies<double>&) const;
template void ContactConstraints<double>::keep_velocities(kernels::Components<double>) const;

}  // namespace weft
