#pragma once
#include <span>
#include <string_view>

namespace weft {

/// How constants become masses and springs of a level (design decision D4; physics.md A).
enum class Discretization {
  paper,  ///< every node weighs m_total / n (Eq. 9), every spring has the material's constant at each level
  continuum,  ///< border nodes weigh 1/2 (corners 1/4), border springs are half as stiff, spring constants
              ///< follow from the sheet's stiffness and the cell's shape: all levels approach one sheet
};

/// Resistance to stretch along the threads, N/m, each finite and >= 0; a single number is both.
struct Stiffness {
  double warp, weft;  ///< along u, along v
  // NOLINTNEXTLINE(google-explicit-constructor): a number is a stiffness
  constexpr Stiffness(double both) : warp(both), weft(both) {}
  constexpr Stiffness(double along_u, double along_v) : warp(along_u), weft(along_v) {}
  constexpr double least() const { return warp < weft ? warp : weft; }
  constexpr double most() const { return warp < weft ? weft : warp; }
  bool operator==(const Stiffness&) const = default;
};

/// Bending rigidities, N m, each finite and >= 0: a sheet bent to the curvatures k_uu and k_vv along its u
/// and v and to the twist k_uv holds u k_uu^2 / 2 + v k_vv^2 / 2 + twist k_uv^2 joules a square metre. Bent
/// along the bias it has (u + v + 2 twist) / 4; all three alike bend alike in every direction.
struct Rigidity {
  double u = 1e-5, v = 1e-5, twist = 1e-5;
  bool operator==(const Rigidity&) const = default;
};

/// How far the sheet stretches as its stiffness says before the threads themselves are pulled, and how much
/// stiffer it is from there on; read by the effect strain_limit. Compressed it is as without.
struct StrainLimit {
  double warp = 0.05;  ///< along u, relative elongation; finite, > 0
  double weft = 0.08;  ///< along v, the same
  /// By how much the angle between warp and weft has changed when they lock, rad; (0, pi/2). The springs feel
  /// it in the diagonals, at the length that unstretched threads give them then.
  double shear = 0.3;
  double stiffening = 20;  ///< stiffness beyond the limits, relative; finite, >= 1
  bool operator==(const StrainLimit&) const = default;
};

/// What a cloth is made of. With Discretization::paper the three stiffnesses are Eq. 1's spring constants
/// K(i,j) in N/m, the same at every level. With continuum they are the sheet's own, in N/m (force per width
/// per strain), and the constants of a level follow from them (springs.h).
struct Material {
  double density = 0.1;         ///< areal density, kg/m2; finite and > 0
  Stiffness structural = 5000;  ///< along warp and weft. Higher stretches less and needs more substeps.
  double shear = 500;           ///< N/m, along the diagonals; >= 0
  double bending = 5;           ///< N/m, springs to the second neighbour; >= 0
  double damping = 0.1;    ///< Eq. 3's k; N s/m per particle (paper) or N s/m3, per area (continuum); >= 0
  Rigidity rigidity = {};  ///< of the effect plate_bending, the same at every level and discretization
  StrainLimit limit = {};  ///< of the effect strain_limit
  bool operator==(const Material&) const = default;
};

/// A named fabric and where its numbers come from.
struct Fabric {
  std::string_view name;
  Material material;
  std::string_view source;
};

/// The named fabrics; see material.cpp for the sources.
std::span<const Fabric> fabrics();
/// The fabric of that name, or nullptr.
const Fabric* find_fabric(std::string_view name);

}  // namespace weft
