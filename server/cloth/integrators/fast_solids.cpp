#include "cloth/integrators/fast_solids.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "cloth/kernels/contact_kernels.h"

namespace weft {
namespace {

constexpr int kMostPartsBeside = 16;
/// The way of solid and cloth beside each other in a substep, of the solid's inner radius.
constexpr double kWayBeside = 1;
/// The same of a solid that moves, of its inner radius and of a cell.
constexpr double kWayBesideMoving = 0.25;
/// The way that the step itself gives the cloth, of the solid's inner radius: nobody foresees what that
/// strikes.
constexpr double kWayGained = 0.25;

/// Of the free nodes, m/s.
template <class Real>
Vec3 mean_of(const VectorField<Real>& velocity, const Particles<Real>& particles) {
  Vec3 momentum(0, 0, 0);
  double mass = 0;
  for (std::size_t i = 0; i < particles.grid().size(); ++i) {
    if (!(particles.inverse_mass.row(0)[i] > Real(0))) continue;
    const auto m = double(particles.mass.row(0)[i]);
    momentum += m * at(kernels::components(velocity), i);
    mass += m;
  }
  return mass > 0 ? Vec3(momentum / mass) : momentum;
}

}  // namespace

bool any_with_an_end(const std::vector<Solid>& solids) {
  return std::any_of(solids.begin(), solids.end(), [](const Solid& solid) { return solid.has_an_end(); });
}

template <class Real>
int parts_beside_fast_solids(const Particles<Real>& particles, const VectorField<Real>& velocity,
                             Contact<Real>& contact, const std::vector<Solid>& solids, double cell, double h,
                             double dt) {
  const auto v = kernels::components(velocity);
  const double fastest = std::sqrt(kernels::largest_square(v, v, Real(1), Real(0), particles.grid().size()));
  const auto longest = [&](const Solid& solid) {
    const double radius = inner_radius(solid.shape);
    return solid.moves() && !solid.yields() ? kWayBesideMoving * std::min(cell, radius) : kWayBeside * radius;
  };
  const auto may_be_fast = [&](const Solid& solid) {
    const double way = h * (fastest + (solid.position - solid.start).norm() / dt);
    return solid.has_an_end() && way > std::min(longest(solid), kWayGained * inner_radius(solid.shape));
  };
  if (std::none_of(solids.begin(), solids.end(), may_be_fast)) return 1;
  const Vec3 mean = mean_of(velocity, particles);
  const double gained = h * (mean - mean_of(particles.velocity, particles)).norm();
  const auto parts = [&](const Solid& solid) {
    const double way = h / dt * (solid.position - solid.start - dt * mean).norm();
    // Of half as long a part each the first gives a quarter of it.
    const double least =
        std::max(way / longest(solid), std::sqrt(gained / (kWayGained * inner_radius(solid.shape))));
    const double asked = std::min(std::max(1.0, std::ceil(least)), double(kMostPartsBeside));
    return static_cast<int>(std::bit_ceil(static_cast<unsigned>(asked)));
  };
  int most = 1;
  for (const Solid& solid : solids) {
    const bool touched = std::any_of(contact.touches().begin(), contact.touches().end(),
                                     [&](const Touch& touch) { return touch.collider == solid.id; });
    if (touched && may_be_fast(solid)) most = std::max(most, parts(solid));
  }
  for (const Arrival& arrival : contact.foresee(particles, velocity, solids, {0, 1, dt},
                                                [](const Solid& solid) { return solid.has_an_end(); }))
    most = std::max(most, parts(solids[arrival.solid]));
  return most;
}

template int parts_beside_fast_solids(const Particles<float>&, const VectorField<float>&, Contact<float>&,
                                      const std::vector<Solid>&, double, double, double);
template int parts_beside_fast_solids(const Particles<double>&, const VectorField<double>&, Contact<double>&,
                                      const std::vector<Solid>&, double, double, double);

}  // namespace weft
