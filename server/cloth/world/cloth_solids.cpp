/// Cloth's solids: as it sees them, what of it they touch, and what it gives them.
#include <algorithm>
#include <map>

#include "cloth/kernels/node_vector.h"
#include "cloth/world/cloth.h"

namespace weft {

template <class Real>
std::vector<Solid> Cloth<Real>::seen(const std::vector<Solid>& solids) const {
  std::vector<Solid> from_here;
  from_here.reserve(solids.size());
  for (const Solid& solid : solids) from_here.push_back(solid.from(particles_.place));
  return from_here;
}

template <class Real>
Contact<Real>& Cloth<Real>::contact() {
  if (!contact_) contact_ = std::make_unique<Contact<Real>>(particles_.grid());
  contact_->set_torn(torn_.get());
  return *contact_;
}

template <class Real>
std::vector<Touch> Cloth<Real>::keep_outside(const VectorField<Real>& before, double dt) {
  if (solids_.empty()) return {};
  std::vector<Touch> touches = contact().touches();
  std::sort(touches.begin(), touches.end());
  contact().resolve(particles_, solids_, {1, 1, dt}, &before);
  std::vector<Touch> met = contact().touches();
  contact().keep(touches);
  return met;
}

template <class Real>
void Cloth<Real>::add_pins_near(const std::vector<Solid>& solids, double time, double dt,
                                std::vector<PinnedNode>& found) {
  const auto yields = [](const Solid& solid) { return solid.yields(); };
  if (description_.pins.empty() || std::none_of(solids.begin(), solids.end(), yields)) return;
  std::map<std::size_t, Vec3> ways;  // by node
  double longest = 0;
  if (pins_.moving() && !frozen() && pins_.begin_step(particles_, solids, time, dt)) {
    pins_.for_each_way(time, time + dt, [&](std::size_t node, const Vec3& way) {
      ways[node] = way;
      longest = std::max(longest, way.norm());
    });
  }
  for (const NearPoint& near : contact().pinned_near(particles_, seen(solids), longest)) {
    const ClothPoint<Real> point(near.point, particles_);
    Solid pin;
    pin.shape = Sphere{0};
    pin.friction = solids[near.solid].friction;
    pin.start = pin.position =
        particles_.place + point.of(kernels::components(std::as_const(particles_.position)));
    point.for_each_node([&](std::size_t node, double weight) {
      const auto way = ways.find(node);
      if (way == ways.end()) return;
      pin.mobile = true;
      pin.position += weight * way->second;
      pin.velocity += weight / dt * way->second;
    });
    found.push_back({near.solid, pin});
  }
}

template <class Real>
bool Cloth<Real>::meets(const Solid& solid, double dt) {
  const std::vector<Touch>& touches = contact().touches();
  return std::any_of(touches.begin(), touches.end(),
                     [&](const Touch& t) { return t.collider == solid.id; }) ||
         !contact().foresee(particles_, {solid.from(particles_.place)}, {0, 1, dt}).empty();
}

template <class Real>
void Cloth<Real>::push_balls(Colliders& colliders) const {
  colliders.push(met_, solids_);
}

template std::vector<Solid> Cloth<float>::seen(const std::vector<Solid>&) const;
template Contact<float>& Cloth<float>::contact();
template std::vector<Touch> Cloth<float>::keep_outside(const VectorField<float>&, double);
template void Cloth<float>::add_pins_near(const std::vector<Solid>&, double, double,
                                          std::vector<PinnedNode>&);
template bool Cloth<float>::meets(const Solid&, double);
template void Cloth<float>::push_balls(Colliders&) const;
template std::vector<Solid> Cloth<double>::seen(const std::vector<Solid>&) const;
template Contact<double>& Cloth<double>::contact();
template std::vector<Touch> Cloth<double>::keep_outside(const VectorField<double>&, double);
template void Cloth<double>::add_pins_near(const std::vector<Solid>&, double, double,
                                           std::vector<PinnedNode>&);
template bool Cloth<double>::meets(const Solid&, double);
template void Cloth<double>::push_balls(Colliders&) const;

}  // namespace weft
