#include "fabric/fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "fabric/cantilever.h"
#include "fabric/drape.h"
#include "fabric/tensile.h"
#include "scene/object.h"

namespace weft::fabric {
namespace {

double stiffness_along(const char* name, double extension, double shear) {
  const double stiffness = stiffness_of(extension, shear);
  if (stiffness > 0) return stiffness;
  char text[160];
  std::snprintf(text, sizeof text, "%s is %g; with a shear_stiffness of %g N/m it must be less than %g", name,
                extension, shear, kLargestLoad / shear);
  throw NoFit(text);
}

/// All that follows from a formula; what was not measured is the default's.
Material by_formula(const Numbers& numbers) {
  Material material;
  material.density = numbers.density;
  if (numbers.shear_stiffness) material.shear = *numbers.shear_stiffness;
  const auto either = [](const std::optional<double>& one, const std::optional<double>& other) {
    return one ? one : other;
  };
  const auto emt_warp = either(numbers.emt_warp, numbers.emt_weft);
  const auto emt_weft = either(numbers.emt_weft, numbers.emt_warp);
  if (emt_warp && emt_weft) {
    material.structural = {stiffness_along("emt_warp", *emt_warp, material.shear),
                           stiffness_along("emt_weft", *emt_weft, material.shear)};
    material.bending = (material.structural.warp + material.structural.weft) / 2000;  // as the named fabrics'
  }
  const auto warp = either(numbers.bending_length_warp, numbers.bending_length_weft);
  const auto weft = either(numbers.bending_length_weft, numbers.bending_length_warp);
  if (warp && weft) {
    Rigidity& rigidity = material.rigidity;
    rigidity.u = rigidity_of(*warp, numbers.density);
    rigidity.v = rigidity_of(*weft, numbers.density);
    rigidity.twist = std::sqrt(rigidity.u * rigidity.v);  // Peirce's overall rigidity
  }
  return material;
}

/// What a drape is found by: the material with so much of what was not measured.
struct Unknown {
  const char* name;
  double least, most;
  std::function<Material(double)> material;
};

Unknown unknown_of(const Numbers& numbers) {
  if (!numbers.bending_length_warp && !numbers.bending_length_weft) {
    return {"rigidity", 1e-7, 1e-2, [=](double rigidity) {
              Material material = by_formula(numbers);
              material.rigidity = {rigidity, rigidity, rigidity};
              return material;
            }};
  }
  const double largest_emt = std::max(numbers.emt_warp.value_or(0), numbers.emt_weft.value_or(0));
  const double most = largest_emt > 0 ? std::min(1e4, 0.9 * kLargestLoad / largest_emt) : 1e4;
  return {"shear", 1, most, [=](double shear) {
            Numbers all = numbers;
            all.shear_stiffness = shear;
            return by_formula(all);
          }};
}

/// The coefficient rises with the unknown: bisection of its logarithm.
Fit by_drape(const Numbers& numbers, int cells) {
  const double wanted = *numbers.drape;
  const Unknown unknown = unknown_of(numbers);
  const auto tried = [&](double value) {
    const Material material = unknown.material(value);
    return Fit{material, drape(material, cells).coefficient};
  };
  double low = unknown.least, high = unknown.most;
  const Fit limp = tried(low), stiff = tried(high);
  if (wanted < *limp.drape || wanted > *stiff.drape) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "drape is %g; with the other numbers it is %.3f at a %s of %g and %.3f at %g", wanted,
                  *limp.drape, unknown.name, low, *stiff.drape, high);
    throw NoFit(text);
  }
  constexpr double kAsRead = 0.005;  // two tests of one cloth differ by more
  constexpr int kMost = 20;
  Fit found = limp;
  for (int n = 0; n < kMost && std::abs(*found.drape - wanted) >= kAsRead; ++n) {
    const double middle = std::sqrt(low * high);
    found = tried(middle);
    (*found.drape < wanted ? low : high) = middle;
  }
  return found;
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
  const bool bent = numbers.bending_length_warp || numbers.bending_length_weft;
  if (numbers.drape && !(bent && numbers.shear_stiffness)) return by_drape(numbers, drape_cells);
  Fit result{by_formula(numbers), {}};
  if (numbers.drape) result.drape = drape(result.material, drape_cells).coefficient;
  return result;
}

nlohmann::json block_of(const Numbers& numbers, const Material& material) {
  nlohmann::json block{{"density", material.density}};
  if (numbers.emt_warp || numbers.emt_weft) {
    block["structural"] = {material.structural.warp, material.structural.weft};
    block["bending"] = material.bending;
  }
  if (numbers.shear_stiffness || material.shear != Material{}.shear) block["shear"] = material.shear;
  if (material.rigidity != Material{}.rigidity)
    block["rigidity"] = {material.rigidity.u, material.rigidity.v, material.rigidity.twist};
  return block;
}

}  // namespace weft::fabric
