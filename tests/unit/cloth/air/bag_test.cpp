#include "cloth/air/bag.h"

#include <gtest/gtest.h>

#include "fixtures.h"

namespace weft {
namespace {

InflationEffect filling(double volume, double fill_time) {
  InflationEffect inflation;
  inflation.pressure = 1000;
  inflation.volume = volume;
  inflation.fill_time = fill_time;
  return inflation;
}

Particles<double> flat_bag() {
  Particles<double> particles = test::flat_sheet<double>(9, 17, {2, 1});
  test::share_mass(particles, 0.2, Discretization::continuum);
  return particles;
}

TEST(Bag, HoldsNoGasUnlessItIsFilled) {
  const Particles<double> particles = flat_bag();
  Bag<double> bag(particles.grid());
  EXPECT_FALSE(bag.fill(std::nullopt, particles, 0));
  EXPECT_EQ(bag.gas(), nullptr);
  EXPECT_FALSE(bag.fills(0));
}

TEST(Bag, TellsWhetherGasIsThereAtOnceAndUntilWhenItIsPouredIn) {
  const Particles<double> particles = flat_bag();
  Bag<double> at_once(particles.grid()), slowly(particles.grid());
  EXPECT_TRUE(at_once.fill(filling(0.1, 0), particles, 3));
  EXPECT_FALSE(slowly.fill(filling(0.1, 2), particles, 3));
  EXPECT_TRUE(slowly.fills(4.9));
  EXPECT_FALSE(slowly.fills(5));
  // c = (p_a + pressure) volume, of which a second pours in half on top of what a flat bag holds, nothing.
  EXPECT_NEAR(slowly.gas()->amount(4), (101325 + 1000) * 0.1 / 2, 1e-9);
}

TEST(Bag, TheSameGasGoesOnAndAnotherBeginsWithWhatIsThere) {
  const Particles<double> particles = flat_bag();
  Bag<double> bag(particles.grid());
  bag.fill(filling(0.1, 2), particles, 0);
  const Gas<double>* gas = bag.gas();
  bag.fill(filling(0.1, 2), particles, 1);
  EXPECT_EQ(bag.gas(), gas);
  const double before = bag.gas()->amount(1);
  bag.fill(filling(0.2, 2), particles, 1);
  EXPECT_EQ(bag.gas()->amount(1), before);
  bag.fill(std::nullopt, particles, 1);
  EXPECT_EQ(bag.gas(), nullptr);
}

TEST(Bag, AnEmptyOneClosesByItsSeamAlone) {
  Particles<double> particles = flat_bag(), joined = particles;
  test::randomise(particles.position, -1, 1, 3);
  joined.position = particles.position;
  Bag<double> bag(particles.grid());
  bag.close(particles, 0, 0.01);
  Seam<double>(joined.grid()).join(joined);
  EXPECT_EQ(particles.position.x.values(), joined.position.x.values());
  EXPECT_EQ(particles.position.y.values(), joined.position.y.values());
  EXPECT_EQ(particles.position.z.values(), joined.position.z.values());
  EXPECT_EQ(bag.model_error({}, {}), 0);
}

}  // namespace
}  // namespace weft
