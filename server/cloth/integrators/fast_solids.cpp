#include "cloth/integrators/fast_solids.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "cloth/kernels/contact_kernels.h"

namespace weft {
namespace {

constexpr int kMostParts = 16;
/// The way of solid and cloth beside each other in a substep, of the solid's inner radius.
constexpr double kWayBeside = 1;
/// The same of a solid that moves, of its inner radius and of a cell.
constexpr double kWayBesideMoving = 0.25;

bool is_firm_with_an_end(const Solid& solid) {
  return !solid.yields() && !std::holds_alternative<HalfSpace>(solid.shape);
}

/// Of the free nodes, m/s.
template <class Real>
Vec3 mean_velocity(const Particles<Real>& particles) {
  Vec3 momentum(0, 0, 0);
  double mass = 0;
  for (std::size_t i = 0; i < particles.grid().size(); ++i) {
    if (!(particles.inverse_mass.row(0)[i] > Real(0))) continue;
    const auto m = double(particles.mass.row(0)[i]);
    momentum += m * at(kernels::components(particles.velocity), i);
    mass += m;
  }
  return mass > 0 ? Vec3(momentum / mass) : momentum;
}

}  // namespace

template <class Real>
int parts_beside_fast_solids(const Particles<Real>& particles, Contact<Real>& contact,
                             const std::vector<Solid>& solids, double cell, double h, double dt) {
  const auto velocity = kernels::components(particles.velocity);
  const double fastest =
      std::sqrt(kernels::largest_square(velocity, velocity, Real(1), Real(0), particles.grid().size()));
  const auto longest = [&](const Solid& solid) {
    const double radius = inner_radius(solid.shape);
    return solid.moves() ? kWayBesideMoving * std::min(cell, radius) : kWayBeside * radius;
  };
  const auto parts = [&](const Solid& solid, const Vec3& beside) {
    const double way = h / dt * (solid.position - solid.start - dt * beside).norm();
    const double least = std::min(std::ceil(way / longest(solid)), double(kMostParts));
    return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(least, 1.0))));
  };
  const auto may_be_fast = [&](const Solid& solid) {
    return is_firm_with_an_end(solid) &&
           h * (fastest + (solid.position - solid.start).norm() / dt) > longest(solid);
  };
  if (std::none_of(solids.begin(), solids.end(), may_be_fast)) return 1;
  const Vec3 mean = mean_velocity(particles);
  int most = 1;
  for (const Solid& solid : solids) {
    const bool touched = std::any_of(contact.touches().begin(), contact.touches().end(),
                                     [&](const Touch& touch) { return touch.collider == solid.id; });
    if (touched && may_be_fast(solid)) most = std::max(most, parts(solid, mean));
  }
  for (const Arrival& arrival : contact.foresee(particles, solids, {0, 1, dt}, is_firm_with_an_end))
    most = std::max(most, parts(solids[arrival.solid], mean));
  return most;
}

template int parts_beside_fast_solids(const Particles<float>&, Contact<float>&, const std::vector<Solid>&,
                                      double, double, double);
template int parts_beside_fast_solids(const Particles<double>&, Contact<double>&, const std::vector<Solid>&,
                                      double, double, double);

}  // namespace weft
