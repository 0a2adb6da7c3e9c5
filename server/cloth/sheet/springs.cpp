#include "cloth/sheet/springs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "cloth/kernels/bands.h"
#include "cloth/kernels/implicit_kernels.h"
#include "cloth/kernels/limited_kernels.h"
#include "cloth/kernels/spring_kernels.h"
#include "cloth/kernels/strain_damping_kernels.h"
#include "cloth/kernels/torn_kernels.h"

namespace weft {
namespace {

/// Calls visit(d, stiffness) for every spring of the family that is not cut, d from end j to end i.
template <class Real, class Visit>
void for_each_spring(const Springs<Real>& springs, const SpringFamily& family,
                     const VectorField<Real>& position, Visit visit) {
  const Grid& grid = position.grid();
  for (int r = 0; r + family.rows < grid.rows; ++r) {
    for (int c = std::max(0, -family.cols); c + std::max(0, family.cols) < grid.cols; ++c) {
      if (springs.torn(family, r, c)) continue;
      const int r2 = r + family.rows, c2 = c + family.cols;
      const Vec3 d(double(position.x.at(r, c)) - double(position.x.at(r2, c2)),
                   double(position.y.at(r, c)) - double(position.y.at(r2, c2)),
                   double(position.z.at(r, c)) - double(position.z.at(r2, c2)));
      visit(d, family.stiffness_at(r, c, grid.rows, grid.cols));
    }
  }
}

/// The six families of Fig. 1's three kinds.
enum Kind { kAlongU, kAlongV, kFalling, kRising, kBendingU, kBendingV, kKinds };

Kind kind_of(const SpringFamily& family) {
  if (family.rows == 0) return family.cols == 1 ? kAlongU : kBendingU;
  if (family.cols == 0) return family.rows == 1 ? kAlongV : kBendingV;
  return family.cols > 0 ? kFalling : kRising;
}

}  // namespace

double spring_energy(const Vec3& d, double rest_length, double stiffness, const SpringLimit& limit) {
  const double stretch = d.norm() - rest_length, over = std::max(0.0, d.norm() - limit.length);
  return 0.5 * stiffness * (stretch * stretch + (limit.stiffening - 1) * over * over);
}

Vec3 spring_force(const Vec3& d, double rest_length, double stiffness, const SpringLimit& limit) {
  const double length = d.norm(), over = std::max(0.0, length - limit.length);
  if (length == 0) return Vec3::Zero();
  return -stiffness * (length - rest_length + (limit.stiffening - 1) * over) / length * d;
}

Eigen::Matrix3d spring_stiffness(const Vec3& d, double rest_length, double stiffness,
                                 const SpringLimit& limit) {
  const double length = d.norm();
  if (length == 0) return Eigen::Matrix3d::Zero();
  const Vec3 n = d / length;
  const Eigen::Matrix3d along = n * n.transpose(), across = Eigen::Matrix3d::Identity() - along;
  Eigen::Matrix3d own = stiffness * along + stiffness * (1 - rest_length / length) * across;
  if (length <= limit.length) return own;
  return own + (limit.stiffening - 1) * stiffness * (along + (1 - limit.length / length) * across);
}

template <class Real>
Springs<Real>::Springs(const Material& material, Discretization discretization, const Vec2& size,
                       const Grid& grid, double damping_time, bool limited)
    : damping_time_(damping_time), limited_(limited), grid_(grid) {
  const double hx = size.x() / (grid.cols - 1);
  const double hy = size.y() / (grid.rows - 1);
  const double diagonal = std::hypot(hx, hy);
  const bool continuum = discretization == Discretization::continuum;
  const double border_share = continuum ? 0.5 : 1.0;
  const auto add = [&](int rows, int cols, double rest_length, double constant, double shape) {
    const double stiffness = continuum ? constant * shape : constant;
    if (stiffness > 0) families_.push_back({rows, cols, rest_length, stiffness, border_share});
  };
  const auto add_limited = [&](int rows, int cols, double rest_length, double constant, double shape,
                               double limit_length) {
    const std::size_t before = families_.size();
    add(rows, cols, rest_length, constant, shape);
    if (limited && families_.size() > before)
      families_.back().limit = {limit_length, material.limit.stiffening};
  };
  const StrainLimit& limit = material.limit;
  const double locked = std::sqrt(diagonal * diagonal + 2 * hx * hy * std::sin(limit.shear));
  add_limited(0, 1, hx, material.structural.warp, hy / hx, hx * (1 + limit.warp));
  add_limited(1, 0, hy, material.structural.weft, hx / hy, hy * (1 + limit.weft));
  add_limited(1, 1, diagonal, material.shear, diagonal * diagonal / (2 * hx * hy), locked);
  add_limited(1, -1, diagonal, material.shear, diagonal * diagonal / (2 * hx * hy), locked);
  add(0, 2, 2 * hx, material.bending, hy / (2 * hx));
  add(2, 0, 2 * hy, material.bending, hx / (2 * hy));

  fill_columns();
  work_.assign(kernels::spring_work_size(grid), Real(0));
  if (damping_time_ > 0 || limited_) damping_work_.assign(kernels::strain_damping_work_size(grid), Real(0));
}

template <class Real>
void Springs<Real>::tear(std::shared_ptr<const TornLinks> torn) {
  torn_ = std::move(torn);
  fill_columns();
}

template <class Real>
void Springs<Real>::fill_columns() {
  const auto stride = static_cast<std::size_t>(grid_.stride);
  const int rows = torn_ ? grid_.rows : 1;
  columns_.assign(kKinds * stride * static_cast<std::size_t>(rows), Real(0));
  for (const SpringFamily& family : families_) {
    for (int r = 0; r < rows && (rows == 1 || r + family.rows < grid_.rows); ++r) {
      Real* row = columns_.data() +
                  (kind_of(family) * static_cast<std::size_t>(rows) + static_cast<std::size_t>(r)) * stride;
      // Springs that lie in a border row are scaled by the kernel.
      for (int c = std::max(0, -family.cols); c + std::max(0, family.cols) < grid_.cols; ++c) {
        const bool in_border_column = family.cols == 0 && (c == 0 || c == grid_.cols - 1);
        if (torn(family, r, c)) continue;
        row[c] =
            static_cast<Real>(in_border_column ? family.border_share * family.stiffness : family.stiffness);
      }
    }
  }
}

template <class Real>
kernels::SpringLattice<Real> Springs<Real>::lattice(const Grid& grid) const {
  kernels::SpringLattice<Real> lattice;
  const std::array<kernels::SpringColumns<Real>*, kKinds> of_kind{&lattice.along_u,   &lattice.along_v,
                                                                  &lattice.falling,   &lattice.rising,
                                                                  &lattice.bending_u, &lattice.bending_v};
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    of_kind[kind]->stiffness = columns_.data() + kind * (columns_.size() / kKinds);
  }
  lattice.row_step = torn_ ? grid.stride : 0;
  for (const SpringFamily& family : families_) {
    of_kind[kind_of(family)]->rest_length = static_cast<Real>(family.rest_length);
    lattice.has_shear = lattice.has_shear || kind_of(family) == kFalling;
    lattice.has_bending = lattice.has_bending || kind_of(family) == kBendingU;
    lattice.border_row_share = static_cast<Real>(family.border_share);
    if (!limited_ || !std::isfinite(family.limit.length)) continue;
    of_kind[kind_of(family)]->limit_length = static_cast<Real>(family.limit.length);
    lattice.excess = static_cast<Real>(family.limit.stiffening - 1);
  }
  return lattice;
}

template <class Real>
void Springs<Real>::add_forces(const VectorField<Real>& position, VectorField<Real>& force) const {
  if (families_.empty()) return;
  const Grid& grid = position.grid();
  const auto add_by = [&](auto&& add) {
    add(lattice(grid), grid, kernels::components(position), kernels::components(force), work_.data());
  };
  if (limited_) {
    add_by(torn_ ? kernels::add_limited_torn_spring_forces<Real> : kernels::add_limited_spring_forces<Real>);
  } else if (torn_) {
    add_by(kernels::add_torn_spring_forces<Real>);
  } else {
    add_by(kernels::add_spring_forces<Real>);
  }
}

template <class Real>
void Springs<Real>::add_damping(const VectorField<Real>& position, kernels::Components<const Real> velocity,
                                VectorField<Real>& force) const {
  if (damping_time_ == 0 || families_.empty()) return;
  const Grid& grid = position.grid();
  const auto add = torn_ ? kernels::add_torn_strain_damping<Real> : kernels::add_strain_damping<Real>;
  add(lattice(grid), grid, kernels::components(position), velocity, static_cast<Real>(damping_time_),
      kernels::components(force), damping_work_.data());
}

template <class Real>
void Springs<Real>::add_damping(const VectorField<Real>& position, kernels::Components<const Real> way,
                                double time, VectorField<Real>& force) const {
  if (damping_time_ == 0 || families_.empty()) return;
  const Grid& grid = position.grid();
  const auto add = torn_ ? kernels::add_torn_growth_damping<Real> : kernels::add_growth_damping<Real>;
  add(lattice(grid), grid, kernels::components(position), way, static_cast<Real>(damping_time_ / time),
      kernels::components(force), damping_work_.data());
}

template <class Real>
void Springs<Real>::add_limit_damping(const VectorField<Real>& position, const VectorField<Real>& velocity,
                                      double time, VectorField<Real>& force) const {
  if (!limited_ || families_.empty()) return;
  const Grid& grid = position.grid();
  const auto add = torn_ ? kernels::add_torn_limit_damping<Real> : kernels::add_limit_damping<Real>;
  add(lattice(grid), grid, kernels::components(position), kernels::components(velocity),
      static_cast<Real>(time), kernels::components(force), damping_work_.data());
}

template <class Real>
void Springs<Real>::linearise(const Grid& grid, kernels::Components<const Real> position,
                              const kernels::LinkFamilies<kernels::SpringLinks<Real>>& links,
                              double h) const {
  const kernels::SpringLattice<Real> springs = lattice(grid);
  const Real axial = static_cast<Real>(1 + damping_time_ / h);
  const auto linearise_by = [&](auto&& linearise) {
    Bands(grid).for_each(
        [&](kernels::RowRange rows, int) { linearise(springs, grid, position, axial, links, rows); });
  };
  if (limited_) {
    linearise_by(torn_ ? kernels::linearise_limited_torn_springs<Real>
                       : kernels::linearise_limited_springs<Real>);
  } else if (torn_) {
    linearise_by(kernels::linearise_torn_springs<Real>);
  } else {
    linearise_by(kernels::linearise_springs<Real>);
  }
}

template <class Real>
kernels::SpringModelError Springs<Real>::model_error(const Grid& grid,
                                                     kernels::Components<const Real> position,
                                                     kernels::Components<const Real> change) const {
  const auto error_by = [&](auto&& error) { return error(lattice(grid), grid, position, change); };
  if (limited_) {
    return error_by(torn_ ? kernels::limited_torn_spring_model_error<Real>
                          : kernels::limited_spring_model_error<Real>);
  }
  return error_by(torn_ ? kernels::torn_spring_model_error<Real> : kernels::spring_model_error<Real>);
}

template <class Real>
bool Springs<Real>::has_bending() const {
  return std::any_of(families_.begin(), families_.end(),
                     [](const SpringFamily& family) { return kind_of(family) == kBendingU; });
}

template <class Real>
double Springs<Real>::node_stiffness() const {
  double sum = 0;
  for (const SpringFamily& family : families_) sum += 2 * family.stiffness * family.limit.stiffening;
  return sum;
}

template <class Real>
double Springs<Real>::energy(const VectorField<Real>& position) const {
  if (families_.empty()) return 0;
  const Grid& grid = position.grid();
  return kernels::spring_energy(lattice(grid), grid, kernels::components(position));
}

template <class Real>
double Springs<Real>::energy_at_twice(const Grid& grid) const {
  double sum = 0;
  for (const SpringFamily& family : families_) {
    const double count = (grid.rows - family.rows) * (grid.cols - std::abs(family.cols));
    sum += count * family.stiffness * family.rest_length * family.rest_length / 2;
  }
  return sum;
}

template <class Real>
StructuralStrain Springs<Real>::structural_strain(const VectorField<Real>& position) const {
  StructuralStrain strain;
  double sum = 0;
  std::int64_t count = 0;
  for (const SpringFamily& family : families_) {
    if (kind_of(family) != kAlongU && kind_of(family) != kAlongV) continue;
    for_each_spring(*this, family, position, [&](const Vec3& d, double) {
      const double stretch = (d.norm() - family.rest_length) / family.rest_length;
      strain.max = std::max(strain.max, stretch);
      strain.max_compression = std::max(strain.max_compression, -stretch);
      sum += std::abs(stretch);
      ++count;
    });
  }
  if (count > 0) strain.mean = sum / static_cast<double>(count);
  return strain;
}

template <class Real>
kernels::SpringMotion Springs<Real>::motion(const Particles<Real>& particles) const {
  if (families_.empty()) return {};
  const Grid& grid = particles.grid();
  return kernels::spring_motion(lattice(grid), grid, kernels::components(particles.position),
                                kernels::components(particles.velocity));
}

template class Springs<float>;
template class Springs<double>;

}  // namespace weft
