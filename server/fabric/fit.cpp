#include "fabric/fit.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "fabric/cantilever.h"
#include "fabric/drape.h"
#include "fabric/tensile.h"
#include "scene/object.h"

namespace weft::fabric {
namespace {

/// The drape's coefficient rises with what resists bending, from `least` to `most` N m.
class DrapeSearch {
 public:
  DrapeSearch(const Numbers& numbers, Material& material, int cells)
      : wanted_(*numbers.drape),
        twist_alone_(numbers.bending_length_warp.has_value() || numbers.bending_length_weft.has_value()),
        cells_(cells),
        material_(material) {}

  /// Leaves the material as found; returns its drape.
  double run() {
    double low = twist_alone_ ? 1e-8 : 1e-7, high = twist_alone_ ? 1e-3 : 1e-2;
    double at_low = drape_of(low), at_high = drape_of(high);
    if (wanted_ < at_low || wanted_ > at_high) {
      char text[160];
      std::snprintf(text, sizeof text, "drape is %g; %s can be from %.3f to %.3f", wanted_,
                    twist_alone_ ? "with these bending lengths and this density it" : "with this density it",
                    at_low, at_high);
      throw NoFit(text);
    }
    constexpr double kAsRead = 0.005;  // two tests of one cloth differ by more
    constexpr int kMost = 20;
    double found = at_low;
    for (int n = 0; n < kMost; ++n) {
      const double middle = std::sqrt(low * high);
      found = drape_of(middle);
      if (std::abs(found - wanted_) < kAsRead) break;
      (found < wanted_ ? low : high) = middle;
    }
    return found;
  }

 private:
  double drape_of(double rigidity) {
    if (!twist_alone_) material_.rigidity.u = material_.rigidity.v = rigidity;
    material_.rigidity.twist = rigidity;
    return drape(material_, cells_).coefficient;
  }

  double wanted_;
  bool twist_alone_;
  int cells_;
  Material& material_;
};

double stiffness_along(const char* name, double extension, double shear) {
  const double stiffness = stiffness_of(extension, shear);
  if (stiffness > 0) return stiffness;
  char text[160];
  std::snprintf(text, sizeof text, "%s is %g; with a shear_stiffness of %g N/m it must be less than %g", name,
                extension, shear, kLargestLoad / shear);
  throw NoFit(text);
}

}  // namespace

std::variant<Numbers, std::vector<scene::Problem>> read_numbers(const nlohmann::json& value) {
  constexpr scene::Range kDensity{1e-4, 1e4, "kg/m2"}, kExtension{1e-4, 2}, kBendingLength{1e-3, 0.2, "m"},
      kShear{0.1, 1e6, "N/m per radian"}, kDrape{0.01, 0.99};
  scene::Report report({}, {});
  Numbers numbers;
  {
    scene::Object object(value, "", report);
    const auto read = [&](const char* name, std::optional<double>& target, const scene::Range& range) {
      if (double number = 0; object.number(name, number, range)) target = number;
    };
    object.require("density", kDensity);
    object.number("density", numbers.density, kDensity);
    read("emt_warp", numbers.emt_warp, kExtension);
    read("emt_weft", numbers.emt_weft, kExtension);
    read("bending_length_warp", numbers.bending_length_warp, kBendingLength);
    read("bending_length_weft", numbers.bending_length_weft, kBendingLength);
    read("shear_stiffness", numbers.shear_stiffness, kShear);
    read("drape", numbers.drape, kDrape);
  }
  if (report.count() > 0) return report.take();
  return numbers;
}

Fit fit(const Numbers& numbers, int drape_cells) {
  Fit result;
  Material& material = result.material;
  material.density = numbers.density;
  if (numbers.shear_stiffness) material.shear = *numbers.shear_stiffness;
  const auto of_both = [](const std::optional<double>& one, const std::optional<double>& other) {
    return one ? one : other;
  };
  const auto emt_warp = of_both(numbers.emt_warp, numbers.emt_weft);
  const auto emt_weft = of_both(numbers.emt_weft, numbers.emt_warp);
  if (emt_warp && emt_weft) {
    material.structural = {stiffness_along("emt_warp", *emt_warp, material.shear),
                           stiffness_along("emt_weft", *emt_weft, material.shear)};
    material.bending = (material.structural.warp + material.structural.weft) / 2000;  // as the named fabrics'
  }
  const auto warp = of_both(numbers.bending_length_warp, numbers.bending_length_weft);
  const auto weft = of_both(numbers.bending_length_weft, numbers.bending_length_warp);
  if (warp && weft) {
    Rigidity& rigidity = material.rigidity;
    rigidity.u = rigidity_of(*warp, numbers.density);
    rigidity.v = rigidity_of(*weft, numbers.density);
    rigidity.twist = std::sqrt(rigidity.u * rigidity.v);  // Peirce's overall rigidity
  }
  if (numbers.drape) result.drape = DrapeSearch(numbers, material, drape_cells).run();
  return result;
}

nlohmann::json block_of(const Numbers& numbers, const Material& material) {
  nlohmann::json block{{"density", material.density}};
  if (numbers.emt_warp || numbers.emt_weft) {
    block["structural"] = {material.structural.warp, material.structural.weft};
    block["bending"] = material.bending;
  }
  if (numbers.shear_stiffness) block["shear"] = material.shear;
  if (numbers.bending_length_warp || numbers.bending_length_weft || numbers.drape)
    block["rigidity"] = {material.rigidity.u, material.rigidity.v, material.rigidity.twist};
  return block;
}

}  // namespace weft::fabric
