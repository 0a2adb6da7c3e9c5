#include "cloth/air/gas.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cloth/kernels/implicit_kernels.h"
#include "cloth/kernels/node_kernels.h"
#include "cloth/kernels/pressure_kernels.h"

namespace weft {
namespace {

/// Overwrites `gradient` by dV/dr, m2. Returns V, m3: as all of a closed surface's add up to nothing it does
/// not matter how far off the origin is.
template <class Real>
double differentiate_volume(const Grid& grid, kernels::Components<const Real> position,
                            VectorField<Real>& gradient, std::vector<Real, AlignedAllocator<Real>>& work) {
  if (gradient.grid() != grid) gradient = VectorField<Real>(grid);
  gradient.fill(Real(0));
  work.resize(kernels::pressure_work_size(grid));
  kernels::add_pressure(grid, position, Real(1), kernels::components(gradient), work.data());
  return kernels::dot<Real>(position, kernels::components(gradient), grid) / 3;
}

}  // namespace

template <class Real>
double enclosed_volume(const VectorField<Real>& position) {
  VectorField<Real> gradient;
  std::vector<Real, AlignedAllocator<Real>> work;
  return differentiate_volume<Real>(position.grid(), kernels::components(position), gradient, work);
}

template <class Real>
double Gas<Real>::amount(double time) const {
  const double all = (kOutside + inflation_.pressure) * inflation_.volume.value();
  const double share =
      inflation_.fill_time > 0 ? std::clamp((time - begin_) / inflation_.fill_time, 0.0, 1.0) : 1;
  return begin_amount_ + share * (all - begin_amount_);
}

template <class Real>
double Gas<Real>::pressure(double volume, double time) const {
  return amount(time) / std::max(volume, kLeastShare * inflation_.volume.value()) - kOutside;
}

template <class Real>
double Gas<Real>::energy_change(double volume, double change, double amount) const {
  const double least = kLeastShare * inflation_.volume.value();
  const double above = std::max(volume, least), above_then = std::max(volume + change, least);
  const double logarithm = std::log1p((above_then - above) / above);
  // Below the least volume the pressure stays the same.
  const double rest = (change - (above_then - above)) / least;
  return kOutside * change - amount * (logarithm + rest);
}

template <class Real>
double Gas<Real>::energy(const VectorField<Real>& position, double time) const {
  const double full = inflation_.volume.value();
  return energy_change(full, enclosed_volume(position) - full, amount(time));
}

template <class Real>
double Gas<Real>::differentiate(const Particles<Real>& particles, const Seam<Real>& seam) {
  const Grid& grid = particles.grid();
  const double volume =
      differentiate_volume<Real>(grid, kernels::components(particles.position), gradient_, work_);
  const Real* inverse_mass = particles.inverse_mass.row(0);
  for (Field<Real>* component : {&gradient_.x, &gradient_.y, &gradient_.z}) {
    Real* values = component->row(0);
    for (std::size_t i = 0; i < grid.size(); ++i) values[i] = inverse_mass[i] > Real(0) ? values[i] : Real(0);
  }
  seam.average(kernels::components(gradient_));
  return volume;
}

template <class Real>
void Gas<Real>::push(Particles<Real>& particles, const Seam<Real>& seam, double time, double h) {
  const double volume = differentiate(particles, seam);
  const kernels::Components<const Real> gradient = kernels::components(std::as_const(gradient_));
  const Real* inverse_mass = particles.inverse_mass.row(0);
  const double ease = h * h * kernels::weighted_square<Real>(inverse_mass, gradient, particles.grid());
  if (!(ease > 0)) return;  // all is held
  // V^2 - b V - ease c = 0, the root in the form that loses no digits.
  const double b = volume - ease * kOutside, product = ease * amount(time);
  const double root = std::sqrt(b * b + 4 * product);
  const double then = b > 0 ? (b + root) / 2 : 2 * product / (root - b);
  const double pushed = pressure(then, time);
  const std::size_t count = particles.grid().size();
  kernels::add_weighted(kernels::components(particles.velocity), gradient, inverse_mass,
                        static_cast<Real>(h * pushed), count);
  kernels::add_weighted(kernels::components(particles.position), gradient, inverse_mass,
                        static_cast<Real>(h * h * pushed), count);
}

template <class Real>
void Gas<Real>::add_force(const Particles<Real>& particles, const Seam<Real>& seam, double time,
                          VectorField<Real>& force) {
  volume_ = differentiate(particles, seam);
  amount_ = amount(time);
  pressure_ = pressure(volume_, time);
  const double least = std::max(volume_, kLeastShare * inflation_.volume.value());
  stiffness_ = amount_ / (least * least);
  kernels::add_scaled(kernels::components(force), kernels::components(std::as_const(gradient_)),
                      static_cast<Real>(pressure_), particles.grid().size());
}

template <class Real>
double Gas<Real>::growth(kernels::Components<const Real> position, kernels::Components<const Real> change,
                         double share) {
  const Grid& grid = gradient_.grid();
  if (moved_.grid() != grid) moved_ = VectorField<Real>(grid);
  const auto move = [&](Field<Real>& moved, const Real* from, const Real* by) {
    std::transform(from, from + grid.size(), by, moved.row(0),
                   [part = static_cast<Real>(share)](Real x, Real dx) { return x + part * dx; });
  };
  move(moved_.x, position.x, change.x);
  move(moved_.y, position.y, change.y);
  move(moved_.z, position.z, change.z);
  differentiate_volume<Real>(grid, kernels::components(std::as_const(moved_)), moved_gradient_, work_);
  return kernels::dot<Real>(kernels::components(std::as_const(moved_gradient_)), change, grid);
}

template <class Real>
double Gas<Real>::model_error(kernels::Components<const Real> position,
                              kernels::Components<const Real> change) {
  // The volume is cubic in the positions, its rate along the change quadratic: Simpson's rule is exact, and
  // loses no digits of a small change.
  const double linear =
      kernels::dot<Real>(kernels::components(std::as_const(gradient_)), change, gradient_.grid());
  const double grown = (linear + 4 * growth(position, change, 0.5) + growth(position, change, 1)) / 6;
  return energy_change(volume_, grown, amount_) + pressure_ * linear - stiffness_ * linear * linear / 2;
}

template double enclosed_volume(const VectorField<float>&);
template double enclosed_volume(const VectorField<double>&);
template class Gas<float>;
template class Gas<double>;

}  // namespace weft
