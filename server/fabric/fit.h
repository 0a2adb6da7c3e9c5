#pragma once
/// A material from what instruments have measured of a cloth.
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stdexcept>
#include <variant>
#include <vector>

#include "cloth/sheet/material.h"
#include "scene/scene.h"

namespace weft::fabric {

/// Of the weft, where it is not given, the warp's are taken.
struct Numbers {
  double density = 0;                        ///< kg/m2
  std::optional<double> emt_warp, emt_weft;  ///< KES-FB1's elongation at 490 N/m, a share
  std::optional<double> bending_length_warp, bending_length_weft;  ///< ASTM D1388's c, m
  std::optional<double> shear_stiffness;                           ///< KES-FB1's G, N/m per radian
  std::optional<double> drape;                                     ///< Cusick's coefficient, a share
};

/// From {"density": ..., "emt_warp": ...}, with the members' names; or what is wrong with it.
std::variant<Numbers, std::vector<scene::Problem>> read_numbers(const nlohmann::json& value);

/// No material shows these numbers.
class NoFit : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Fit {
  Material material;            ///< what was not measured is the default's
  std::optional<double> drape;  ///< of this material, if one was asked for
};

/// Rigidity G = density g c^3, stiffness 490 N/m / EMT - G of shear, shear as measured. A drape tells what
/// was not measured, by simulation: without bending lengths the rigidity, alike in all directions, else the
/// shear stiffness. Where both were measured it tells nothing more and is simulated to be compared.
/// `drape_cells` as in drape(). Throws NoFit and NoRest.
Fit fit(const Numbers& numbers, int drape_cells);

/// The material's block of a scene file: what is not the default's.
nlohmann::json block_of(const Numbers& numbers, const Material& material);

}  // namespace weft::fabric
