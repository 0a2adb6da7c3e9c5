#pragma once
#include "fabric/specimen.h"

namespace weft::fabric {

/// KES-FB1's jaws: cloth 5 cm long, along u, and 20 cm wide; the right jaw moves in the cloth's plane.
class Jaws {
 public:
  static constexpr double kLength = 0.05, kWidth = 0.2;  ///< m

  Jaws(const Material& material, bool limited);
  /// The right jaw is `apart` farther from the left one and `aside` along it from where it began, m, and the
  /// cloth at rest. Throws NoRest.
  void set(double apart, double aside);
  /// What draws the right jaw: x along the cloth, z across, N a metre of width.
  Vec3 pull() const;

 private:
  double apart_ = 0, aside_ = 0;
  Specimen cloth_;
};

}  // namespace weft::fabric
