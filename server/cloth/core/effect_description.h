#pragma once
/// The effects a scene may name. Only those listed in a simulation are built and cost anything. Field names
/// equal the names in scene files. What one holds stands in its serialize, too (archive.h).
#include <optional>
#include <variant>

#include "cloth/core/vec3.h"

namespace weft {

/// Eq. 2: F = m g.
struct GravityEffect {
  Vec3 acceleration = standard_gravity();  ///< m/s2
  static constexpr const char* kName = "gravity";
  template <class Archive>
  void serialize(Archive& archive) {
    archive(acceleration);
  }
};

/// Eq. 3: F = -k v, with each cloth's own Material::damping.
struct DampingEffect {
  static constexpr const char* kName = "damping";
};

/// Eq. 4: F = lambda N on every particle. N is the wind's direction; the force grows linearly with the wind's
/// speed and is Eq. 4 exactly at 1 m/s, which is what the paper's presets have.
struct PaperWindEffect {
  double factor = 1.0;  ///< lambda, N at 1 m/s: per particle (paper) or per m2 (continuum); finite, >= 0
  bool along_normal =
      false;  ///< true reads "unit normal vector" as the cloth's: N is the surface normal, turned downwind
  static constexpr const char* kName = "paper_wind";
  template <class Archive>
  void serialize(Archive& archive) {
    archive(factor, along_normal);
  }
};

/// Moving air on a face: F/A = 1/2 rho |w_n| w_n (C_D (n.e) e + C_L (n - (n.e) e)) with w = wind - velocity,
/// e = w / |w|, w_n = w . n; drag along the relative wind and lift across it. Where both coefficients are C,
/// as by default, that is a flat plate's pressure, 1/2 rho C |w_n| w_n n. A sheet falling face on reaches
/// sqrt(2 rho_cloth g / (rho C_D)), T16 in the truths.
struct AerodynamicsEffect {
  double air_density = 1.225;       ///< kg/m3
  double drag = 1.2;                ///< C_D, dimensionless
  std::optional<double> lift = {};  ///< C_L, dimensionless; default: as drag
  double lift_or_drag() const { return lift.value_or(drag); }
  static constexpr const char* kName = "aerodynamics";
  template <class Archive>
  void serialize(Archive& archive) {
    archive(air_density, drag, lift);
  }
};

/// Springs that resist the rate of their length too (Kelvin-Voigt): F = -tau k n (n . (v_i - v_j)) on end i.
/// A mode of angular frequency w decays at tau w^2 / 2; a cloth that moves or turns as a whole keeps its
/// motion.
struct StrainDampingEffect {
  double time = 1e-3;  ///< tau, s; finite, >= 0. Explicit methods need substeps in proportion to it.
  static constexpr const char* kName = "strain_damping";
  template <class Archive>
  void serialize(Archive& archive) {
    archive(time);
  }
};

/// Resistance to curvature, with each cloth's own Material::rigidity (sheet/plate.h).
struct PlateBendingEffect {
  static constexpr const char* kName = "plate_bending";
};

/// Threads that are pulled straight: structural and shear springs stiffen beyond each cloth's own
/// Material::limit, the tension going on without a jump (the bilinear springs of biphasic cloth models;
/// Provot, Deformation constraints in a mass-spring model, 1995, holds the limit outright).
struct StrainLimitEffect {
  static constexpr const char* kName = "strain_limit";
};

/// Cloth does not pass through itself nor through another cloth of the scene (world/cloth_contact.h).
struct ClothContactEffect {
  double thickness = 0.005;  ///< kept between layers, m; finite, > 0. Held to half a cell of a level.
  double friction = 0.3;     ///< Coulomb's coefficient between cloth and cloth, >= 0
  bool operator==(const ClothContactEffect&) const = default;
  static constexpr const char* kName = "cloth_contact";
  template <class Archive>
  void serialize(Archive& archive) {
    archive(thickness, friction);
  }
};

/// Air under a sheet that is held all round its rim, as under an air-supported roof or in a bouncy castle: a
/// pressure above that outside, kept up whatever the volume, pushes every face along its normal, F = p A. A
/// sheet whose rim is free is pushed from its back. With a volume, gas that is shut in the scene's sewn
/// cloths and no other, each its own (air/gas.h).
struct InflationEffect {
  double pressure = 100;  ///< Pa; finite. Below 0 it sucks; that of gas is above -p_a.
  /// What the gas has this pressure in, m3; > 0. Default: there is a pump, which keeps the pressure up.
  std::optional<double> volume = {};
  /// From when the effect is there, during which gas is poured in, s; >= 0. 0: it is there at once, and the
  /// bag is blown up without motion (Unsettled::by_gas).
  double fill_time = 1;
  bool operator==(const InflationEffect&) const = default;
  static constexpr const char* kName = "inflation";
  template <class Archive>
  void serialize(Archive& archive) {
    archive(pressure, volume, fill_time);
  }
};

/// Cloth tears where it is pulled too hard: a structural link breaks at the end of a step in which the sheet
/// carries more tension across its middle, per metre of cloth, than this (sheet/tear/tearing.h).
struct TearingEffect {
  double warp = 1000;  ///< strength along u, N/m; finite, > 0
  double weft = 1000;  ///< along v, N/m
  static constexpr const char* kName = "tearing";
  template <class Archive>
  void serialize(Archive& archive) {
    archive(warp, weft);
  }
};

using EffectDescription =
    std::variant<GravityEffect, DampingEffect, PaperWindEffect, AerodynamicsEffect, StrainDampingEffect,
                 PlateBendingEffect, StrainLimitEffect, ClothContactEffect, InflationEffect, TearingEffect>;

/// The scene's wind acts by this effect.
inline bool feels_wind(const EffectDescription& effect) {
  return std::holds_alternative<PaperWindEffect>(effect) ||
         std::holds_alternative<AerodynamicsEffect>(effect);
}

}  // namespace weft
