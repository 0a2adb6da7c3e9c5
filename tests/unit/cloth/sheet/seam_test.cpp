// Sewn cloths: which nodes are one, and that they stay so.
#include "cloth/sheet/seam.h"

#include <gtest/gtest.h>

#include <set>

#include "cloth/sheet/diagnostics.h"
#include "cloth/world/simulation.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::get;

TEST(Seam, JoinsEachNodeOfTheRimWithItsMirrorImage) {
  const Grid grid = Grid::with_nodes(5, 9);
  const Seam<double> seam(grid);
  std::set<std::size_t> sewn;
  for (const auto& [left, right] : seam.pairs()) {
    const auto stride = static_cast<std::size_t>(grid.stride);
    EXPECT_EQ(left / stride, right / stride);
    EXPECT_EQ(left % stride + right % stride, 8u);
    EXPECT_TRUE(sewn.insert(left).second && sewn.insert(right).second);
  }
  // 24 nodes of the rim but the two on the fold.
  EXPECT_EQ(sewn.size(), 22u);
}

TEST(Seam, PassesThroughTheNodesOfTheLevelBelow) {
  std::set<std::pair<std::size_t, std::size_t>> fine;
  const Grid grid = Grid::with_nodes(9, 17), coarse = Grid::with_nodes(5, 9);
  const Seam<float> fine_seam(grid), coarse_seam(coarse);
  for (const auto& [left, right] : fine_seam.pairs()) fine.insert({left, right});
  const auto up = [&](std::size_t i) {
    const auto stride = static_cast<std::size_t>(coarse.stride);
    return grid.index(2 * static_cast<int>(i / stride), 2 * static_cast<int>(i % stride));
  };
  for (const auto& [left, right] : coarse_seam.pairs()) EXPECT_EQ(fine.count({up(left), up(right)}), 1u);
}

TEST(Seam, JoinsNodesOfEqualMass) {
  for (const Discretization discretization : {Discretization::paper, Discretization::continuum}) {
    Particles<float> sheet(Grid::with_nodes(9, 17));
    mass_distribution(0.3, discretization, sheet.mass);
    const Seam<float> seam(sheet.grid());
    for (const auto& [left, right] : seam.pairs())
      EXPECT_EQ(sheet.mass.row(0)[left], sheet.mass.row(0)[right]) << discretization;
  }
}

/// A pillow of two squares of 1 m, flying and turning: no gravity, no drag.
SimulationDescription flying(const IntegratorDescription& integrator) {
  SimulationDescription scene;
  scene.integrator = integrator;
  ClothDescription& cloth = scene.cloths.emplace_back();
  cloth.sewn = true;
  cloth.size = {2, 1};
  cloth.base_cells = {2, 1};
  cloth.min_level = 3;
  cloth.max_level = cloth.initial_level = 4;
  cloth.velocity = {1, 2, 3};
  cloth.perturbation = 0.01;
  scene.effects = {StrainDampingEffect{0.002}, InflationEffect{0, 0.08, 0.3}};
  return scene;
}

void expect_closed(const Cloth<double>& cloth, const std::string& when) {
  const Particles<double>& bag = cloth.particles();
  for (const auto& [left, right] : cloth.seam()->pairs()) {
    for (const VectorField<double>* field : {&bag.position, &bag.velocity}) {
      for (const Field<double>* component : {&field->x, &field->y, &field->z}) {
        ASSERT_EQ(component->row(0)[left], component->row(0)[right]) << when;
      }
    }
  }
}

class SewnCloth : public ::testing::TestWithParam<IntegratorDescription> {};

TEST_P(SewnCloth, StaysClosedAndKeepsItsMomentumWhateverItsLevel) {
  Simulation<double> simulation(flying(GetParam()));
  Cloth<double>& cloth = simulation.cloths()[0];
  expect_closed(cloth, "at the start");
  const double mass = cloth.total_mass();
  Vec3 momentum = linear_momentum(cloth.particles());
  EXPECT_LT((momentum - mass * Vec3(1, 2, 3)).norm(), 1e-12);
  for (int step = 0; step < 60; ++step) {
    if (step == 30) cloth.request_level(3);
    if (step == 45) cloth.request_level(4);
    simulation.step();
    expect_closed(cloth, "after step " + std::to_string(step));
    // A closed surface's own pressure moves nothing, nor does its seam; systems are solved to rounding.
    EXPECT_LT((linear_momentum(cloth.particles()) - momentum).norm(), 1e-6 * momentum.norm()) << step;
  }
  EXPECT_GT(enclosed_volume(cloth.particles().position), 0.07);
}

TEST_P(SewnCloth, HoldsBothNodesThatAPinHolds) {
  SimulationDescription scene = flying(GetParam());
  scene.cloths[0].pins = {{0, 0, 0.5, 0.5, {{0, {0, 0, 0}}, {1, {0, 0, 1}}}}};
  scene.cloths[0].velocity = {0, 0, 0};
  scene.cloths[0].perturbation = 0;
  Simulation<double> simulation(scene);
  const Particles<double>& bag = simulation.cloths()[0].particles();
  EXPECT_EQ(bag.inverse_mass.at(8, 0), 0);
  EXPECT_EQ(bag.inverse_mass.at(8, 32), 0);
  const Vec3 begin = get(bag.position, 8, 0);
  for (int step = 0; step < 30; ++step) simulation.step();
  expect_closed(simulation.cloths()[0], "pinned");
  EXPECT_LT((get(bag.position, 8, 32) - begin - Vec3(0, 0, 0.5)).norm(), 1e-9);
}

template <class Description>
Description solved_exactly() {
  Description description;
  description.tolerance = 1e-12;
  description.newton_iterations = 10;
  description.linear_iterations = 1000;
  return description;
}

/// A parametrised test is named after its method.
constexpr auto kMethodName = [](const auto& tested) {
  return std::string(std::visit([](const auto& d) { return d.kName; }, tested.param));
};
INSTANTIATE_TEST_SUITE_P(Methods, SewnCloth, ::testing::Values(XpbdDescription{}), kMethodName);
INSTANTIATE_TEST_SUITE_P(Slow, SewnCloth,
                         ::testing::Values(SymplecticEulerDescription{},
                                           solved_exactly<BackwardEulerDescription>(),
                                           solved_exactly<Bdf2Description>()),
                         kMethodName);

TEST(Gas, GoesOnFromWhatIsThereIfItIsChanged) {
  SimulationDescription scene = flying(Bdf2Description{});
  Simulation<double> simulation(scene);
  for (int step = 0; step < 30; ++step) simulation.step();
  const Gas<double>* gas = simulation.cloths()[0].gas();
  ASSERT_NE(gas, nullptr);
  const double amount = gas->amount(simulation.time());
  EXPECT_NEAR(amount, Gas<double>::kOutside * 0.08, 1e-6);
  // Another effect comes: the gas stays as it is. Another gas: it begins with what there is.
  std::vector<EffectDescription> effects = scene.effects;
  effects.emplace_back(DampingEffect{});
  simulation.set_effects(effects);
  EXPECT_EQ(simulation.cloths()[0].gas(), gas);
  std::get<InflationEffect>(effects[1]).volume = 0.05;
  simulation.set_effects(effects);
  EXPECT_EQ(simulation.cloths()[0].gas()->amount(simulation.time()), amount);
  effects.erase(effects.begin() + 1);
  simulation.set_effects(effects);
  EXPECT_EQ(simulation.cloths()[0].gas(), nullptr);
}

// An implicit step blows a bag up by itself; as motion of an explicit one it would crumple it.
class GasAtOnce : public ::testing::TestWithParam<IntegratorDescription> {};
INSTANTIATE_TEST_SUITE_P(Slow, GasAtOnce, ::testing::Values(SymplecticEulerDescription{}, XpbdDescription{}));

TEST_P(GasAtOnce, BlowsABagUpWithoutMotionAsSmoothAsGasPouredIn) {
  const auto blown_up = [](double fill_time, int steps) {
    SimulationDescription scene = flying(GetParam());
    std::get<InflationEffect>(scene.effects[1]).fill_time = fill_time;
    Simulation<double> simulation(scene);
    for (int step = 0; step < steps; ++step) simulation.step();
    return simulation;
  };
  const double poured_in = blown_up(0.5, 60).cloths()[0].elastic_energy();
  EXPECT_LT(blown_up(0, 60).cloths()[0].elastic_energy(), 1.5 * poured_in);
  // The gas has 0.08 p_a = 8 kJ; what moves has no more than the springs that it is let go by.
  const Simulation<double> first = blown_up(0, 1);
  const Cloth<double>& bag = first.cloths()[0];
  EXPECT_NEAR(enclosed_volume(bag.particles().position), 0.08, 1e-3);
  const double as_one = bag.total_mass() * Vec3(1, 2, 3).squaredNorm() / 2;
  EXPECT_LT(kinetic_energy(bag.particles()) - as_one, poured_in);
}

TEST(Gas, IsOnlyInSewnCloths) {
  SimulationDescription scene = flying(Bdf2Description{});
  scene.cloths[0].sewn = false;
  Simulation<double> simulation(scene);
  EXPECT_EQ(simulation.cloths()[0].gas(), nullptr);
  EXPECT_EQ(simulation.cloths()[0].seam(), nullptr);
}

}  // namespace
}  // namespace weft
