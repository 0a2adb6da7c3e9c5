#pragma once
#include <variant>

namespace weft {

/// The paper's explicit method, Eq. 6.
struct SymplecticEulerDescription {
  int substeps = 0;     ///< per step; 0 chooses the fewest that keep the stiffest mode stable, and more
                        ///< while springs turn over
  double safety = 0.9;  ///< with substeps = 0: share of the stability limit used, (0, 1]
  bool operator==(const SymplecticEulerDescription&) const = default;
  static constexpr const char* kName = "symplectic_euler";
};
/// The implicit methods: one linear system a Newton iteration, solved by multigrid conjugate gradients.
struct ImplicitParameters {
  int substeps = 1;  ///< per step, >= 1
  /// Root of the energy that a substep's error may have, relative to the motion's, (0, 1]. Of cloth that
  /// something touches a fifth of it: what errors take from its motion nobody gives back.
  double tolerance = 0.1;
  /// Linearisations a substep, >= 1: fewer when one is accurate enough, more where the motion is rough or
  /// would gain energy.
  int newton_iterations = 2;
  /// Largest number of iterations of a linear solve, >= 1. Some presets reach 60; with that as the limit
  /// springs of 1e7 N/m are stretched 1.75 times as far as a hard case allows.
  int linear_iterations = 200;
  /// Share, 0 to 1, of what a step's errors take from the motion or give it that is made good, where nothing
  /// but wind drives the cloth; in wind, of half of it (EnergyLedger).
  double liveliness = 1;
  bool operator==(const ImplicitParameters&) const = default;
};
/// Backward Euler: first order, damps (T3 in the truths), the sturdiest.
struct BackwardEulerDescription : ImplicitParameters {
  bool operator==(const BackwardEulerDescription&) const = default;
  static constexpr const char* kName = "backward_euler";
};
/// Backward differentiation formula of second order: nearly keeps the energy of slow motion.
struct Bdf2Description : ImplicitParameters {
  bool operator==(const Bdf2Description&) const = default;
  static constexpr const char* kName = "bdf2";
};

/// Every spring a constraint, projected once a substep: bounded whatever the stiffness, softer than asked for
/// until the substeps are many (xpbd.h says by how much).
struct XpbdDescription {
  /// Per step. Twice as many leave a quarter of the excess stretch. In violent motion up to 4 times that. 0:
  /// the fewest that are as short as stated.
  int substeps = 0;
  double longest_substep = 1.0 / 2400;  ///< s, with substeps = 0: 40 a step of 1/60 s
  bool operator==(const XpbdDescription&) const = default;
  static constexpr const char* kName = "xpbd";
};
using IntegratorDescription =
    std::variant<SymplecticEulerDescription, BackwardEulerDescription, Bdf2Description, XpbdDescription>;
inline bool is_implicit(const IntegratorDescription& integrator) {
  return std::holds_alternative<BackwardEulerDescription>(integrator) ||
         std::holds_alternative<Bdf2Description>(integrator);
}

}  // namespace weft
