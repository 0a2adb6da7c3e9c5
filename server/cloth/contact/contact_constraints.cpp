#include "cloth/contact/contact_constraints.h"

#include <algorithm>
#include <utility>

namespace weft {
namespace {

/// Stiffness of a contact, as multiples of the links' and of the inertia's at the node. More would cost
/// digits in single precision; the inertia's alone leaves a depth of at most g h^2 / 100 under a cloth's own
/// weight, 27 micrometres at 60 Hz, which Contact::resolve takes away.
constexpr double kLinkMultiple = 1, kInertiaMultiple = 100;

template <class Real>
Vec3 at(const kernels::Components<const Real>& field, std::size_t i) {
  return {double(field.x[i]), double(field.y[i]), double(field.z[i])};
}

template <class Real>
void add(const kernels::Components<Real>& field, std::size_t i, const Vec3& value) {
  field.x[i] += static_cast<Real>(value.x());
  field.y[i] += static_cast<Real>(value.y());
  field.z[i] += static_cast<Real>(value.z());
}

/// blocks += along n n^T + across (I - n n^T).
template <class Real>
void add_block(const kernels::Blocks<Real>& blocks, std::size_t i, const Vec3& n, double along,
               double across) {
  const double both = along - across;
  blocks.xx[i] += static_cast<Real>(across + both * n.x() * n.x());
  blocks.xy[i] += static_cast<Real>(both * n.x() * n.y());
  blocks.xz[i] += static_cast<Real>(both * n.x() * n.z());
  blocks.yy[i] += static_cast<Real>(across + both * n.y() * n.y());
  blocks.yz[i] += static_cast<Real>(both * n.y() * n.z());
  blocks.zz[i] += static_cast<Real>(across + both * n.z() * n.z());
}

}  // namespace

template <class Real>
void ContactConstraints<Real>::begin(const std::vector<Touch>& touches, const Particles<Real>& particles,
                                     const std::vector<Solid>& solids, const Substep& substep) {
  std::swap(last_, constraints_);
  constraints_.clear();
  const double h = seconds_ = substep.seconds;
  const kernels::Components<const Real> position = kernels::components(particles.position),
                                        velocity = kernels::components(particles.velocity);
  const auto before = [](const Constraint& c, const Touch& touch) { return c.touch < touch; };
  std::vector<Touch> all = touches;
  for (const Constraint& c : last_) {
    if (c.force > 0) all.push_back(c.touch);
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  for (const Touch& touch : all) {
    const auto solid =
        std::find_if(solids.begin(), solids.end(), [&](const Solid& s) { return s.id == touch.collider; });
    if (solid == solids.end()) continue;
    const auto same = std::lower_bound(last_.begin(), last_.end(), touch, before);
    const double force = same != last_.end() && same->touch == touch ? same->force : 0.0;

    const Vec3 move = solid->at(substep.to) - solid->at(substep.from);
    const Vec3 start = at(position, touch.node), guess = h * at(velocity, touch.node);
    const Surface surface = solid->placed(substep.to).surface(start + guess);
    const Vec3& normal = surface.normal;
    // Where the solid or the node leaves, faster than gravity could bring them together again, nothing holds.
    if (surface.distance > standard_gravity().norm() * h * h) continue;
    const Vec3 slip = guess - move;
    const double sliding = (slip - slip.dot(normal) * normal).norm();
    const double left = solid->depth_left(start, substep.from, substep.to);
    constraints_.push_back({touch, static_cast<std::size_t>(solid - solids.begin()), normal,
                            normal.dot(guess) - surface.distance - left,
                            solid->led_out(start, substep.from, substep.to), move, solid->friction * force,
                            sliding});
  }
}

template <class Real>
void ContactConstraints<Real>::add_to(kernels::Blocks<Real> blocks, kernels::Components<Real> b,
                                      const Real* diagonal, double links_stiffness,
                                      kernels::Components<const Real> move) {
  for (Constraint& c : constraints_) {
    if (c.released) continue;
    const std::size_t i = c.touch.node;
    c.stiffness = kLinkMultiple * links_stiffness + kInertiaMultiple * double(diagonal[i]);
    const Vec3 moved = at(move, i), slip = c.solid_move - moved;
    // Sticking is a spring as stiff as the contact; what would be more than friction holds, slides.
    c.friction_stiffness = c.holds < c.stiffness * c.sliding ? c.holds / c.sliding : c.stiffness;
    if (c.holds == 0) c.friction_stiffness = 0;
    add_block(blocks, i, c.normal, c.stiffness, c.friction_stiffness);
    add(b, i,
        c.stiffness * (c.distance - c.normal.dot(moved)) * c.normal +
            c.friction_stiffness * (slip - slip.dot(c.normal) * c.normal));
  }
}

template <class Real>
double ContactConstraints<Real>::release_pulling(kernels::Components<const Real> move) {
  double energy = 0;
  for (Constraint& c : constraints_) {
    const double beyond = c.normal.dot(at(move, c.touch.node)) - c.distance;
    if (c.released || !(beyond > 0)) continue;
    energy += c.stiffness * beyond * beyond / 2;
    c.stiffness = c.friction_stiffness = 0;
    c.released = true;
  }
  return energy;
}

template <class Real>
void ContactConstraints<Real>::finish(kernels::Components<const Real> move, const std::vector<Solid>& solids,
                                      std::vector<Vec3>& impulses) {
  for (Constraint& c : constraints_) {
    const Vec3 moved = at(move, c.touch.node), slip = c.solid_move - moved;
    c.force = c.stiffness * (c.distance - c.normal.dot(moved));
    if (solids[c.solid].yields) {
      impulses[c.solid] -=
          seconds_ * (c.force * c.normal + c.friction_stiffness * (slip - slip.dot(c.normal) * c.normal));
    }
    c.force = std::max(0.0, c.force);
  }
}

template <class Real>
void ContactConstraints<Real>::keep_velocities(kernels::Components<Real> velocity) const {
  for (const Constraint& c : constraints_) {
    if (!c.released) add(velocity, c.touch.node, -c.led_out / seconds_ * c.normal);
  }
}

template class ContactConstraints<float>;
template class ContactConstraints<double>;

}  // namespace weft
