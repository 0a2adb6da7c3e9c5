// T18: one sheet at several levels approaches one answer, with the error falling as the square of the cell
// (order 2); and by how much the paper's own rules do not.
#include "cloth/world/simulation.h"
#include "methods.h"

namespace weft::test {
namespace {

/// A sheet of 2 m, 0.1 kg/m2, 5,000 N/m hung by its top edge: how far its lower edge's middle comes to rest
/// below where it would unloaded.
double stretch(int level, Discretization discretization) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {2, 2};
  cloth.min_level = cloth.max_level = cloth.initial_level = level;
  cloth.material = strands(5000);
  cloth.discretization = discretization;
  cloth.pins = {{0, 1, 0, 0}};
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{}};
  scene.integrator = solved_exactly<BackwardEulerDescription>(1, 1);
  scene.time_step = 1;  // long steps: straight to rest
  scene.sleep_speed = 0;
  Simulation<double> simulation(scene);
  for (int step = 0; step < 100; ++step) simulation.step();
  const Grid& grid = simulation.cloths()[0].particles().grid();
  return -1 - simulation.cloths()[0].particles().position_at(grid.rows - 1, grid.cols / 2).y();
}

// T9 at every level: border springs half as stiff and border masses half make the lattice's stretch the
// sheet's own, rho g L^2 / (2 Y).
TEST(Levels, HungSheetStretchesAlike) {
  for (const int level : {3, 4, 5, 6}) {
    EXPECT_NEAR(stretch(level, Discretization::continuum), 0.1 * 9.81 * 4 / (2 * 5000), 1e-9) << level;
  }
}

// With the paper's m_total / n and full border springs (Eq. 9) it is N / (N + 1) of that, N cells a side:
// spring i from below carries i of the N + 1 equal masses of its column, sum i m g / k = N (N + 1) / 2 m g /
// k, m = M / (N + 1)^2.
TEST(Levels, PapersRulesStretchByLevel) {
  for (const int level : {3, 4, 5, 6}) {
    const double cells = 1 << level;
    EXPECT_NEAR(stretch(level, Discretization::paper), 0.1 * 9.81 * 4 / (2 * 5000) * cells / (cells + 1),
                1e-9)
        << level;
  }
}

/// Largest depth of a strip of 2 m between supports 1.2 m apart, its nodes on a chain of `cells` links at
/// rest.
double sag(int cells) {
  Particles<double> sheet = flat_sheet<double>(3, cells + 1, {2, 0.125});
  share_mass(sheet, 0.1 * 2 * 0.125, Discretization::continuum);
  each_node(sheet.grid(), [&](int r, int c) {
    const double t = 2.0 * c / cells - 1;
    set(sheet.position, r, c, {t * 0.6, (std::abs(t) - 1) * 0.8, 0.0625 * (r - 1)});
    if (c == 0 || c == cells) sheet.inverse_mass.at(r, c) = 0;
  });
  Rig<double> rig(std::move(sheet), {2, 0.125}, strands(1e6), Discretization::continuum, {GravityEffect{}},
                  solved_exactly<BackwardEulerDescription>(1, 4));
  for (int step = 0; step < 2000; ++step) rig.advance(step * 0.02, 0.02);
  return -get(rig.particles.position, 1, cells / 2).y();
}

// T10 on finer and finer strips.
TEST(Levels, CatenarysErrorFallsWithTheSquareOfTheCell) {
  constexpr double kExact = 0.725564;
  const double coarse = std::abs(sag(8) - kExact), middle = std::abs(sag(16) - kExact),
               fine = std::abs(sag(32) - kExact);
  EXPECT_NEAR(std::log2(coarse / middle), 2, 0.2);
  EXPECT_NEAR(std::log2(middle / fine), 2, 0.2);
  RecordProperty("observed_order", std::to_string(std::log2(middle / fine)));
}

}  // namespace
}  // namespace weft::test
