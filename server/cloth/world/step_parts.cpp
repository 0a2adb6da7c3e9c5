#include "cloth/world/step_parts.h"

#include <algorithm>
#include <cmath>

namespace weft {
namespace {

/// Longest parts where cloth touches cloth, s: of an implicit step of one cloth, of several, and of an
/// explicit step; what is longer by a tenth of a part is rounding.
constexpr double kLongest = 1.0 / 30, kLongestApart = 1.0 / 60, kLongestExplicit = 1.0 / 240, kRounding = 0.1;
/// Farthest that cloths go past each other in a part, in cells, and most parts made for that.
constexpr double kMostCells = 4, kMostForCells = 4;
/// Farthest that pins go in a part, as a part of the cloth's larger side, and most parts made for that.
constexpr double kFarthest = 0.5, kMostForPins = 8;
/// Farthest that bodies on cloth go in a part, of their inner radius, and most parts made for that.
constexpr double kMostOfRadius = 0.25, kMostForBodies = 4;

template <class Real>
double parts_for_contact(const Cloth<Real>& cloth, bool alone, double dt) {
  if (!cloth.steps_implicitly()) return dt / kLongestExplicit;
  return dt / (alone ? kLongest : kLongestApart);
}

template <class Real>
double parts_for_pins(const Cloth<Real>& cloth, double time, double dt) {
  if (!cloth.has_moving_pins() || !cloth.steps_implicitly()) return 1;
  const double way = cloth.way_of_pins(time, time + dt);
  return std::min(way / (kFarthest * cloth.description().size.maxCoeff()), kMostForPins);
}

/// Of bodies that touch the cloth, of what of it touches them, and of bodies that may hit one of them.
template <class Real>
double parts_for_bodies(const Cloth<Real>& cloth, const std::vector<Solid>& solids, double dt) {
  if (!cloth.steps_implicitly()) return 1;
  const auto way = [&](const Solid& solid) { return dt * solid.velocity.norm(); };
  const auto radius = [](const Solid& solid) { return outer_radius(solid.shape); };
  const auto velocity = kernels::components(cloth.particles().velocity),
             position = kernels::components(cloth.particles().position);
  double parts = 1;
  const Solid* body = nullptr;
  for (const Touch& touch : cloth.touches()) {
    if (body == nullptr || body->id != touch.collider) {
      const auto touching = std::find_if(solids.begin(), solids.end(),
                                         [&](const Solid& each) { return each.id == touch.collider; });
      if (touching == solids.end() || !touching->yields()) continue;
      body = &*touching;
      for (const Solid& other : solids) {
        if (!other.yields()) continue;
        const double apart = (other.position - body->position).norm();
        if (apart > radius(other) + radius(*body) + way(other) + way(*body)) continue;
        parts = std::max(parts, way(other) / (kMostOfRadius * inner_radius(other.shape)));
      }
    }
    const ClothPoint<Real> point(touch.point(), cloth.particles());
    const Vec3 arm = cloth.particles().place + point.of(position) - body->position,
               of_body = body->velocity + body->spin.cross(arm);
    parts = std::max(
        parts, dt * (point.of(velocity) - of_body).norm() / (kMostOfRadius * inner_radius(body->shape)));
  }
  return std::min(parts, kMostForBodies);
}

}  // namespace

template <class Real>
int step_parts(const std::vector<Cloth<Real>>& cloths, const ClothContact<Real>* layers,
               const std::vector<Solid>& solids, double time, double dt) {
  double parts = 1;
  if (layers != nullptr) parts = std::clamp(layers->cells_passed() * dt / kMostCells, 1.0, kMostForCells);
  for (const Cloth<Real>& cloth : cloths) {
    if (layers != nullptr) parts = std::max(parts, parts_for_contact(cloth, cloths.size() == 1, dt));
    if (solids.empty()) continue;
    parts = std::max({parts, parts_for_pins(cloth, time, dt), parts_for_bodies(cloth, solids, dt)});
  }
  return static_cast<int>(std::ceil(parts - kRounding));
}

template int step_parts(const std::vector<Cloth<float>>&, const ClothContact<float>*,
                        const std::vector<Solid>&, double, double);
template int step_parts(const std::vector<Cloth<double>>&, const ClothContact<double>*,
                        const std::vector<Solid>&, double, double);

}  // namespace weft
