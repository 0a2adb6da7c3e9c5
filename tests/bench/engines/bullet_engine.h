#pragma once
#include <memory>

#include "engines/engine.h"
#include "engines/engine_scene.h"

namespace weft::bench {

/// Bullet's soft body (btSoftBody, position solver), asked for cloth that does not stretch: links along warp
/// and weft and one diagonal a cell, all of its greatest stiffness. Their order is shuffled, without which it
/// is worse. Damping is its kDP; in the wind its own two-sided drag on faces; the ball a static body.
class BulletEngine final : public Engine {
 public:
  BulletEngine(const EngineScene& scene, int iterations, int substeps);
  ~BulletEngine() override;
  void step() override;
  void read(SheetState& sheet) const override;

 private:
  struct World;
  std::unique_ptr<World> world_;
  int side_, substeps_;
};

}  // namespace weft::bench
