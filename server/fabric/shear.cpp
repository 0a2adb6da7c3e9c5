#include "fabric/shear.h"

#include <cmath>
#include <numbers>

#include "fabric/jaws.h"

namespace weft::fabric {
namespace {

constexpr double kTension = 10 * 0.00980665 / 0.01;  // N/m

/// Force along the jaw at so many degrees, N/m, less the tension's part.
double force_at(Jaws& jaws, double degrees, double& apart) {
  const double incline = std::tan(degrees / 180 * std::numbers::pi);
  // The jaws' distance is what leaves the tension: a secant from a distance nearby.
  double before = apart, tension_before = 0;
  const auto aside = [&](double by) { return (Jaws::kLength + by) * incline; };
  jaws.set(before, aside(before));
  tension_before = jaws.pull().x();
  double now = before + 1e-5;
  constexpr int kMostSecants = 20;
  for (int n = 0; n < kMostSecants; ++n) {
    jaws.set(now, aside(now));
    const double tension = jaws.pull().x(), slope = (tension - tension_before) / (now - before);
    if (std::abs(tension - kTension) < 1e-6 * kTension) break;
    if (slope <= 0) throw NoRest("the cloth does not resist the tension of a shear test");
    before = now;
    tension_before = tension;
    now += (kTension - tension) / slope;
  }
  apart = now;
  const Vec3 pull = jaws.pull();
  return pull.z() - pull.x() * incline;
}

}  // namespace

Shear shear(const Material& material, bool limited) {
  constexpr double kFrom = 0.5, kTo = 2.5, kLast = 8;  // degrees
  Jaws jaws(material, limited);
  double apart = 0;
  const double first = force_at(jaws, kFrom, apart), second = force_at(jaws, kTo, apart);
  Shear result;
  result.stiffness = (second - first) / ((kTo - kFrom) / 180 * std::numbers::pi);
  result.at_8_degrees = force_at(jaws, kLast, apart);
  return result;
}

}  // namespace weft::fabric
