#include <utility>

#include "cloth/air/node_air.h"

namespace weft {
namespace {

/// Nodes from one that is evaluated to the next: the most, in powers of two, that divide the row's `cells`
/// and keep them within `most`, m.
int nodes_apart(int cells, double spacing, double most) {
  int apart = 1;
  while (cells % (2 * apart) == 0 && 2 * apart * spacing <= most) apart *= 2;
  return apart;
}

/// Every so many rows and columns, one after the other.
void pick(const Field<float>& from, int rows, int cols, float* to) {
  for (int r = 0; r < from.grid().rows; r += rows) {
    for (int c = 0; c < from.grid().cols; c += cols) *to++ = from.at(r, c);
  }
}

}  // namespace

void NodeAir::add_eddies(const Air& air, const Vec2& spacing, double time) {
  const Grid& grid = points_.grid();
  const double most = kSpacing * air.wind().turbulence.length_scale;
  const int rows = nodes_apart(grid.rows - 1, spacing.y(), most);
  const int cols = nodes_apart(grid.cols - 1, spacing.x(), most);
  if (rows == 1 && cols == 1) {
    air.add_eddies(time, place_, kernels::components(std::as_const(points_)), grid.size(),
                   kernels::components(velocity_));
    return;
  }
  const int few_rows = (grid.rows - 1) / rows + 1, few_cols = (grid.cols - 1) / cols + 1;
  const Grid few = Grid::with_nodes(1, few_rows * few_cols);
  if (few_points_.grid() != few) few_points_ = few_velocity_ = VectorField<float>(few);
  pick(points_.x, rows, cols, few_points_.x.row(0));
  pick(points_.y, rows, cols, few_points_.y.row(0));
  pick(points_.z, rows, cols, few_points_.z.row(0));
  few_velocity_.fill(0);
  air.add_eddies(time, place_, kernels::components(std::as_const(few_points_)), few.size(),
                 kernels::components(few_velocity_));
  kernels::add_between(few_rows, few_cols, kernels::components(std::as_const(few_velocity_)), rows, cols,
                       grid, kernels::components(velocity_));
}

}  // namespace weft
