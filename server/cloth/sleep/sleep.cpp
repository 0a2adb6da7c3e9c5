#include "cloth/sleep/sleep.h"

#include <algorithm>
#include <utility>

namespace weft {
namespace {

/// A cloth faster than this many times the threshold (1 m/s by default) is not watched: it cannot rest.
constexpr double kPlainlyMoving = 10000;

template <class Real>
Eigen::AlignedBox3d box_around(const Particles<Real>& particles, double margin) {
  Eigen::AlignedBox3d box;
  const Grid& grid = particles.grid();
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) box.extend(particles.position_at(r, c));
  }
  const Vec3 more = Vec3::Constant(margin * box.sizes().maxCoeff());
  return {box.min() - more, box.max() + more};
}

}  // namespace

template <class Real>
bool Sleep::through(const Particles<Real>& particles, const std::vector<Solid>& solids, const Air& air) {
  const bool roused = std::exchange(roused_, false);
  if (threshold_ > 0) {
    const Vec3 wind = air.wind().velocity();
    if (!air.steady() || wind != wind_) {
      wind_ = wind;
      rise();
    }
    if (asleep_ && neighbours(solids) != neighbours_) rise();
  }
  if (company_ != Company::restless && quiet() && !asleep()) fall_asleep(particles, solids);
  if (resting_ && !asleep_) {
    if (!left_out_) box_ = box_around(particles, kMargin);
    left_out_ = !roused && neighbours(solids).has_value();
  } else {
    left_out_ = false;
  }
  return asleep_ || left_out_;
}

template <class Real>
void Sleep::stepped(double speed, double dt, const Particles<Real>& particles,
                    const std::vector<Solid>& solids) {
  if (speed >= kPlainlyMoving * threshold_) {
    watched_.clear();
    return;
  }
  if (!stayed(threshold_ * kQuietSteps * dt, particles)) {
    watch(particles);
    return;
  }
  quiet_steps_ = std::min(quiet_steps_ + 1, kQuietSteps);
  if (quiet_steps_ == kQuietSteps && company_ == Company::none) fall_asleep(particles, solids);
}

template <class Real>
void Sleep::fall_asleep(const Particles<Real>& particles, const std::vector<Solid>& solids) {
  box_ = box_around(particles, kMargin);
  if (auto resting = neighbours(solids)) {
    neighbours_ = std::move(*resting);
    asleep_ = true;
  }
}

template <class Real>
Sleeper Sleep::sleeper(const Particles<Real>& particles) const {
  if (asleep()) return {box_, true};
  return {box_around(particles, kMargin), quiet()};
}

template <class Real>
void Sleep::watch(const Particles<Real>& particles) {
  const Grid& grid = particles.grid();
  watched_.clear();
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) watched_.push_back(particles.position_at(r, c));
  }
  quiet_steps_ = 1;
}

template <class Real>
bool Sleep::stayed(double distance, const Particles<Real>& particles) const {
  const Grid& grid = particles.grid();
  if (watched_.size() != static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.cols))
    return false;
  auto was = watched_.begin();
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c, ++was) {
      if (!((particles.position_at(r, c) - *was).squaredNorm() < distance * distance)) return false;
    }
  }
  return true;
}

std::optional<std::vector<Sleep::Neighbour>> Sleep::neighbours(const std::vector<Solid>& solids) const {
  std::vector<Neighbour> near;
  for (const Solid& solid : solids) {
    const Eigen::AlignedBox3d bounds = solid.placed(1).bounds();
    if (!box_.intersects(bounds.merged(solid.placed(0).bounds()))) continue;
    if (solid.moves() || solid.yields()) return std::nullopt;
    near.push_back({solid.id, bounds.min(), bounds.max()});
  }
  return near;
}

template bool Sleep::through(const Particles<float>&, const std::vector<Solid>&, const Air&);
template bool Sleep::through(const Particles<double>&, const std::vector<Solid>&, const Air&);
template Sleeper Sleep::sleeper(const Particles<float>&) const;
template Sleeper Sleep::sleeper(const Particles<double>&) const;
template void Sleep::stepped(double, double, const Particles<float>&, const std::vector<Solid>&);
template void Sleep::stepped(double, double, const Particles<double>&, const std::vector<Solid>&);

}  // namespace weft
