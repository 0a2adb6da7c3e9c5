#include "cloth/sleep.h"

namespace weft {
namespace {

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

bool Sleep::through(const std::vector<Solid>& solids, const Wind& wind) {
  if (threshold_ <= 0) return false;
  if (wind.velocity() != wind_) {
    wind_ = wind.velocity();
    wake();
  }
  if (asleep_ && neighbours(solids) != neighbours_) wake();
  return asleep_;
}

template <class Real>
void Sleep::stepped(double speed, const Particles<Real>& particles, const std::vector<Solid>& solids) {
  quiet_steps_ = speed < threshold_ ? quiet_steps_ + 1 : 0;
  if (quiet_steps_ < kQuietSteps) return;
  box_ = box_around(particles, kMargin);
  if (auto resting = neighbours(solids)) {
    neighbours_ = std::move(*resting);
    asleep_ = true;
  }
}

std::optional<std::vector<Sleep::Neighbour>> Sleep::neighbours(const std::vector<Solid>& solids) const {
  std::vector<Neighbour> near;
  for (const Solid& solid : solids) {
    const Eigen::AlignedBox3d bounds = solid.placed(1).bounds();
    if (!box_.intersects(bounds.merged(solid.placed(0).bounds()))) continue;
    const bool moves = solid.position != solid.start || !solid.velocity.isZero(0);
    if (moves || solid.yields()) return std::nullopt;
    near.push_back({solid.id, bounds.min(), bounds.max()});
  }
  return near;
}

template void Sleep::stepped(double, const Particles<float>&, const std::vector<Solid>&);
template void Sleep::stepped(double, const Particles<double>&, const std::vector<Solid>&);

}  // namespace weft
