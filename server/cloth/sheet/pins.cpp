#include "cloth/sheet/pins.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "cloth/kernels/node_vector.h"

namespace weft {
namespace {

/// Earlier than this before a pin's time is that time, s: what sums of steps are off by.
constexpr double kPinTimeRounding = 1e-9;

/// Adds the other node of every pair of which one is there; `nodes` ascend.
template <class Real>
void add_sewn(const Seam<Real>& seam, std::vector<std::size_t>& nodes) {
  std::vector<std::size_t> added;
  for (const auto& [left, right] : seam.pairs()) {
    const bool has_left = std::binary_search(nodes.begin(), nodes.end(), left);
    const bool has_right = std::binary_search(nodes.begin(), nodes.end(), right);
    if (has_left != has_right) added.push_back(has_left ? right : left);
  }
  nodes.insert(nodes.end(), added.begin(), added.end());
}

}  // namespace

std::vector<std::size_t> nodes_of(const PinRegion& region, const Grid& grid) {
  constexpr double kTolerance = 1e-9;
  const auto inside = [](int line, int count, double min, double max) {
    const double x = count > 1 ? static_cast<double>(line) / (count - 1) : 0;
    return x >= min - kTolerance && x <= max + kTolerance;
  };
  std::vector<std::size_t> nodes;
  for (int r = 0; r < grid.rows; ++r) {
    if (!inside(r, grid.rows, region.v_min, region.v_max)) continue;
    for (int c = 0; c < grid.cols; ++c) {
      if (inside(c, grid.cols, region.u_min, region.u_max)) nodes.push_back(grid.index(r, c));
    }
  }
  if (!nodes.empty()) return nodes;
  const auto nearest = [](double low, double high, int count) {
    return std::clamp(static_cast<int>(std::lround(0.5 * (low + high) * (count - 1))), 0, count - 1);
  };
  return {grid.index(nearest(region.v_min, region.v_max, grid.rows),
                     nearest(region.u_min, region.u_max, grid.cols))};
}

std::vector<PinRegion> acting(const std::vector<PinRegion>& regions, double time, bool soft) {
  std::vector<PinRegion> found;
  std::copy_if(regions.begin(), regions.end(), std::back_inserter(found), [&](const PinRegion& region) {
    const double now = time + kPinTimeRounding;
    return region.stiffness.has_value() == soft && region.from <= now && now < region.until;
  });
  return found;
}

double next_change(const std::vector<PinRegion>& regions, double time) {
  double next = std::numeric_limits<double>::infinity();
  for (const PinRegion& region : regions) {
    for (const double change : {region.from, region.until}) {
      if (change > time + kPinTimeRounding) next = std::min(next, change - kPinTimeRounding);
    }
  }
  return next;
}

template <class Real>
Pins<Real>::Pins(const std::vector<PinRegion>& regions, double time, Particles<Real>& particles,
                 const Seam<Real>* seam) {
  const Grid& grid = particles.grid();
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) particles.inverse_mass.at(r, c) = Real(1) / particles.mass.at(r, c);
  }
  for (const PinRegion& region : regions) {
    std::vector<std::size_t> nodes = nodes_of(region, grid);
    if (seam != nullptr) add_sewn(*seam, nodes);
    for (const std::size_t node : nodes) {
      particles.inverse_mass.row(0)[node] = Real(0);
      set(kernels::components(particles.velocity), node, Vec3::Zero());
    }
    if (region.obstacle || region.ball) {
      Fixed fixed;
      fixed.obstacle.id = collider_of(region);
      for (const std::size_t node : nodes) fixed.nodes.push_back({node, Vec3::Zero()});
      fixed_.push_back(std::move(fixed));
    }
    const auto world = [&](std::size_t node) -> Vec3 {
      return particles.place + weft::at<Real>(kernels::components(particles.position), node);
    };
    const auto moves_until = [&](double end) {
      end_of_motion_ = std::max(end_of_motion_, region.loop ? std::numeric_limits<double>::infinity() : end);
    };
    if (!region.path.empty()) {
      Path path{region.path, region.loop, {}};
      const Vec3 offset = along_path(region.path, time, region.loop);
      for (const std::size_t node : nodes) path.nodes.push_back({node, world(node) - offset});
      moves_until(region.path.back().time);
      carried_.push_back(std::move(path));
    }
    if (!region.motion.empty()) {
      Led led{region.motion, region.loop, {}};
      const Pose pose = along_path(region.motion, time, region.loop);
      for (const std::size_t node : nodes)
        led.nodes.push_back({node, pose.orientation.conjugate() * (world(node) - pose.position)});
      moves_until(region.motion.back().time);
      led_.push_back(std::move(led));
    }
  }
}

template Pins<float>::Pins(const std::vector<PinRegion>&, double, Particles<float>&, const Seam<float>*);
template Pins<double>::Pins(const std::vector<PinRegion>&, double, Particles<double>&, const Seam<double>*);

}  // namespace weft
