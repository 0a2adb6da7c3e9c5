#include "cloth/forces/grab.h"

#include <algorithm>
#include <cmath>

#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// Calls visit(index, weight) for each node of the patch around `at`; the weights' sum is 1.
template <class Visit>
void for_each_in_patch(const Grid& grid, const Vec2& size, const Vec2& at, double radius, Visit visit) {
  struct Axis {
    double centre, reach;  ///< in cells
    int first, last;
    double weight(int i) const { return std::max(0.0, 1 - std::abs(i - centre) / reach); }
  };
  const auto axis = [&](double where, double length, int nodes) {
    const int cells = nodes - 1;
    Axis made{where * cells, std::max(1.0, radius / length * cells), 0, 0};
    made.first = std::max(0, static_cast<int>(std::ceil(made.centre - made.reach)));
    made.last = std::min(cells, static_cast<int>(std::floor(made.centre + made.reach)));
    return made;
  };
  const Axis u = axis(at.x(), size.x(), grid.cols), v = axis(at.y(), size.y(), grid.rows);
  const auto sum = [](const Axis& a) {
    double total = 0;
    for (int i = a.first; i <= a.last; ++i) total += a.weight(i);
    return total;
  };
  const double scale = 1 / (sum(u) * sum(v));
  for (int r = v.first; r <= v.last; ++r) {
    for (int c = u.first; c <= u.last; ++c) {
      const double weight = scale * u.weight(c) * v.weight(r);
      if (weight > 0) visit(grid.index(r, c), weight);
    }
  }
}

double patch_radius(const ClothDescription& cloth, double share) { return share * cloth.size.minCoeff(); }

double total_mass(const ClothDescription& cloth) {
  return cloth.material.density * cloth.size.x() * cloth.size.y();
}

}  // namespace

template <class Real>
bool Grabs<Real>::move(GrabId id, const Vec3& hand) {
  const auto found = std::find_if(grabs_.begin(), grabs_.end(), [&](const Grab& g) { return g.id == id; });
  if (found == grabs_.end()) return false;
  found->hand = hand;
  return true;
}

template <class Real>
bool Grabs<Real>::release(GrabId id) {
  return std::erase_if(grabs_, [&](const Grab& grab) { return grab.id == id; }) > 0;
}

template <class Real>
Vec3 Grabs<Real>::place(const Particles<Real>& particles, const ClothDescription& cloth, const Vec2& uv) {
  Vec3 local(0, 0, 0);
  for_each_in_patch(particles.grid(), cloth.size, uv, patch_radius(cloth, kPatch),
                    [&](std::size_t i, double weight) {
                      local += weight * at(kernels::components(particles.position), i);
                    });
  return particles.place + local;
}

template <class Real>
auto Grabs<Real>::pull_of(const Grab& grab, const Particles<Real>& particles,
                          const EffectContext& context) const -> Pull {
  const ClothDescription& cloth = *context.cloth;
  const double stiffness = total_mass(cloth) * kFrequency * kFrequency;
  // Half of critical for the whole cloth, or what the substep bears of it: half of its room, as a quicker
  // ball or wind may come on top.
  const double rate = kFrequency * largest_share(particles, cloth) * static_cast<double>(grabs_.size());
  const double damping = total_mass(cloth) * kFrequency * std::min(1.0, context.damping_limit / 2 / rate);
  Vec3 speed(0, 0, 0);
  for_each_in_patch(particles.grid(), cloth.size, grab.at, patch_radius(cloth, kPatch),
                    [&](std::size_t i, double weight) {
                      speed += weight * at(kernels::components(particles.velocity), i);
                    });
  const Vec3 whole = stiffness * (grab.hand - place(particles, cloth, grab.at)) - damping * speed;
  const double strength = whole.norm();
  const double share = strength > grab.max_force ? grab.max_force / strength : 1.0;
  return {share * whole, share};
}

template <class Real>
void Grabs<Real>::add_forces(const Particles<Real>& particles, const EffectContext& context,
                             VectorField<Real>& force) const {
  const ClothDescription& cloth = *context.cloth;
  const auto total = kernels::components(force);
  for (const Grab& grab : grabs_) {
    const Vec3 pull = pull_of(grab, particles, context).force;
    for_each_in_patch(particles.grid(), cloth.size, grab.at, patch_radius(cloth, kPatch),
                      [&](std::size_t i, double weight) {
                        total.x[i] += static_cast<Real>(weight * pull.x());
                        total.y[i] += static_cast<Real>(weight * pull.y());
                        total.z[i] += static_cast<Real>(weight * pull.z());
                      });
  }
}

template <class Real>
double Grabs<Real>::tension(const Particles<Real>& particles, const EffectContext& context) const {
  const Vec2& size = context.cloth->size;
  const Grid& grid = particles.grid();
  const double cell = std::max(size.x() / (grid.cols - 1), size.y() / (grid.rows - 1));
  const double width = 2 * std::max(cell, patch_radius(*context.cloth, kPatch));
  double sum = 0;
  for (const Grab& grab : grabs_) sum += pull_of(grab, particles, context).force.norm() / width;
  return sum;
}

template <class Real>
double Grabs<Real>::largest_share(const Particles<Real>& particles, const ClothDescription& cloth) const {
  const Real* inverse_mass = particles.inverse_mass.row(0);
  double most = 0;
  for (const Grab& grab : grabs_) {
    for_each_in_patch(particles.grid(), cloth.size, grab.at, patch_radius(cloth, kPatch),
                      [&](std::size_t i, double weight) {
                        most = std::max(most, total_mass(cloth) * weight * double(inverse_mass[i]));
                      });
  }
  return most;
}

template <class Real>
double Grabs<Real>::max_damping_rate(const Particles<Real>& particles, const EffectContext& context) const {
  // Of the springs alone, as the damping holds itself to what a substep bears: one of frequency w asks no
  // more of it than a damping rate of w. They may all hold the same patch.
  return kFrequency *
         std::sqrt(largest_share(particles, *context.cloth) * static_cast<double>(grabs_.size()));
}

template <class Real>
void Grabs<Real>::add_damping(const Particles<Real>& particles, const EffectContext& context,
                              const DampingMatrix<Real>& damping) const {
  add_shares(particles, context, total_mass(*context.cloth) * kFrequency, damping.scalar);
}

template <class Real>
void Grabs<Real>::add_stiffness(const Particles<Real>& particles, const EffectContext& context,
                                Real* stiffness) const {
  add_shares(particles, context, total_mass(*context.cloth) * kFrequency * kFrequency, stiffness);
}

template <class Real>
void Grabs<Real>::add_shares(const Particles<Real>& particles, const EffectContext& context, double of_each,
                             Real* sum) const {
  const ClothDescription& cloth = *context.cloth;
  for (const Grab& grab : grabs_) {
    // A hand that slips hardly feels where the cloth is.
    const double share = pull_of(grab, particles, context).share;
    for_each_in_patch(
        particles.grid(), cloth.size, grab.at, patch_radius(cloth, kPatch),
        [&](std::size_t i, double weight) { sum[i] += static_cast<Real>(share * weight * of_each); });
  }
}

template class Grabs<float>;
template class Grabs<double>;

}  // namespace weft
