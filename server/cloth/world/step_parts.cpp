#include "cloth/world/step_parts.h"

#include <algorithm>
#include <cmath>

namespace weft {
namespace {

/// Longest parts where cloth touches cloth, s: of an implicit step that finds all of it together, of others,
/// and of explicit ones among several cloths; what is longer by a tenth of a part is rounding.
constexpr double kLongest = 1.0 / 30, kLongestApart = 1.0 / 60, kLongestInTurn = 1.0 / 240, kRounding = 0.1;
/// Farthest that cloths go past each other in a part, in cells, and most parts made for that.
constexpr double kMostCells = 4, kMostForCells = 4;
/// Farthest that pins go in a part, as a part of the cloth's larger side, and most parts made for that.
constexpr double kFarthest = 0.5, kMostForPins = 8;

template <class Real>
double parts_for_contact(const Cloth<Real>& cloth, bool alone, double dt) {
  const bool implicit = cloth.steps_implicitly();
  if (alone) return dt / (implicit ? kLongest : kLongestApart);
  return dt / (implicit ? kLongestApart : kLongestInTurn);
}

template <class Real>
double parts_for_pins(const Cloth<Real>& cloth, double time, double dt) {
  if (!cloth.has_moving_pins() || !cloth.steps_implicitly()) return 1;
  const double way = cloth.way_of_pins(time, time + dt);
  return std::min(way / (kFarthest * cloth.description().size.maxCoeff()), kMostForPins);
}

}  // namespace

template <class Real>
int step_parts(const std::vector<Cloth<Real>>& cloths, const Layers<Real>* layers, bool solid, double time,
               double dt) {
  double parts = 1;
  if (layers != nullptr) parts = std::clamp(layers->cells_passed() * dt / kMostCells, 1.0, kMostForCells);
  for (const Cloth<Real>& cloth : cloths) {
    if (layers != nullptr) parts = std::max(parts, parts_for_contact(cloth, cloths.size() == 1, dt));
    if (solid) parts = std::max(parts, parts_for_pins(cloth, time, dt));
  }
  return static_cast<int>(std::ceil(parts - kRounding));
}

template int step_parts(const std::vector<Cloth<float>>&, const Layers<float>*, bool, double, double);
template int step_parts(const std::vector<Cloth<double>>&, const Layers<double>*, bool, double, double);

}  // namespace weft
