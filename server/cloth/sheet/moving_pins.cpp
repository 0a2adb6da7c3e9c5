// Pins that move: apart from those that only hold, so that a program can be linked without them.
#include <algorithm>

#include "cloth/kernels/node_vector.h"
#include "cloth/sheet/pins.h"

namespace weft {

template <class Real>
bool Pins<Real>::begin_step(const Particles<Real>& particles, const std::vector<Solid>& solids, double time,
                            double dt) {
  begin_ = time;
  step_ = dt;
  bool move = (!carried_.empty() || !led_.empty()) && time < end_of_motion_;
  for (Fixed& fixed : fixed_) {
    const auto found = std::find_if(solids.begin(), solids.end(),
                                    [&](const Solid& solid) { return solid.id == fixed.obstacle.id; });
    if (found == solids.end()) {
      fixed.obstacle.stand();
      continue;
    }
    fixed.obstacle = *found;
    move = move || found->moves();
    if (fixed.placed) continue;
    const PlacedShape start = found->placed(0);
    for (Carried& carried : fixed.nodes) {
      const Vec3 local = weft::at<Real>(kernels::components(particles.position), carried.node);
      carried.origin = start.rotation.transpose() * (particles.place + local - start.centre);
    }
    fixed.placed = true;
  }
  return move;
}

template <class Real>
void Pins<Real>::carry(Particles<Real>& particles, double time) const {
  for (const Path& path : carried_) {
    const Vec3 offset = along_path(path.points, time, path.loops);
    for (const Carried& carried : path.nodes) {
      set(kernels::components(particles.position), carried.node, carried.origin + offset - particles.place);
    }
  }
  for (const Led& led : led_) {
    const Pose now = along_path(led.motion, time, led.loops);
    for (const Carried& carried : led.nodes)
      set(kernels::components(particles.position), carried.node,
          Vec3(place(now, carried.origin) - particles.place));
  }
  for (const Fixed& fixed : fixed_) {
    if (!fixed.placed || !fixed.obstacle.moves()) continue;
    const PlacedShape now = at(fixed, time);
    for (const Carried& carried : fixed.nodes) {
      set(kernels::components(particles.position), carried.node,
          now.centre + now.rotation * carried.origin - particles.place);
    }
  }
}

template <class Real>
double Pins<Real>::longest_way(double begin, double end) const {
  constexpr int kSections = 8;
  double longest = 0;
  const auto follow = [&](const auto& place_at) {
    double way = 0;
    Vec3 before = place_at(begin);
    for (int i = 1; i <= kSections; ++i) {
      const Vec3 after = place_at(begin + (end - begin) * i / kSections);
      way += (after - before).norm();
      before = after;
    }
    longest = std::max(longest, way);
  };
  for (const Path& path : carried_) {
    follow([&](double time) { return along_path(path.points, time, path.loops); });
  }
  for (const Led& led : led_) {
    for (const Carried& carried : led.nodes) {
      follow([&](double time) { return place(along_path(led.motion, time, led.loops), carried.origin); });
    }
  }
  return longest;
}

template bool Pins<float>::begin_step(const Particles<float>&, const std::vector<Solid>&, double, double);
template bool Pins<double>::begin_step(const Particles<double>&, const std::vector<Solid>&, double, double);
template double Pins<float>::longest_way(double, double) const;
template double Pins<double>::longest_way(double, double) const;
template void Pins<float>::carry(Particles<float>&, double) const;
template void Pins<double>::carry(Particles<double>&, double) const;

}  // namespace weft
