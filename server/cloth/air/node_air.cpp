#include "cloth/air/node_air.h"

#include <algorithm>
#include <utility>

#include "cloth/kernels/extent_kernels.h"

namespace weft {
namespace {

/// As seen from `place`.
kernels::AirZone placed_zone(const WindZone& zone, const Vec3& place) {
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
    placed.centre[axis] = static_cast<float>(zone.position[axis] - place[axis]);
    placed.velocity[axis] = static_cast<float>(zone.velocity[axis]);
  }
  placed.one_over_edge = static_cast<float>(1 / zone.edge);
  return placed;
}

/// Around all that the zone changes, and as much again as its edge: for what the kernel rounds.
Eigen::AlignedBox3f box_around(const kernels::AirZone& zone) {
  Eigen::Vector3f half = Eigen::Vector3f::Constant(zone.radius + 2 / zone.one_over_edge);
  for (int axis = 0; axis < 3; ++axis) {
    half += zone.half[axis] * Eigen::Map<const Eigen::Vector3f>(zone.axes[axis]).cwiseAbs();
  }
  const Eigen::Map<const Eigen::Vector3f> centre(zone.centre);
  return {centre - half, centre + half};
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
  place_ = particles.place;
  look_ahead(particles.position.x, particles.velocity.x, ahead, points_.x);
  look_ahead(particles.position.y, particles.velocity.y, ahead, points_.y);
  look_ahead(particles.position.z, particles.velocity.z, ahead, points_.z);
  const Eigen::Vector3f everywhere = air.velocity(time).cast<float>();
  velocity_.x.fill(everywhere.x());
  velocity_.y.fill(everywhere.y());
  velocity_.z.fill(everywhere.z());
  if (!air.wind().zones.empty()) add_zones(air);
  if (air.turbulent()) add_eddies(air, spacing, time);
  return velocity_;
}

Eigen::AlignedBox3f NodeAir::box_around_points() {
  const Grid& grid = points_.grid();
  low_.resize(static_cast<std::size_t>(grid.cols));
  high_.resize(low_.size());
  Eigen::AlignedBox3f box;
  int axis = 0;
  for (const Field<float>* field : {&points_.x, &points_.y, &points_.z}) {
    kernels::column_extents(field->row(0), grid.rows, grid.stride, grid.cols, low_.data(), high_.data());
    box.min()[axis] = *std::min_element(low_.begin(), low_.end());
    box.max()[axis] = *std::max_element(high_.begin(), high_.end());
    ++axis;
  }
  return box;
}

void NodeAir::add_zones(const Air& air) {
  const Eigen::AlignedBox3f points = box_around_points();
  for (const WindZone& zone : air.wind().zones) {
    const kernels::AirZone placed = placed_zone(zone, place_);
    if (!box_around(placed).intersects(points)) continue;
    kernels::blend_zone(placed, kernels::components(std::as_const(points_)), points_.grid().size(),
                        kernels::components(velocity_));
  }
}

template const VectorField<float>& NodeAir::sample(const Air&, const Particles<float>&, const Vec2&, double,
                                                   double);
template const VectorField<float>& NodeAir::sample(const Air&, const Particles<double>&, const Vec2&, double,
                                                   double);

}  // namespace weft
