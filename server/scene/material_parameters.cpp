#include "scene/material_parameters.h"

#include <algorithm>
#include <cstring>
#include <iterator>

#include "cloth/forces/effect.h"

namespace weft::scene {
namespace {

using Values = std::vector<double>;

template <double Material::*kMember>
MaterialParameter of_material(const char* name, const Range& range, const char* effect = nullptr) {
  return {{{name, 1, range},
           [](const Material& material) { return Values{material.*kMember}; },
           [](Material& material, const Values& values) { material.*kMember = values[0]; }},
          effect};
}

template <double StrainLimit::*kMember>
MaterialParameter of_limit(const char* name, const Range& range) {
  return {{{name, 1, range},
           [](const Material& material) { return Values{material.limit.*kMember}; },
           [](Material& material, const Values& values) { material.limit.*kMember = values[0]; }},
          StrainLimitEffect::kName};
}

/// The warp's; the weft's keeps its share of it.
MaterialParameter structural() {
  return {{{"structural", 1, kStiffness},
           [](const Material& material) { return Values{material.structural.warp}; },
           [](Material& material, const Values& values) {
             auto& [warp, weft] = material.structural;
             if (warp == weft) {
               weft = values[0];
             } else if (warp > 0) {
               weft = std::min(weft * (values[0] / warp), kStiffness.max);
             }
             warp = values[0];
           }}};
}

MaterialParameter structural_weft() {
  return {{{"structural_weft", 1, kStiffness},
           [](const Material& material) { return Values{material.structural.weft}; },
           [](Material& material, const Values& values) { material.structural.weft = values[0]; }}};
}

MaterialParameter rigidity() {
  return {{{"rigidity", 3, kRigidity, true},
           [](const Material& material) {
             const Rigidity& rigidity = material.rigidity;
             return Values{rigidity.u, rigidity.v, rigidity.twist};
           },
           [](Material& material, const Values& values) {
             material.rigidity = {values[0], values[1], values[2]};
           }},
          PlateBendingEffect::kName};
}

}  // namespace

std::vector<MaterialParameter> material_parameters(const std::vector<EffectDescription>& effects) {
  static const std::vector<MaterialParameter> all{
      structural(),
      structural_weft(),
      of_material<&Material::shear>("shear", kStiffness),
      of_material<&Material::bending>("bending", kStiffness),
      of_material<&Material::damping>("damping", kDamping, DampingEffect::kName),
      rigidity(),
      of_limit<&StrainLimit::warp>("limit_warp", kElongation),
      of_limit<&StrainLimit::weft>("limit_weft", kElongation),
      of_limit<&StrainLimit::shear>("limit_shear", kLockingAngle),
      of_limit<&StrainLimit::stiffening>("stiffening", kStiffening)};
  const auto is_felt = [&](const MaterialParameter& parameter) {
    return parameter.effect == nullptr ||
           std::any_of(effects.begin(), effects.end(), [&](const EffectDescription& effect) {
             return std::strcmp(name_of(effect), parameter.effect) == 0;
           });
  };
  std::vector<MaterialParameter> felt;
  std::copy_if(all.begin(), all.end(), std::back_inserter(felt), is_felt);
  return felt;
}

}  // namespace weft::scene
