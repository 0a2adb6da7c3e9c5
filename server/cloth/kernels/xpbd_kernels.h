#pragma once
#include "cloth/kernels/components.h"

namespace weft::kernels {

/// How the nodes of a row lie while XPBD projects: by column modulo 4, in the order 1, 2, 3, 0, `width` lanes
/// each and one more for the last column. Springs to the next or the second next column then join two runs of
/// lanes that do not meet: whole vectors, no gathers. A row holds x, y, z and the inverse mass, `stride`
/// scalars each.
struct QuarterRows {
  int rows = 0, cols = 0;
  int width = 0;           ///< lanes of a quarter, a multiple of 8
  std::size_t stride = 0;  ///< scalars from one component to the next; a row takes four of them

  QuarterRows() = default;
  explicit QuarterRows(const Grid& grid);
  std::size_t size() const { return static_cast<std::size_t>(rows) * row_size(); }
  std::size_t row_size() const { return 4 * stride; }
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
};

/// The nodes as the rest of the program has them.
template <class Real>
struct XpbdNodes {
  Components<const Real> force;
  const Real* inverse_mass;
  Components<Real> velocity, position;
};

/// Copies the inverse masses into `sheet`, whose lanes without a node must be zero.
void set_inverse_masses(const QuarterRows& layout, const Grid& grid, const float* inverse_mass, float* sheet);
void set_inverse_masses(const QuarterRows& layout, const Grid& grid, const double* inverse_mass,
                        double* sheet);

/// v += impulse_time F / m, r += h v, and r into `sheet`. Where inverse_mass is 0, v becomes 0.
void predict(const QuarterRows& layout, const Grid& grid, const XpbdNodes<float>& nodes, float impulse_time,
             float h, float* sheet);
void predict(const QuarterRows& layout, const Grid& grid, const XpbdNodes<double>& nodes, double impulse_time,
             double h, double* sheet);

/// One sweep over the family's springs: each is projected once, in two colours. XPBD with compliance 1/k and
/// a multiplier that starts from zero moves end i along the spring by
/// w_i (l0 - l) / (w_i + w_j + 1 / (k h^2)); coincident ends stay where they are.
void project(const QuarterRows& layout, const XpbdSprings<float>& springs, float* sheet);
void project(const QuarterRows& layout, const XpbdSprings<double>& springs, double* sheet);

/// Takes over the projected positions p: v += (p - r) / h, r = p. Not (p - r_before) / h: in single precision
/// that would round every velocity to multiples of 1e-7 m / h. `row` is work space of grid.stride scalars.
void take_over(const QuarterRows& layout, const Grid& grid, const float* sheet, float h,
               const XpbdNodes<float>& nodes, float* row);
void take_over(const QuarterRows& layout, const Grid& grid, const double* sheet, double h,
               const XpbdNodes<double>& nodes, double* row);

}  // namespace weft::kernels
