#include "cloth/sheet/freedom.h"

#include <cmath>

#include "cloth/core/small_system.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/motion.h"

namespace weft {
namespace {

/// Of its own speed a free rigid motion goes against what pushes, in the mean: a plane's rounding, and of a
/// surface so flat that along it next to nothing is pushed.
constexpr double kFree = 0.01;

}  // namespace

Freedom Freedom::all() {
  Freedom freedom;
  freedom.screws_ = Eigen::Matrix<double, 6, 6>::Identity();
  return freedom;
}

Freedom Freedom::beside(const std::vector<Push>& pushes, const Vec3& centre, double radius) {
  if (pushes.empty() || !(radius > 0)) return all();
  // Spins are told by the speed at the radius.
  Eigen::Matrix<double, 6, 6> resisted = Eigen::Matrix<double, 6, 6>::Zero();
  for (const Push& push : pushes) {
    Screw along;
    along << push.normal, (push.point - centre).cross(push.normal) / radius;
    resisted += along * along.transpose();
  }
  resisted /= static_cast<double>(pushes.size());
  const SmallSpectrum resistance = spectrum_of(resisted);
  int count = 0;  // they ascend
  while (count < 6 && resistance.values[count] < kFree * kFree) ++count;
  Freedom freedom;
  freedom.screws_ = resistance.vectors.leftCols(count);
  freedom.screws_.bottomRows<3>() /= radius;
  return freedom;
}

auto Freedom::motion(const Screw& momentum, double mass, const Eigen::Matrix3d& inertia) const -> Screw {
  Eigen::Matrix<double, 6, 6> inertias = Eigen::Matrix<double, 6, 6>::Zero();
  inertias.diagonal().head<3>().setConstant(mass);
  inertias.bottomRightCorner<3, 3>() = inertia;
  if (is_none()) return Screw::Zero();
  // Nodes in one line do not turn about it.
  return screws_ * least_solution(screws_.transpose() * inertias * screws_, screws_.transpose() * momentum);
}

template <class Real>
Freedom freedom_of(const Particles<Real>& particles) {
  return is_held(particles) ? Freedom::none() : Freedom::all();
}

template <class Real>
Freedom freedom_beside(const std::vector<Push>& pushes, const Particles<Real>& particles) {
  if (pushes.empty()) return Freedom::all();
  const Vec3 centre = centre_of_mass(particles);
  const double gyration = std::sqrt(inertia_about(centre, particles).trace() / 2 / total_mass(particles));
  return Freedom::beside(pushes, centre, gyration);
}

template Freedom freedom_beside(const std::vector<Push>&, const Particles<float>&);
template Freedom freedom_beside(const std::vector<Push>&, const Particles<double>&);
template Freedom freedom_of(const Particles<float>&);
template Freedom freedom_of(const Particles<double>&);

}  // namespace weft
