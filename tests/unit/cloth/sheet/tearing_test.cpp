// Cloth that tears, through the whole simulation.
#include <gtest/gtest.h>

#include <string>

#include "busy_scene.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/tear/tearing.h"
#include "cloth/world/state_hash.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::kFrame;
using test::run;

constexpr double kWidth = 0.5, kHeight = 1, kDensity = 0.5, kStructural = 500;
/// What the top links of the hung strip carry, N/m: the weight of all below their middles but for the rows'
/// own halves, rho g (H - h/2).
constexpr double kTopLoad = kDensity * 9.81 * (kHeight - kHeight / 64);

/// XPBD with so many substeps that its links are hardly longer than their load says: F h^2 (1/m_i + 1/m_j)
/// (xpbd.h), 2 % of what the top ones are longer.
const std::array<IntegratorDescription, 4> kIntegrators{
    SymplecticEulerDescription{}, BackwardEulerDescription{{1, 1e-4, 2, 200}},
    Bdf2Description{{1, 1e-4, 2, 200}}, XpbdDescription{160}};

bool wanders(const IntegratorDescription& integrator) {
  return std::holds_alternative<XpbdDescription>(integrator);
}

/// A strip of threads that hangs by its top edge in balance: link k below the edge is longer by
/// rho g (H - (k + 1/2) h) / Y times its length.
SimulationDescription hung_strip(const IntegratorDescription& integrator, double strength, double shear = 0) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {kWidth, kHeight};
  cloth.base_cells = {1, 2};
  cloth.min_level = 3;
  cloth.initial_level = 4;
  cloth.max_level = 6;
  cloth.material = test::stiffnesses(kStructural - shear, shear, 0);
  cloth.material.density = kDensity;
  cloth.pins = {{0, 1, 0, 0}};
  double y = 0;
  for (int r = 0; r < 33; ++r) {
    for (int c = 0; c < 17; ++c) cloth.nodes.push_back({c * kWidth / 16, y, 0});
    const double h = kHeight / 32, load = kDensity * 9.81 * (kHeight - (r + 0.5) * h);
    y -= h * (1 + load / kStructural);
  }
  scene.cloths = {cloth};
  scene.effects = {GravityEffect{{0, -9.81, 0}}, TearingEffect{1e6, strength}};  // strong across
  // So that the ends of what tears do not swing back and tear more of it. XPBD's single sweep cannot be
  // damped so much and hold its links as well: with it a tear wanders.
  if (!wanders(integrator)) scene.effects.push_back(StrainDampingEffect{0.02});
  scene.integrator = integrator;
  return scene;
}

std::string name_of(const IntegratorDescription& integrator) {
  return std::visit([](const auto& each) { return std::string(each.kName); }, integrator);
}

/// Mean vertical velocity, by mass, of what no longer hangs on the top row, m/s.
double fall(const Cloth<float>& cloth) {
  const TornLinks torn = cloth.walls()->at(cloth.level());
  const Grid& grid = torn.grid();
  Field<char> hangs(grid);
  for (int c = 0; c < grid.cols; ++c) hangs.at(0, c) = 1;
  for (bool grows = true; grows;) {
    grows = false;
    const auto join = [&](int r, int c, int r2, int c2, bool along_u) {
      if (r2 >= grid.rows || c2 >= grid.cols || torn.torn(Link{r, c, along_u})) return;
      if (hangs.at(r, c) == hangs.at(r2, c2)) return;
      hangs.at(r, c) = hangs.at(r2, c2) = 1;
      grows = true;
    };
    each_node(grid, [&](int r, int c) {
      join(r, c, r, c + 1, true);
      join(r, c, r + 1, c, false);
    });
  }
  double momentum = 0, mass = 0;
  each_node(grid, [&](int r, int c) {
    if (hangs.at(r, c) != 0) return;
    momentum += double(cloth.particles().mass.at(r, c)) * cloth.particles().velocity_at(r, c).y();
    mass += double(cloth.particles().mass.at(r, c));
  });
  EXPECT_GT(mass, 0.8 * kWidth * kHeight * kDensity);
  return momentum / mass;
}

TEST(TearingSlow, AStripBearsItsStrengthAndNoMore) {
  for (const IntegratorDescription& integrator : kIntegrators) {
    const double margin = std::holds_alternative<XpbdDescription>(integrator) ? 0.05 : 0.02;
    Simulation<float> holds(hung_strip(integrator, (1 + margin) * kTopLoad));
    Simulation<float> tears(hung_strip(integrator, (1 - margin) * kTopLoad));
    run(holds, 120);
    run(tears, 30);
    EXPECT_EQ(holds.cloths()[0].walls(), nullptr) << name_of(integrator);
    EXPECT_NE(tears.cloths()[0].walls(), nullptr) << name_of(integrator);
  }
}

TEST(TearingSlow, TheTearRunsAcrossThePullAndWhatFallsOffFallsFreely) {
  for (const IntegratorDescription& integrator : kIntegrators) {
    Simulation<float> simulation(hung_strip(integrator, 0.9 * kTopLoad, 200));
    run(simulation, 40);
    const Cloth<float>& cloth = simulation.cloths()[0];
    ASSERT_NE(cloth.walls(), nullptr) << name_of(integrator);
    // The top links are loaded most. Every thread along the pull is cut there or two rows below, none across.
    const TornLinks torn = cloth.walls()->at(4);
    std::array<int, 17> cut{};
    each_node(torn.grid(), [&](int r, int c) {
      EXPECT_FALSE(torn.torn(Link{r, c, true})) << name_of(integrator);
      if (!torn.torn(Link{r, c, false})) return;
      EXPECT_TRUE(r <= 2 || wanders(integrator)) << name_of(integrator) << ' ' << r;
      ++cut[static_cast<std::size_t>(c)];
    });
    for (const int one : cut) EXPECT_GE(one, 1) << name_of(integrator);
    // What hangs on nothing gains 9.81 m/s a second, to 0.2 %, which the solves leave.
    const double before = fall(cloth);
    run(simulation, 30);
    EXPECT_NEAR(fall(cloth) - before, -9.81 * 0.5, 1e-2) << name_of(integrator);
    EXPECT_EQ(simulation.guard_events().size(), 0U);
  }
}

TEST(Tearing, AFallingPieceIsNoRunawayState) {
  // After 12 s it is 700 m below: 22,000 times a cell, more than the guard allows what holds together.
  Simulation<float> simulation(hung_strip(Bdf2Description{}, 0.9 * kTopLoad));
  run(simulation, 720);
  EXPECT_LT(simulation.cloths()[0].particles().position_at(32, 0).y(), -500);
  EXPECT_EQ(simulation.cloths()[0].guard_counters().all_redone(), 0U);
  EXPECT_FALSE(simulation.cloths()[0].frozen());
}

TEST(TearingSlow, LevelChangesKeepTheHalvesApart) {
  for (const IntegratorDescription& integrator : kIntegrators) {
    Simulation<float> simulation(hung_strip(integrator, 0.9 * kTopLoad));
    run(simulation, 40);
    Cloth<float>& cloth = simulation.cloths()[0];
    ASSERT_NE(cloth.walls(), nullptr);
    // No more of it tears: what is looked at is how levels take tears over.
    std::vector<EffectDescription> effects = simulation.description().effects;
    std::erase_if(effects, [](const auto& e) { return std::holds_alternative<TearingEffect>(e); });
    simulation.set_effects(effects);
    const double mass = test::exact_sum(cloth.particles().mass);
    for (const int level : {5, 6, 4, 3, 5}) {
      simulation.request_level(0, level);
      const double before = fall(cloth);
      simulation.step();
      ASSERT_EQ(cloth.level(), level);
      EXPECT_EQ(test::exact_sum(cloth.particles().mass), mass);
      // What fell off goes on falling by g, as far as nodes of unlike speed join it or leave it.
      const double after = fall(cloth);
      EXPECT_NEAR(after - before, -9.81 * kFrame, 0.02) << name_of(integrator) << " to " << level;
      run(simulation, 5);
      // The halves are 2 m apart and more: a link across, or from a node left between them, would be as many
      // times its length as there are cells in half of that, 8 at least.
      EXPECT_LT(simulation.report(0).strain.max, 0.5) << name_of(integrator) << " to " << level;
    }
    EXPECT_LT(cloth.particles().position_at(cloth.particles().grid().rows - 1, 0).y(), -3);
  }
}

TEST(TearingSlow, APulledSheetComesApartAcrossThePull) {
  // Its lower edge is pulled down by 1 m in 2 s; every thread along the pull is cut in the end, hardly one in
  // more places than one.
  for (const IntegratorDescription& integrator : kIntegrators) {
    SimulationDescription scene = hung_strip(integrator, 60, 50);
    scene.cloths[0].nodes.clear();
    scene.cloths[0].pins.push_back({0, 1, 1, 1, {{0, {0, 0, 0}}, {2, {0, -1, 0}}}});
    std::get<TearingEffect>(scene.effects[1]).warp = 60;
    Simulation<float> simulation(scene);
    run(simulation, 150);
    ASSERT_NE(simulation.cloths()[0].walls(), nullptr) << name_of(integrator);
    const TornLinks torn = simulation.cloths()[0].walls()->at(4);
    int all = 0;
    for (int c = 0; c < 17; ++c) {
      int cut = 0;
      for (int r = 0; r < 32; ++r) cut += torn.torn(Link{r, c, false}) ? 1 : 0;
      EXPECT_GE(cut, 1) << name_of(integrator) << ' ' << c;
      all += cut;
    }
    EXPECT_TRUE(all <= 17 + 8 || wanders(integrator)) << name_of(integrator) << ' ' << all;
    EXPECT_LT(simulation.report(0).strain.max, 0.2) << name_of(integrator);
  }
}

TEST(Tearing, WarpAndWeftHaveTheirOwnStrength) {
  SimulationDescription scene = hung_strip(Bdf2Description{}, 2 * kTopLoad);
  std::get<TearingEffect>(scene.effects[1]).warp = 0.5 * kTopLoad;  // across the pull
  Simulation<float> simulation(scene);
  run(simulation, 60);
  EXPECT_EQ(simulation.cloths()[0].walls(), nullptr);
}

TEST(Tearing, ResetMendsAndTheHashTellsWalls) {
  Simulation<float> simulation(hung_strip(Bdf2Description{}, 0.9 * kTopLoad));
  const std::uint64_t start = state_hash(simulation);
  run(simulation, 10);
  ASSERT_NE(simulation.cloths()[0].walls(), nullptr);
  simulation.reset();
  EXPECT_EQ(simulation.cloths()[0].walls(), nullptr);
  EXPECT_EQ(state_hash(simulation), start);

  // Two cloths in the same place, one of them torn: a tear in the first step leaves positions as they are.
  Simulation<float> tears(hung_strip(Bdf2Description{}, 0.9 * kTopLoad));
  Simulation<float> holds(hung_strip(Bdf2Description{}, 2 * kTopLoad));
  tears.step();
  holds.step();
  EXPECT_TRUE(test::same_state(tears.cloths()[0].particles(), holds.cloths()[0].particles()));
  EXPECT_NE(state_hash(tears), state_hash(holds));
}

// Contact remembers which faces are torn, and where the layers were.
TEST(Tearing, AfterAResetContactIsThatOfTheWholeCloth) {
  SimulationDescription scene = hung_strip(Bdf2Description{}, 0.9 * kTopLoad);
  scene.effects.emplace_back(ClothContactEffect{});
  Simulation<float> simulation(scene), fresh(scene);
  run(simulation, 10);
  ASSERT_NE(simulation.cloths()[0].walls(), nullptr);
  simulation.reset();
  for (int step = 0; step < 10; ++step) {
    simulation.step();
    fresh.step();
    ASSERT_EQ(state_hash(simulation), state_hash(fresh)) << step;
  }
}

TEST(Tearing, TakenAwayItTearsNoFurtherAndMendsNothing) {
  SimulationDescription scene = hung_strip(Bdf2Description{}, 0.9 * kTopLoad);
  Simulation<float> simulation(scene);
  run(simulation, 3);
  const auto cut = [&] { return simulation.cloths()[0].walls()->at(4).torn_faces().size(); };
  const std::size_t before = cut();
  simulation.set_effects({scene.effects[0]});
  run(simulation, 20);
  EXPECT_EQ(cut(), before);
}

TEST(Tearing, ATearWakes) {
  SimulationDescription scene = hung_strip(Bdf2Description{}, 2 * kTopLoad);
  scene.sleep_speed = 0.01;
  Simulation<float> simulation(scene);
  for (int i = 0; i < 600 && !simulation.cloths()[0].asleep(); ++i) simulation.step();
  ASSERT_TRUE(simulation.cloths()[0].asleep());
  simulation.set_effects({scene.effects[0], TearingEffect{0.9 * kTopLoad, 0.9 * kTopLoad}});
  run(simulation, 5);
  EXPECT_FALSE(simulation.cloths()[0].asleep());
  EXPECT_NE(simulation.cloths()[0].walls(), nullptr);
}

TEST(Tearing, AllOfItTornIsDustThatFalls) {
  for (const IntegratorDescription& integrator : kIntegrators) {
    SimulationDescription scene = hung_strip(integrator, 1e-6);
    scene.effects = {scene.effects[0], TearingEffect{1e-6, 1e-6}};
    scene.cloths[0].initial_level = 3;
    scene.cloths[0].nodes.clear();
    scene.cloths[0].pins.clear();
    // Thrown about, so that every link is pulled sometime.
    scene.cloths[0].perturbation = 0.05;
    scene.cloths[0].material.shear = 50;
    Simulation<float> simulation(scene);
    run(simulation, 300);
    const Cloth<float>& cloth = simulation.cloths()[0];
    ASSERT_NE(cloth.walls(), nullptr) << name_of(integrator);
    EXPECT_GT(cloth.walls()->at(3).torn_faces().size(), 100U) << name_of(integrator);  // of 128
    EXPECT_TRUE(std::isfinite(kinetic_energy(cloth.particles()))) << name_of(integrator);
    EXPECT_EQ(cloth.guard_counters().all_redone(), 0U) << name_of(integrator);
    EXPECT_NEAR(linear_momentum(cloth.particles()).y() / cloth.total_mass(), -9.81 * 5, 0.05)
        << name_of(integrator);
  }
}

TEST(Tearing, TornFacesTakeNoPressure) {
  // Every second column of faces torn through: half the air's push.
  SimulationDescription scene = hung_strip(Bdf2Description{}, 1e9);
  scene.cloths[0].nodes.clear();
  scene.effects = {InflationEffect{10}, TearingEffect{}};
  Simulation<float> simulation(scene);
  const Particles<float>& particles = simulation.cloths()[0].particles();
  TornLinks torn(particles.grid());
  for (int r = 0; r < 33; ++r) {
    for (int c = 0; c < 16; c += 2) torn.cut({r, c, true});
  }
  const std::vector<FaceRun> whole = torn.whole_faces();
  for (const EffectDescription& effect :
       {EffectDescription{InflationEffect{10}}, EffectDescription{AerodynamicsEffect{}}}) {
    const Wind wind{{0, 0, 1}, 3};
    EffectContext context;
    context.wind = &wind;
    const auto push = [&] {
      VectorField<float> force(particles.grid());
      for (const auto& each : make_effects<float>({effect})) each->add_forces(particles, context, force);
      double sum = 0;
      each_node(force.grid(), [&](int r, int c) { sum += get(force, r, c).z(); });
      return sum;
    };
    context.whole_faces = nullptr;
    const double all = push();
    context.whole_faces = &whole;
    EXPECT_NEAR(push(), all / 2, 1e-5 * all) << name_of(effect);
    EXPECT_GT(all, 1);
  }
}

TEST(Tearing, PlatesTearToo) {
  SimulationDescription scene = hung_strip(kIntegrators[2], 0.9 * kTopLoad);
  scene.effects.push_back(PlateBendingEffect{});
  Simulation<float> simulation(scene);
  run(simulation, 40);
  const Cloth<float>& cloth = simulation.cloths()[0];
  ASSERT_NE(cloth.walls(), nullptr);
  const double before = fall(cloth);
  run(simulation, 20);
  EXPECT_NEAR(fall(cloth) - before, -9.81 / 3, 1e-2);  // no moment holds the piece back
}

}  // namespace
}  // namespace weft
