/// ContactConstraints and the solids around: those that hang on the cloth, and what stands firm.
#include <Eigen/LU>
#include <algorithm>
#include <optional>

#include "cloth/contact/constraints/contact_constraints.h"

namespace weft {
namespace {

/// What holds two bodies apart, as a multiple of what their masses resist within a substep: pressed by what
/// speeds them up as gravity does they overlap by this part of its way in a substep.
constexpr double kJoined = 1000;

}  // namespace

template <class Real>
std::optional<int> ContactConstraints<Real>::body_of(const Solid& solid, const std::vector<Solid>& solids,
                                                     AttachedBodies<Real>& bodies) {
  if (!solid.yields()) return {};
  const auto index = static_cast<std::size_t>(&solid - solids.data());
  const auto known = std::find(yielding_.begin(), yielding_.end(), index);
  if (known != yielding_.end()) return static_cast<int>(known - yielding_.begin());
  yielding_.push_back(index);
  const double h = substep_.seconds, inertia = 1 / (solid.inverse_mass * h * h);
  if (!solid.yields_turning()) return bodies.add(inertia);
  return bodies.add(inertia, solid.inverse_inertia.inverse() / (h * h));
}

template <class Real>
void ContactConstraints<Real>::hang(const std::vector<BodySpring>& springs, const Particles<Real>& particles,
                                    const std::vector<Solid>& solids, AttachedBodies<Real>& bodies) {
  for (const BodySpring& spring : springs) {
    const ClothPoint<Real> point(PointId{spring.node}, particles);
    const std::optional<int> body = body_of(solids[spring.solid], solids, bodies);
    if (body) hung_.push_back({spring, point, *body});
  }
}

template <class Real>
void ContactConstraints<Real>::join(const std::vector<BodyTouch>& touches, const std::vector<Solid>& solids,
                                    AttachedBodies<Real>& bodies) {
  joined_.clear();
  if (touches.empty() || yielding_.empty()) return;
  const auto known = [&](std::size_t solid) {
    return std::find(yielding_.begin(), yielding_.end(), solid) != yielding_.end();
  };
  std::vector<char> taken(touches.size());
  for (bool more = true; more;) {
    more = false;
    for (std::size_t i = 0; i < touches.size(); ++i) {
      if (taken[i] != 0 || !(known(touches[i].a()) || known(touches[i].b()))) continue;
      body_of(solids[touches[i].a()], solids, bodies);
      body_of(solids[touches[i].b()], solids, bodies);
      taken[i] = 1;
      more = true;
    }
  }
  std::vector<BodyPush> pushes;
  const double rate = kJoined / (substep_.seconds * substep_.seconds), to = substep_.to;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    if (taken[i] == 0) continue;
    const BodyTouch& touch = touches[i];
    const Solid &a = solids[touch.a()], &b = solids[touch.b()];
    BodyPush push;
    push.id = i;
    push.arm_a = touch.arm_a(solids, to);
    push.arm_b = touch.arm_b(solids, to);
    push.normal = touch.normal();
    push.overlap = touch.overlap(solids, to);
    push.touches = push.overlap > -standard_gravity().norm() * substep_.seconds * substep_.seconds;
    push.stiffness =
        rate / (a.inverse_mass_at(push.arm_a, push.normal) + b.inverse_mass_at(push.arm_b, push.normal));
    if (a.yields()) {
      push.a = *body_of(a, solids, bodies);
      push.b = body_of(b, solids, bodies);
    } else {  // b does
      push.a = *body_of(b, solids, bodies);
      std::swap(push.arm_a, push.arm_b);
      push.normal = -push.normal;
    }
    pushes.push_back(push);
    joined_.push_back(i);
  }
  bodies.set_pushes(pushes);
}

template <class Real>
bool ContactConstraints<Real>::add_impulses(const AttachedBodies<Real>& bodies,
                                            std::vector<BodyTouch>& touches) const {
  const std::vector<double> forces = bodies.push_forces();
  bool firm = false;
  for (std::size_t i = 0; i < joined_.size(); ++i) {
    touches[joined_[i]].impulse += substep_.seconds * forces[i];
    firm = firm || (forces[i] > 0 && bodies.pushed_by_firm(i));
  }
  return firm;
}

template <class Real>
auto ContactConstraints<Real>::firm(const std::vector<Touch>& touches, const Particles<Real>& particles,
                                    const std::vector<Solid>& solids) const -> Firm {
  Firm firm;
  const kernels::Components<const Real> position = kernels::components(particles.position);
  const auto push = [&](const ClothPoint<Real>& point, const Vec3& normal, double friction) {
    firm.pushes.push_back({particles.place + point.of(position), normal});
    firm.rubs = firm.rubs || friction > 0;
  };
  const auto pushed = [](const Constraint& c) { return !c.body && c.force > 0; };
  for (const Constraint& c : constraints_) {
    if (pushed(c)) push(c.point, c.normal, c.coefficient);
  }
  for (const Touch& touch : touches) {
    const Solid& solid = solid_of(touch, solids);
    if (solid.yields()) continue;
    const auto same = std::lower_bound(constraints_.begin(), constraints_.end(), touch, is_before);
    if (same != constraints_.end() && same->touch == touch && pushed(*same)) continue;
    const ClothPoint<Real> point(touch.point(), particles);
    push(point, solid.placed(substep_.to).surface(point.of(position)).normal, solid.friction);
  }
  return firm;
}

template <class Real>
double ContactConstraints<Real>::hung_share(double mass, const std::vector<Solid>& solids) const {
  std::vector<std::size_t> hung;
  for (const Hung& each : hung_) hung.push_back(each.spring.solid);
  std::sort(hung.begin(), hung.end());
  hung.erase(std::unique(hung.begin(), hung.end()), hung.end());
  double sum = mass;
  for (const std::size_t solid : hung) sum += 1 / solids[solid].inverse_mass;
  return mass / sum;
}

template <class Real>
Vec3 ContactConstraints<Real>::torque_beside_centres(kernels::Components<const Real> move,
                                                     const Particles<Real>& particles,
                                                     const std::vector<Solid>& solids,
                                                     const AttachedBodies<Real>& bodies) const {
  Vec3 torque(0, 0, 0);
  const auto position = kernels::components(particles.position);
  for (const Hung& hung : hung_) {
    const BodySpring& spring = hung.spring;
    const Solid& solid = solids[spring.solid];
    if (solid.yields_turning()) continue;
    const Vec3 force =
        spring.stiffness * (spring.apart - hung.point.moved_by(move) + bodies.move(hung.body, spring.arm));
    torque += (hung.point.of(position) - solid.at(substep_.to)).cross(force);
  }
  return torque;
}

template std::optional<int> ContactConstraints<float>::body_of(const Solid&, const std::vector<Solid>&,
                                                               AttachedBodies<float>&);
template void ContactConstraints<float>::hang(const std::vector<BodySpring>&, const Particles<float>&,
                                              const std::vector<Solid>&, AttachedBodies<float>&);
template std::optional<int> ContactConstraints<double>::body_of(const Solid&, const std::vector<Solid>&,
                                                                AttachedBodies<double>&);
template void ContactConstraints<double>::hang(const std::vector<BodySpring>&, const Particles<double>&,
                                               const std::vector<Solid>&, AttachedBodies<double>&);
template void ContactConstraints<float>::join(const std::vector<BodyTouch>&, const std::vector<Solid>&,
                                              AttachedBodies<float>&);
template void ContactConstraints<double>::join(const std::vector<BodyTouch>&, const std::vector<Solid>&,
                                               AttachedBodies<double>&);
template bool ContactConstraints<float>::add_impulses(const AttachedBodies<float>&,
                                                      std::vector<BodyTouch>&) const;
template bool ContactConstraints<double>::add_impulses(const AttachedBodies<double>&,
                                                       std::vector<BodyTouch>&) const;
template double ContactConstraints<float>::hung_share(double, const std::vector<Solid>&) const;
template Vec3 ContactConstraints<float>::torque_beside_centres(kernels::Components<const float>,
                                                               const Particles<float>&,
                                                               const std::vector<Solid>&,
                                                               const AttachedBodies<float>&) const;
template double ContactConstraints<double>::hung_share(double, const std::vector<Solid>&) const;
template Vec3 ContactConstraints<double>::torque_beside_centres(kernels::Components<const double>,
                                                                const Particles<double>&,
                                                                const std::vector<Solid>&,
                                                                const AttachedBodies<double>&) const;
template auto ContactConstraints<float>::firm(const std::vector<Touch>&, const Particles<float>&,
                                              const std::vector<Solid>&) const -> Firm;
template auto ContactConstraints<double>::firm(const std::vector<Touch>&, const Particles<double>&,
                                               const std::vector<Solid>&) const -> Firm;

}  // namespace weft
