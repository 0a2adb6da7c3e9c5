#include "cloth/levels/unfold.h"

#include <limits>
#include <optional>

#include "cloth/core/random.h"
#include "cloth/levels/refine.h"
#include "cloth/levels/settle.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/motion.h"

namespace weft {
namespace {

constexpr double kTangled = 0.4;
/// The coarsest level that can fold both ways.
constexpr int kCoarsest = 1;
/// How often its sheet is let settle, from a tangle; finer ones, which begin smooth, once.
constexpr int kTimes = 30;
/// Nodes on one line or point know no way out of it: those of the coarsest sheet are moved by up to this, of
/// the cloth's longer side.
constexpr double kWayOut = 1e-3;

/// Calls visit(r, c) for every node.
template <class Visit>
void at_each_node(const Grid& grid, Visit visit) {
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) visit(r, c);
  }
}

/// The nodes that the level below has too, held where they are held here.
template <class Real>
Particles<Real> coarser(const Particles<Real>& fine, const ClothDescription& cloth, int level) {
  Particles<Real> coarse(cloth.base_cells.at(level - 1));
  merge(fine, coarse);
  const double mass = cloth.material.density * cloth.size.x() * cloth.size.y();
  mass_distribution(mass, cloth.discretization, coarse.mass);
  at_each_node(coarse.grid(), [&](int r, int c) {
    const bool held = fine.inverse_mass.at(2 * r, 2 * c) == Real(0);
    coarse.inverse_mass.at(r, c) = held ? Real(0) : 1 / coarse.mass.at(r, c);
  });
  return coarse;
}

/// Puts the held nodes where they are in `from`.
template <class Real>
void take_held(const Particles<Real>& from, Particles<Real>& to) {
  at_each_node(to.grid(), [&](int r, int c) {
    if (to.inverse_mass.at(r, c) != Real(0)) return;
    to.position.x.at(r, c) = from.position.x.at(r, c);
    to.position.y.at(r, c) = from.position.y.at(r, c);
    to.position.z.at(r, c) = from.position.z.at(r, c);
  });
}

template <class Real>
void move(Particles<Real>& particles, int r, int c, const Vec3& way) {
  particles.position.x.at(r, c) += static_cast<Real>(way.x());
  particles.position.y.at(r, c) += static_cast<Real>(way.y());
  particles.position.z.at(r, c) += static_cast<Real>(way.z());
}

template <class Real>
void stir(Particles<Real>& sheet, double distance) {
  Random random(1);
  at_each_node(sheet.grid(), [&](int r, int c) {
    const double x = random.symmetric(), y = random.symmetric(), z = random.symmetric();
    if (sheet.inverse_mass.at(r, c) != Real(0)) move(sheet, r, c, distance * Vec3(x, y, z));
  });
}

template <class Real>
void unfold_from_below(Particles<Real>& sheet, const ClothDescription& cloth, int level) {
  if (level > kCoarsest) {
    Particles<Real> coarse = coarser(sheet, cloth, level);
    unfold_from_below(coarse, cloth, level - 1);
    const Particles<Real> before = sheet;
    split(coarse, sheet);
    take_held(before, sheet);
  }
  const Sheet<Real> resisting(Springs<Real>(cloth.material, cloth.discretization, cloth.size, sheet.grid()));
  if (level == kCoarsest) stir(sheet, kWayOut * cloth.size.maxCoeff());
  for (int left = level > kCoarsest ? 1 : kTimes; left > 0; --left) {
    settle<Real>(sheet, Unsettled::by_tangle, {.sheet = &resisting, .context = {.cloth = &cloth}}, nullptr,
                 {}, std::numeric_limits<double>::infinity());
  }
}

/// m; nothing of a sheet that is held somewhere.
template <class Real>
std::optional<Vec3> free_centre(const Particles<Real>& particles) {
  if (is_held(particles)) return {};
  return centre_of_mass(particles);
}

}  // namespace

template <class Real>
bool is_tangled(const Particles<Real>& particles, const Springs<Real>& springs) {
  return springs.structural_strain(particles.position).mean > kTangled;
}

template <class Real>
void unfold(Particles<Real>& particles, const ClothDescription& cloth, int level) {
  const Particles<Real> before = particles;
  unfold_from_below(particles, cloth, level);
  if (const auto centre = free_centre(before)) {
    const Vec3 back = *centre - *free_centre(particles);
    at_each_node(particles.grid(), [&](int r, int c) { move(particles, r, c, back); });
  }
  particles.velocity = before.velocity;
  particles.acceleration = before.acceleration;
}

template bool is_tangled(const Particles<float>&, const Springs<float>&);
template bool is_tangled(const Particles<double>&, const Springs<double>&);
template void unfold(Particles<float>&, const ClothDescription&, int);
template void unfold(Particles<double>&, const ClothDescription&, int);

}  // namespace weft
