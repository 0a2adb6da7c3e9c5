#pragma once
#include "cloth/world/simulation.h"
#include "engines/engine.h"

namespace weft::bench {

/// Weft itself.
template <class Real>
class WeftEngine final : public Engine {
 public:
  explicit WeftEngine(const SimulationDescription& description) : simulation_(description) {}
  const Simulation<Real>& simulation() const { return simulation_; }
  void step() override { simulation_.step(); }
  void read(SheetState& sheet) const override {
    const Particles<Real>& particles = simulation_.cloths()[0].particles();
    sheet.side = particles.grid().rows;
    sheet.position.clear();
    sheet.velocity.clear();
    for (int r = 0; r < particles.grid().rows; ++r) {
      for (int c = 0; c < particles.grid().cols; ++c) {
        sheet.position.push_back(particles.position_at(r, c));
        sheet.velocity.push_back(particles.velocity_at(r, c));
      }
    }
  }

 private:
  Simulation<Real> simulation_;
};

}  // namespace weft::bench
