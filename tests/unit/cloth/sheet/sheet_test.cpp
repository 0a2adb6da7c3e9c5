#include "cloth/sheet/sheet.h"

#include <gtest/gtest.h>

#include "fixtures.h"

namespace weft {
namespace {

const Vec2 kSheetSize(2, 2);

ClothDescription limited_cloth() {
  ClothDescription cloth;
  cloth.size = kSheetSize;
  cloth.material.limit = {.warp = 0.05, .weft = 0.05, .shear = 0.1, .stiffening = 20};
  return cloth;
}

Particles<double> crumpled_sheet() {
  Particles<double> sheet = test::flat_sheet<double>(9, 9, kSheetSize);
  test::share_mass(sheet, 0.4, Discretization::continuum);
  test::randomise(sheet.position, -1, 1, 5);
  test::randomise(sheet.velocity, -1, 1, 6);
  return sheet;
}

Sheet<double> sheet_with(const std::vector<EffectDescription>& effects, const Particles<double>& particles) {
  return {limited_cloth(), SheetEffects(effects), particles.inverse_mass};
}

TEST(SheetEffects, AreThoseOfTheList) {
  const SheetEffects none({GravityEffect{}, DampingEffect{}});
  EXPECT_EQ(none, SheetEffects());
  const SheetEffects all(
      {StrainDampingEffect{0.02}, GravityEffect{}, StrainLimitEffect{}, PlateBendingEffect{}});
  EXPECT_EQ(all.damping_time, 0.02);
  EXPECT_TRUE(all.limits_strain);
  EXPECT_TRUE(all.bends_plate);
}

TEST(Sheet, HasNoPlateNorDampingThatTheSceneDoesNotList) {
  const Sheet<double> sheet = sheet_with({GravityEffect{}}, crumpled_sheet());
  EXPECT_EQ(sheet.plate(), nullptr);
  EXPECT_FALSE(sheet.damped());
  EXPECT_FALSE(sheet.springs().limited());
  EXPECT_EQ(sheet.torn(), nullptr);
}

TEST(Sheet, EnergyIsThatOfSpringsAndPlate) {
  const Particles<double> particles = crumpled_sheet();
  const Sheet<double> sheet = sheet_with({PlateBendingEffect{}}, particles);
  const Plate<double> plate(limited_cloth().material.rigidity, kSheetSize, particles.inverse_mass);
  const double bent = plate.energy(particles.position);
  EXPECT_GT(bent, 0);
  EXPECT_EQ(sheet.energy(particles.position), sheet.springs().energy(particles.position) + bent);
}

// Virtual work: over a small way d the energy changes by -F d, here by central differences of one node's
// coordinate, whose error is of the order of d^2.
TEST(Sheet, ForceIsMinusTheGradientOfTheEnergy) {
  Particles<double> particles = crumpled_sheet();
  const Sheet<double> sheet = sheet_with({PlateBendingEffect{}, StrainLimitEffect{}}, particles);
  VectorField<double> force(particles.grid());
  sheet.add_forces(particles.position, force);
  constexpr double kStep = 1e-6;
  double& y = particles.position.y.at(4, 3);
  const double before = y;
  y = before + kStep;
  const double above = sheet.energy(particles.position);
  y = before - kStep;
  const double below = sheet.energy(particles.position);
  y = before;
  const double expected = -(above - below) / (2 * kStep);
  EXPECT_NEAR(force.y.at(4, 3), expected, 1e-6 * std::abs(expected));
}

// Modes add up: the squared frequency of springs and plate side by side is at most the sum of both. Beyond a
// limit of stiffening s the springs' is s times as high, and damping by a quarter of a substep, of which an
// explicit substep bears twice as much less, takes half of it more.
TEST(Sheet, ExplicitBoundsAreThoseOfAllThatResists) {
  const Particles<double> particles = crumpled_sheet();
  const Field<double>& mass = particles.mass;
  const double of_springs = sheet_with({}, particles).springs().max_squared_frequency(mass);
  const ExplicitBounds plain = sheet_with({}, particles).explicit_bounds(mass);
  EXPECT_EQ(plain.squared_frequency, of_springs);
  EXPECT_EQ(plain.damping_rate, 0);
  const Sheet<double> bent = sheet_with({PlateBendingEffect{}}, particles);
  EXPECT_EQ(bent.explicit_bounds(mass).squared_frequency,
            of_springs + bent.plate()->max_squared_frequency(mass));
  EXPECT_NEAR(sheet_with({StrainDampingEffect{0.01}}, particles).explicit_bounds(mass).damping_rate,
              0.01 * of_springs, 1e-12 * of_springs);
  const Sheet<double> limited = sheet_with({StrainLimitEffect{}}, particles);
  const ExplicitBounds bounds = limited.explicit_bounds(mass);
  EXPECT_EQ(bounds.of_springs, limited.springs().max_squared_frequency(mass));
  EXPECT_NEAR(bounds.squared_frequency, 1.5 * bounds.of_springs, 1e-12 * bounds.of_springs);
}

TEST(Sheet, WithOtherSpringsKeepsItsPlate) {
  const Particles<double> particles = crumpled_sheet();
  const Sheet<double> sheet = sheet_with({PlateBendingEffect{}}, particles);
  const Sheet<double> other = sheet.with(Springs<double>());
  EXPECT_EQ(other.plate(), sheet.plate());
  EXPECT_EQ(other.energy(particles.position), sheet.plate()->energy(particles.position));
}

// Every spring at twice its length holds k l^2 / 2. A sheet of two cells a side with structural springs
// alone, k = 10 N/m: in the paper's discretisation 12 springs of 1 m, 60 J.
TEST(Springs, EnergyAtTwiceIsThatOfAllSpringsAtTwiceTheirLength) {
  Material material;
  material.structural = 10;
  material.shear = material.bending = 0;
  const Grid grid = Grid::with_nodes(3, 3);
  EXPECT_DOUBLE_EQ(Springs<double>(material, Discretization::paper, {2, 2}, grid).energy_at_twice(grid), 60);
}

}  // namespace
}  // namespace weft
