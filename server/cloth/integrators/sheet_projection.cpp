#include "cloth/integrators/sheet_projection.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cloth/kernels/limited_kernels.h"
#include "cloth/kernels/torn_kernels.h"

namespace weft {
namespace {

/// As long as the plate lets it be, s.
template <class Real>
double damping_time(const Sheet<Real>& sheet, const Field<Real>& mass, double h) {
  const double time = sheet.springs().damping_time();
  if (time <= h || sheet.plate() == nullptr) return time;
  return sheet.plate()->max_squared_frequency(mass) * h * h > 4 ? h : time;
}

}  // namespace

template <class Real>
void SheetProjection<Real>::prepare(const Sheet<Real>& sheet, const Field<Real>& mass,
                                    const kernels::QuarterRows& layout, double h) {
  layout_ = layout;
  prepare_springs(sheet.springs(), mass.grid(), damping_time(sheet, mass, h), h);
  plate_.clear();
  if (const Plate<Real>* plate = sheet.plate()) {
    plate_.assign(kernels::plate_lanes_size(layout_), Real(0));
    kernels::set_plate_lanes(layout_, plate->grid(), plate->stencils(), static_cast<Real>(h * h),
                             plate_.data());
  }
}

template <class Real>
void SheetProjection<Real>::scale_substep(Real ratio) {
  for (Real& each : multiplier_) each *= ratio * ratio;
}

template <class Real>
void SheetProjection<Real>::keep_multipliers(const std::vector<SpringFamily>& families,
                                             std::size_t sheet_lanes) {
  std::vector<std::array<int, 2>> now;  // as the kernels go through them
  for (auto family = families.rbegin(); family != families.rend(); ++family)
    now.push_back({family->rows, family->cols});
  if (!multiplier_.empty() && now == families_) return;
  const auto before = std::exchange(multiplier_, {});
  const auto families_before = std::exchange(families_, now);
  multiplier_.resize(now.size() * sheet_lanes);
  if (before.empty()) return;
  auto block = multiplier_.begin();
  for (const std::array<int, 2>& family : now) {
    const auto same = std::find(families_before.begin(), families_before.end(), family);
    if (same != families_before.end())
      std::copy_n(
          before.begin() + (same - families_before.begin()) * static_cast<std::ptrdiff_t>(sheet_lanes),
          sheet_lanes, block);
    block += static_cast<std::ptrdiff_t>(sheet_lanes);
  }
}

template <class Real>
void SheetProjection<Real>::prepare_springs(const Springs<Real>& springs, const Grid& grid,
                                            double damping_time, double h) {
  const std::vector<SpringFamily>& families = springs.families();
  const std::size_t lanes = layout_.stride;
  const int rows = springs.torn() ? grid.rows : 1;
  stiffness_.assign(families.size() * static_cast<std::size_t>(rows) * lanes, Real(0));
  const std::size_t sheet_lanes = lanes * static_cast<std::size_t>(grid.rows);
  if (springs.damping_time() > 0) {
    keep_multipliers(families, sheet_lanes);
  } else {
    multiplier_.clear();
  }
  springs_.clear();
  // Bending, shear, structural: the stiffest have the last word.
  for (auto family = families.rbegin(); family != families.rend(); ++family) {
    Real* stiffness = stiffness_.data() + springs_.size() * static_cast<std::size_t>(rows) * lanes;
    for (int r = 0; r < rows && (rows == 1 || r + family->rows < grid.rows); ++r) {
      for (int c = std::max(0, -family->cols); c + std::max(0, family->cols) < grid.cols; ++c) {
        // Springs that lie in a border row are scaled by the kernel.
        const bool in_border_column = family->cols == 0 && (c == 0 || c == grid.cols - 1);
        const double share = in_border_column ? family->border_share : 1.0;
        if (springs.torn(*family, r, c)) continue;
        stiffness[static_cast<std::size_t>(r) * lanes +
                  static_cast<std::size_t>(layout_.lane(std::min(c, c + family->cols)))] =
            static_cast<Real>(share * family->stiffness * h * h);
      }
    }
    springs_.push_back({family->rows, family->cols, static_cast<Real>(family->rest_length),
                        static_cast<Real>(family->border_share), stiffness,
                        static_cast<Real>(damping_time / h)});
    if (!multiplier_.empty()) {
      springs_.back().multiplier = multiplier_.data() + (springs_.size() - 1) * sheet_lanes;
    }
    springs_.back().row_step = springs.torn() ? static_cast<std::ptrdiff_t>(lanes) : 0;
    if (std::isfinite(family->limit.length)) {
      springs_.back().limit_length = static_cast<Real>(family->limit.length);
      springs_.back().excess = static_cast<Real>(family->limit.stiffening - 1);
    }
  }
}

template <class Real>
void SheetProjection<Real>::recall(Real* nodes) const {
  if (multiplier_.empty()) return;
  for (const auto& family : springs_) kernels::recall(layout_, family, nodes);
}

template <class Real>
void SheetProjection<Real>::project(Real* nodes) const {
  if (!plate_.empty()) kernels::project_plate(layout_, plate_.data(), nodes);
  for (const auto& family : springs_) {
    const bool torn = family.row_step > 0;
    if (family.excess > Real(0)) {
      (torn ? kernels::project_limited_torn<Real> : kernels::project_limited<Real>)(layout_, family, nodes);
    } else if (torn) {
      kernels::project_torn(layout_, family, nodes);
    } else {
      kernels::project(layout_, family, nodes);
    }
  }
}

template class SheetProjection<float>;
template class SheetProjection<double>;

}  // namespace weft
