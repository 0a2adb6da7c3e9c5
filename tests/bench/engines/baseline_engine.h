#pragma once
#include "baseline.h"
#include "engines/engine.h"
#include "engines/engine_scene.h"

namespace weft::bench {

/// The paper's method, with as many substeps as keep it stable. On square cells its springs have the sheet's
/// own constants; what differs: border springs are as stiff and border nodes as heavy as inner ones, the ball
/// has no friction, and for the wind it has Eq. 4's constant force, here 10 m/s2 (the air's pressure would
/// need the cloth's motion, which Eq. 4 does not know).
class BaselineEngine final : public Engine {
 public:
  BaselineEngine(const EngineScene& scene, double structural);
  void step() override { baseline_.step(); }
  void read(SheetState& sheet) const override;
  static int substeps(const EngineScene& scene, double structural);

 private:
  int side_;
  Baseline<float> baseline_;
};

}  // namespace weft::bench
