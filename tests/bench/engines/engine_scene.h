#pragma once
/// The three scenes in which the engines are compared. All: 2 m x 2 m, 0.1 kg/m2, 60 frames a second, 5 s.
#include "cloth/world/description.h"

namespace weft::bench {

inline constexpr double kSheetSide = 2.0;       ///< m
inline constexpr double kDensity = 0.1;         ///< kg/m2
inline constexpr double kFrameTime = 1.0 / 60;  ///< s
inline constexpr double kWindSpeed = 5.0;       ///< m/s
inline constexpr double kBallRadius = 0.3;      ///< m, its centre in the origin
inline constexpr double kBallFriction = 0.3;

struct EngineScene {
  /// H: starts horizontal, hung by two corners. B: falls 0.2 m on a fixed ball, no pins. W: hangs from its
  /// top edge, wind against its face.
  char name = 'H';
  int level = 6;
  double damping = 0;  ///< rate at which air slows every node, 1/s

  int side() const { return (1 << level) + 1; }  ///< nodes
  bool operator==(const EngineScene&) const = default;
};

/// The scene for Weft, a continuous sheet of this structural stiffness, N/m. Shear is 500 N/m, bending 0: the
/// other engines have structural and diagonal springs only. Start positions deviate by up to 10 um from the
/// plane, the same in every engine.
SimulationDescription describe(const EngineScene& scene, double structural,
                               const IntegratorDescription& integrator);

}  // namespace weft::bench
