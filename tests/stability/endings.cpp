#include "endings.h"

#include <cmath>
#include <cstdio>

#include "cloth/integrators/xpbd.h"

namespace weft::stability {
namespace {

std::string sentence(const char* what, double value, double most) {
  char text[160];
  std::snprintf(text, sizeof text, "%s %.3g of the size; at most %.3g", what, value, most);
  return text;
}

/// Of a sheet of `cells` rows hung by its edge, m.
double xpbd_stretch(const Simulation<float>& simulation, int cells) {
  const auto* xpbd = std::get_if<XpbdDescription>(&simulation.description().integrator);
  if (xpbd == nullptr) return 0;
  const double dt = simulation.description().time_step, h = dt / substeps(*xpbd, dt);
  return simulation.gravity().norm() * h * h * (cells * cells - cells - 1) / 2;
}

}  // namespace

Ending hangs_flat(double share) {
  return [share](const Simulation<float>& simulation, const Setup&) -> Complaint {
    const ClothDescription& cloth = simulation.description().cloths[0];
    const Particles<float>& state = simulation.cloths()[0].particles();
    const int cells = state.grid().rows - 1, across = state.grid().cols - 1;
    const double length = cloth.size.y(), width = cloth.size.x();
    const double stretch = cloth.material.density * simulation.gravity().norm() * length * length /
                               (2 * cloth.material.structural.weft) +
                           xpbd_stretch(simulation, cells);
    double farthest = 0;
    const Vec3 top = state.position_at(0, 0);
    for (int r = 0; r <= cells; ++r) {
      // The load falls from the top down, so that v of the sheet has v (2 - v) of the stretch.
      const double v = double(r) / cells, down = v * length + v * (2 - v) * stretch;
      for (int c = 0; c <= across; ++c) {
        const Vec3 expected = top + Vec3(double(c) / across * width, -down, 0);
        farthest = std::max(farthest, (state.position_at(r, c) - expected).norm());
      }
    }
    farthest /= std::max(length, width);
    // XPBD's own stretch is not known better than to a row.
    const double allowed = share + 2.0 / cells * xpbd_stretch(simulation, cells) / length;
    if (farthest <= allowed) return {};
    return sentence("shape is off the rest shape by", farthest, allowed);
  };
}

Ending ribbon_hangs_down(double share) {
  return [share](const Simulation<float>& simulation, const Setup&) -> Complaint {
    const Particles<float>& state = simulation.cloths()[0].particles();
    const int row = state.grid().rows / 2, last = state.grid().cols - 1;
    const double length = simulation.description().cloths[0].size.x();
    const Vec3 expected = state.position_at(row, 0) - Vec3(0, length + xpbd_stretch(simulation, last), 0);
    const double off = (state.position_at(row, last) - expected).norm() / length;
    if (off <= share) return {};
    return sentence("end is off where it hangs by", off, share);
  };
}

}  // namespace weft::stability
