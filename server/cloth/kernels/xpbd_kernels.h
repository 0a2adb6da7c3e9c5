#pragma once
#include "cloth/kernels/components.h"

namespace weft::kernels {

/// How the nodes of a row lie while XPBD projects: by column modulo 4, in the order 1, 2, 3, 0, `width` lanes
/// each and one more for the last column. Springs to the next or the second next column then join two runs of
/// lanes that do not meet: whole vectors, no gathers. A row holds seven fields of `stride` scalars each: x,
/// y, z where the substep began, x, y, z of the move since, and the inverse mass. Apart, as their sum is
/// rounded to 1e-7 m: stiff springs take that back each substep, which as a velocity, 1e-7 m / h, shakes a
/// cloth for ever.
struct QuarterRows {
  int rows = 0, cols = 0;
  int width = 0;           ///< lanes of a quarter, a multiple of 8
  std::size_t stride = 0;  ///< scalars from one field to the next

  QuarterRows() = default;
  explicit QuarterRows(const Grid& grid);
  std::size_t size() const { return static_cast<std::size_t>(rows) * row_size(); }
  static constexpr int kMove = 3, kInverseMass = 6, kFields = 7;
  std::size_t row_size() const { return kFields * stride; }
  /// Where the columns col, col + 4, col + 8, ... begin.
  int lane(int col) const { return (col + 3) % 4 * width + col / 4; }
};

/// One SpringFamily (spring_family.h) for substeps of h seconds.
template <class Real>
struct XpbdSprings {
  int rows = 0, cols = 0;           ///< offset to the other end
  Real rest_length = 0;             ///< m
  Real border_row_share = 0;        ///< of the stiffness, for springs that lie in the first or last row
  const Real* stiffness = nullptr;  ///< k h^2, kg, at the lane of the left end; 0 where there is no spring
  Real damping = 0;                 ///< gamma = tau / h, if the springs resist the rate of their length too
  Real* multiplier = nullptr;       ///< of damped springs, kg m, a row of lanes for each row: kept by recall
  Real limit_length = 0;            ///< m, beyond which project_limited has them stiffer
  Real excess = 0;                  ///< by so many times their stiffness
  std::ptrdiff_t row_step = 0;      ///< from one row's stiffnesses to the next one's, for project_torn
};

/// The nodes as the rest of the program has them.
template <class Real>
struct XpbdNodes {
  Components<const Real> force;
  const Real* inverse_mass;
  Components<Real> velocity, position;
  Components<Real>
      rounded_off;  ///< what the position's rounding left out, m: taken along into the next substep
};

/// Copies the inverse masses into `sheet`, whose lanes without a node must be zero.
void set_inverse_masses(const QuarterRows& layout, const Grid& grid, const float* inverse_mass, float* sheet);
void set_inverse_masses(const QuarterRows& layout, const Grid& grid, const double* inverse_mass,
                        double* sheet);

/// v += impulse_time F / m; r and the move, what was rounded off and h v, into `sheet`. Where inverse_mass is
/// 0, v becomes 0. `row` is work space of grid.stride scalars.
void predict(const QuarterRows& layout, const Grid& grid, const XpbdNodes<float>& nodes, float impulse_time,
             float h, float* sheet, float* row);
void predict(const QuarterRows& layout, const Grid& grid, const XpbdNodes<double>& nodes, double impulse_time,
             double h, double* sheet, double* row);

/// Begins damped springs' multipliers with gamma / (1 + gamma) of what they were at the last substep's end,
/// and moves the ends by that. Begun from zero, a spring under a load F would be left up to
/// F h^2 (1 + gamma) (w_i + w_j) longer than F / k, as the sweep has it resist the very moves that bring it
/// back. Of the multiplier 1 / (1 + gamma) is now missing, which leaves F h^2 (w_i + w_j), as without
/// damping. Springs that turn round or double within a substep begin from zero.
void recall(const QuarterRows& layout, const XpbdSprings<float>& springs, float* sheet);
void recall(const QuarterRows& layout, const XpbdSprings<double>& springs, double* sheet);

/// One sweep over the family's springs: each is projected once, in two colours. XPBD with compliance 1/k and
/// a multiplier that starts from lambda, zero where nothing is damped, moves end i along the spring by
/// w_i (l0 - l - gamma dl - lambda / (k h^2)) / ((1 + gamma) (w_i + w_j) + 1 / (k h^2)), dl being how much
/// longer the substep's moves have made the spring (Macklin et al. 2016, Eq. 26); coincident ends stay where
/// they are.
void project(const QuarterRows& layout, const XpbdSprings<float>& springs, float* sheet);
void project(const QuarterRows& layout, const XpbdSprings<double>& springs, double* sheet);

/// Takes over the projected moves d: v += (d - d predicted) / h, r += d. `row` as above.
void take_over(const QuarterRows& layout, const Grid& grid, const float* sheet, float h,
               const XpbdNodes<float>& nodes, float* row);
void take_over(const QuarterRows& layout, const Grid& grid, const double* sheet, double h,
               const XpbdNodes<double>& nodes, double* row);

}  // namespace weft::kernels
