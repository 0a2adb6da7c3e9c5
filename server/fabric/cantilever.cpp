#include "fabric/cantilever.h"

#include <cmath>
#include <numbers>

#include "fabric/specimen.h"

namespace weft::fabric {
namespace {

constexpr double kGravity = 9.80665;  // m/s2
constexpr double kWidth = 0.025;      // m, of the standard's strip
constexpr int kCells = 32, kRows = 5;

/// How far the tip's line falls, rad, of so much overhang. The clamp is two columns of nodes.
double fall(const Material& material, double overhang) {
  const double cell = overhang / kCells;
  SpecimenPlan plan;
  plan.material = material;
  plan.size = {overhang + cell, kWidth};
  plan.rows = kRows;
  plan.cols = kCells + 2;
  plan.gravity = kGravity;
  plan.held = [](int, int c) { return c < 2; };
  Specimen strip(plan);
  // A step is as long as the strip swings; in it backward Euler takes most of the swing.
  strip.rest(std::sqrt(overhang / kGravity), 1e-6 * overhang, 500);
  const Vec3 tip = strip.at(kRows / 2, plan.cols - 1) - strip.at(kRows / 2, 1);
  return std::atan2(-tip.y(), tip.x());
}

}  // namespace

Cantilever cantilever(const Material& material) {
  const double rigidity = material.rigidity.u;
  if (rigidity <= 0) return {};
  constexpr double kFall = 41.5 * std::numbers::pi / 180;
  // Peirce's length is where to look; the strip falls the more the longer it is.
  double low = std::cbrt(rigidity / (material.density * kGravity)), high = 4 * low;
  constexpr double kExact = 1e-4;
  while (high / low > 1 + kExact) {
    const double middle = std::sqrt(low * high);
    (fall(material, middle) < kFall ? low : high) = middle;
  }
  return {std::sqrt(low * high)};
}

double rigidity_of(double bending_length, double density) {
  return density * kGravity * bending_length * bending_length * bending_length;
}

}  // namespace weft::fabric
