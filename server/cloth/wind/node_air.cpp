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
  if (air.turbulent()) add_eddies(air, spacing, time);
  return velocity_;
}

void NodeAir::add_zones(const Air& air) {
  for (const WindZone& zone : air.wind().zones) {
    kernels::blend_zone(placed_zone(zone), kernels::components(std::as_const(points_)), points_.grid().size(),
                        kernels::components(velocity_));
  }
}

template const VectorField<float>& NodeAir::sample(const Air&, const Particles<float>&, const Vec2&, double,
                                                   double);
template const VectorField<float>& NodeAir::sample(const Air&, const Particles<double>&, const Vec2&, double,
                                                   double);

}  // namespace weft
