#pragma once
/// The numbers of a material that scene files give and that may be changed while a scene runs, with their
/// ranges. Not its density: a cloth keeps its mass.
#include "cloth/world/description.h"
#include "scene/parameter.h"

namespace weft::scene {

inline constexpr Range kStiffness{0, 1e9, "N/m"};
inline constexpr Range kDamping{0, 1e6};
inline constexpr Range kRigidity{0, 1e4, "N m"};
inline constexpr Range kElongation{1e-3, 10};
inline constexpr Range kLockingAngle{1e-3, 1.5, "rad"};
inline constexpr Range kStiffening{1, 1000};

struct MaterialParameter : Parameter<Material> {
  const char* effect = nullptr;  ///< it is felt through this one alone; nullptr: always
};

/// Those that are felt in a scene of these effects, in the order in which they are listed.
std::vector<MaterialParameter> material_parameters(const std::vector<EffectDescription>& effects);

}  // namespace weft::scene
