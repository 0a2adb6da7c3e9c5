#include "cloth/wind/node_air.h"

#include <algorithm>
#include <utility>

namespace weft {
namespace {

kernels::AirZone placed_zone(const WindZone& zone) {
  kernels::AirZone placed{};
  Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();
  if (const auto* box = std::get_if<BoxZone>(&zone.shape)) {
    axes = box->orientation.cast<float>().toRotationMatrix();
    for (int i = 0; i < 3; ++i) placed.half[i] = static_cast<float>(box->size[i] / 2);
  } else {
    placed.radius = static_cast<float>(std::get<SphereZone>(zone.shape).radius);
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 3; ++i) placed.axes[axis][i] = axes(i, axis);
    placed.centre[axis] = static_cast<float>(zone.position[axis]);
    placed.velocity[axis] = static_cast<float>(zone.velocity[axis]);
  }
  placed.one_over_edge = static_cast<float>(1 / zone.edge);
  return placed;
}

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

template <class Real>
void look_ahead(const Field<Real>& position, const Field<Real>& velocity, double ahead, Field<float>& point) {
  const Real seconds = static_cast<Real>(ahead);
  std::transform(position.values().begin(), position.values().end(), velocity.values().begin(),
                 point.values().begin(),
                 [seconds](Real at, Real speed) { return static_cast<float>(at + seconds * speed); });
}

}  // namespace

template <class Real>
const VectorField<float>& NodeAir::sample(const Air& air, const Particles<Real>& particles,
                                          const Vec2& spacing, double time, double ahead) {
  const Grid& grid = particles.grid();
  if (velocity_.grid() != grid) points_ = velocity_ = VectorField<float>(grid);
  look_ahead(particles.position.x, particles.velocity.x, ahead, points_.x);
  look_ahead(particles.position.y, particles.velocity.y, ahead, points_.y);
  look_ahead(particles.position.z, particles.velocity.z, ahead, points_.z);
  const Eigen::Vector3f everywhere = air.velocity(time).cast<float>();
  velocity_.x.fill(everywhere.x());
  velocity_.y.fill(everywhere.y());
  velocity_.z.fill(everywhere.z());
  add_zones(air);
  add_eddies(air, spacing, time);
  return velocity_;
}

void NodeAir::add_zones(const Air& air) {
  for (const WindZone& zone : air.wind().zones) {
    kernels::blend_zone(placed_zone(zone), kernels::components(std::as_const(points_)), points_.grid().size(),
                        kernels::components(velocity_));
  }
}

void NodeAir::add_eddies(const Air& air, const Vec2& spacing, double time) {
  const Grid& grid = points_.grid();
  const double most = kSpacing * air.wind().turbulence.length_scale;
  const int rows = nodes_apart(grid.rows - 1, spacing.y(), most);
  const int cols = nodes_apart(grid.cols - 1, spacing.x(), most);
  if (rows == 1 && cols == 1) {
    air.add_eddies(time, kernels::components(std::as_const(points_)), grid.size(),
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
  air.add_eddies(time, kernels::components(std::as_const(few_points_)), few.size(),
                 kernels::components(few_velocity_));
  kernels::add_between(few_rows, few_cols, kernels::components(std::as_const(few_velocity_)), rows, cols,
                       grid, kernels::components(velocity_));
}

template const VectorField<float>& NodeAir::sample(const Air&, const Particles<float>&, const Vec2&, double,
                                                   double);
template const VectorField<float>& NodeAir::sample(const Air&, const Particles<double>&, const Vec2&, double,
                                                   double);

}  // namespace weft
