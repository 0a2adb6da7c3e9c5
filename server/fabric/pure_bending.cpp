#include "fabric/pure_bending.h"

#include <cmath>

#include "fabric/specimen.h"

namespace weft::fabric {
namespace {

constexpr double kBentLength = 0.01;  // m, between the clamps
constexpr double kBentWidth = 0.01;   // m: a piece of the instrument's 20 cm, all alike
constexpr int kBentCells = 32, kBentRows = 5;

/// J a square metre of cloth that is bent to `curvature`, 1/m.
double energy_at(const Material& material, double curvature) {
  const double cell = kBentLength / kBentCells;
  SpecimenPlan plan;
  plan.material = material;
  plan.size = {kBentLength + 2 * cell, kBentWidth};
  plan.rows = kBentRows;
  plan.cols = kBentCells + 3;
  plan.held = [&](int, int c) { return c < 2 || c > kBentCells; };
  Specimen piece(plan);
  const auto on_arc = [&](double s) {
    return Vec3(std::sin(curvature * s) / curvature, (1 - std::cos(curvature * s)) / curvature, 0);
  };
  const double turn = curvature * kBentLength;
  const Vec3 along(std::cos(turn), std::sin(turn), 0);
  for (int r = 0; r < kBentRows; ++r) {
    for (int c = 0; c < plan.cols; ++c) {
      const double s = (c - 1) * cell;
      Vec3 place = on_arc(s);
      if (c == 0) place = Vec3(-cell, 0, 0);  // the clamps are straight
      if (c == plan.cols - 1) place = on_arc(kBentLength) + cell * along;
      place.z() = r * kBentWidth / (kBentRows - 1);
      piece.put(r, c, place);
    }
  }
  piece.rest(0.02, 1e-9, 500);
  return piece.bending_energy() / (kBentLength * kBentWidth);
}

}  // namespace

double pure_bending(const Material& material) {
  constexpr double kFrom = 50, kTo = 150, kAside = 5;  // 1/m
  // The moment is what a change of curvature costs.
  const auto moment = [&](double curvature) {
    return (energy_at(material, curvature + kAside) - energy_at(material, curvature - kAside)) / (2 * kAside);
  };
  return (moment(kTo) - moment(kFrom)) / (kTo - kFrom);
}

}  // namespace weft::fabric
