// Nodes that come with a finer level leave the solids that their coarser neighbours lie on.
#include "cloth/levels/lift_nodes.h"

#include "cloth/sheet/diagnostics.h"
#include "cloth/world/simulation.h"
#include "cloth/world/state.h"
#include "fixtures.h"

namespace weft {
namespace {

using test::each_node;
using test::set;

Solid standing(const Shape& shape, const Vec3& centre) {
  Solid solid{.id = 1, .shape = shape};
  solid.start = solid.position = centre;
  return solid;
}

/// A strip of 3 x 5 nodes along x, all pinned, in which each second one along x is new: the others are at
/// these three places, beside each other along z.
Particles<double> strip(const Vec3& first, const Vec3& second, const Vec3& third) {
  Particles<double> coarse(Grid::with_nodes(2, 3)), fine(Grid::with_nodes(3, 5));
  for (int r = 0; r < 2; ++r) {
    set(coarse.position, r, 0, Vec3(first + Vec3(0, 0, r)));
    set(coarse.position, r, 1, Vec3(second + Vec3(0, 0, r)));
    set(coarse.position, r, 2, Vec3(third + Vec3(0, 0, r)));
  }
  split(coarse, fine);
  return fine;
}

const Quaternion kAlongZ(Eigen::AngleAxisd(std::acos(0.0), Vec3(1, 0, 0)));  // what lies along y does then

Solid rail(double radius, double half) {
  Solid lying = standing(Capsule{half, radius}, {0, 0, 0});
  lying.rotation = kAlongZ.toRotationMatrix();
  return lying;
}

const double kDiagonal = std::sqrt(0.5);

// On a rail at 0, 45 and 90 degrees, they belong to 22.5 and 67.5 degrees: the chord's normal is the arc's.
TEST(LiftNewNodes, ThoseOnChordsOfARailGoOntoItsSurface) {
  for (const double depth : {0.0, 0.1}) {
    const double radius = 1 - depth;  // where the coarser level's are held, on the surface or inside
    Particles<double> sheet =
        strip({0, radius, 0}, {kDiagonal * radius, kDiagonal * radius, 0}, {radius, 0, 0});
    const Particles<double> before = sheet;
    EXPECT_TRUE(lift_new_pins(1, {rail(1, 10)}, sheet));
    each_node(sheet.grid(), [&](int r, int c) {
      const double angle = std::acos(0.0) * c / 4;
      const Vec3 wanted(radius * std::sin(angle), radius * std::cos(angle), 0.5 * r);
      EXPECT_LT((sheet.position_at(r, c) - wanted).norm(), 1e-12) << r << ", " << c << " at depth " << depth;
      if (r % 2 == 0 && c % 2 == 0) {
        EXPECT_EQ(sheet.position_at(r, c), before.position_at(r, c));
      }
    });
  }
}

TEST(LiftNewNodes, FreeOnesDoSoWhereTheyAreDeep) {
  const double deep = 1 - std::cos(std::acos(0.0) / 4);  // of the chords' middles
  Particles<double> sheet = strip({0, 1, 0}, {kDiagonal, kDiagonal, 0}, {1, 0, 0});
  const Particles<double> before = sheet;
  EXPECT_FALSE(lift_new_free_nodes(1, {rail(1, 10)}, 0, sheet));  // all are pinned
  each_node(sheet.grid(), [&](int r, int c) { sheet.inverse_mass.at(r, c) = 1; });
  EXPECT_FALSE(lift_new_free_nodes(1, {rail(1, 10)}, 1.01 * deep, sheet));
  EXPECT_TRUE(lift_new_free_nodes(1, {rail(1, 10)}, 0.99 * deep, sheet));
  each_node(sheet.grid(), [&](int r, int c) {
    const double angle = std::acos(0.0) * c / 4;
    EXPECT_LT((sheet.position_at(r, c) - Vec3(std::sin(angle), std::cos(angle), 0.5 * r)).norm(), 1e-12);
  });
}

// The same of free nodes, at a top of 3 cm: the chord's direction is (0.6, -0.8), its node 2 cm deep.
TEST(LiftNewNodes, AtATablesEdgeFreeOnesDoNotLeaveItBelow) {
  Particles<double> coarse(Grid::with_nodes(2, 2)), once(Grid::with_nodes(3, 3)),
      fine(Grid::with_nodes(5, 5));
  for (int r = 0; r < 2; ++r) {
    set(coarse.position, r, 0, Vec3(-0.05, 0, 0.1 * r));
    set(coarse.position, r, 1, Vec3(0.01, -0.08, 0.1 * r));
  }
  split(coarse, once);
  split(once, fine);
  each_node(fine.grid(), [&](int r, int c) { fine.inverse_mass.at(r, c) = 1; });
  const Solid table = standing(Box{{0.5, 0.015, 1}}, {-0.5, -0.015, 0});
  EXPECT_LT(table.placed(0).surface(fine.local_position_at(0, 1)).normal.y(), 0);  // the nearest way
  EXPECT_TRUE(lift_new_free_nodes(2, {table}, 1e-4, fine));
  for (int r = 0; r < 5; ++r) {
    const Vec3 wanted(-0.035 + 0.02 * 0.8 / 0.6, 0, 0.025 * r);
    EXPECT_LT((fine.local_position_at(r, 1) - wanted).norm(), 1e-12) << r;
  }
}

TEST(LiftNewNodes, FreeNodesAndThoseOutsideStay) {
  Particles<double> sheet = strip({0, 1, 0}, {kDiagonal, kDiagonal, 0}, {1, 0, 0});
  const Particles<double> before = sheet;
  EXPECT_FALSE(lift_new_pins(1, {rail(0.9, 10)}, sheet));  // a chord is 0.924 m from the axis
  each_node(sheet.grid(), [&](int r, int c) { sheet.inverse_mass.at(r, c) = 1; });
  EXPECT_FALSE(lift_new_pins(1, {rail(1, 10)}, sheet));
  each_node(sheet.grid(), [&](int r, int c) {
    EXPECT_EQ(sheet.position_at(r, c), before.position_at(r, c)) << r << ", " << c;
  });
}

// A sheet over the edge of a table's top, 2 cm thick, whose lower side is nearer to the chord. Of the node, a
// quarter of the way down, one neighbour lies on the top and looks up, the other is below it and looks down:
// it goes across the chord, whose direction is (0.8, -0.6), by 15 mm / 0.8.
TEST(LiftNewNodes, TheyLeaveAThinSolidToTheSideThatTheClothIsOn) {
  Particles<double> coarse(Grid::with_nodes(2, 2)), fine(Grid::with_nodes(5, 5));
  for (int r = 0; r < 2; ++r) {
    set(coarse.position, r, 0, {-0.05, 0.01, 0.1 * r});
    set(coarse.position, r, 1, {0.03, -0.05, 0.1 * r});
  }
  Particles<double> between(Grid::with_nodes(3, 3));
  split(coarse, between);
  split(between, fine);
  ASSERT_LT((fine.position_at(0, 1) - Vec3(-0.03, -0.005, 0)).norm(), 1e-15);
  EXPECT_TRUE(lift_new_pins(2, {standing(Box{{1, 0.01, 1}}, {-1, 0, 0})}, fine));
  EXPECT_LT((fine.position_at(0, 1) - Vec3(-0.03 + 0.015 * 0.6 / 0.8, 0.01, 0)).norm(), 1e-12);
  EXPECT_EQ(fine.position_at(0, 2), between.position_at(0, 1));  // under the top, in nothing
}

// A floor through the rail's axis: a chord from the rail to the floor lies in both.
TEST(LiftNewNodes, OutOfOneSolidTheyDoNotStayInAnother) {
  Particles<double> sheet = strip({-2, 0, 0}, {-0.6, 0.8, 0}, {0.6, 0.8, 0});
  const std::vector<Solid> both{rail(1, 10), standing(HalfSpace{}, {0, 0.3, 0})};
  EXPECT_TRUE(lift_new_pins(1, both, sheet));
  each_node(sheet.grid(), [&](int r, int c) {
    if (c % 2 == 0) return;
    for (const Solid& solid : both)
      EXPECT_GT(solid.placed(0).surface(sheet.position_at(r, c)).distance, -1e-12) << r << ", " << c;
  });
}

/// m: edges of 0.125 m span 15 degrees each, so that a sheet around it is not strained.
const double kRailRadius = 0.125 / (2 * std::sin(std::acos(0.0) / 12));

/// 2 m of cloth at level 4, bent along a rail for six cells to either side and hanging from there; it is
/// pinned in a patch on top, the rest swings.
SimulationDescription on_a_rail() {
  SimulationDescription scene;
  ClothDescription& cloth = scene.cloths.emplace_back();
  cloth.min_level = 3;
  cloth.initial_level = 4;
  cloth.pins = {{0.375, 0.625, 0.25, 0.75}};
  for (int r = 0; r <= 16; ++r) {
    for (int c = 0; c <= 16; ++c) {
      const double turned = std::acos(0.0) / 6 * std::clamp(c - 8, -6, 6);
      const double hanging = 0.125 * std::max(0, std::abs(c - 8) - 6);
      cloth.nodes.push_back(
          {kRailRadius * std::sin(turned), kRailRadius * std::cos(turned) - hanging, 0.125 * (r - 8)});
    }
  }
  cloth.velocity = {0.5, 0, 0};
  ObstacleDescription lying;
  lying.shape = CapsuleDescription{.radius = kRailRadius, .length = 4, .orientation = kAlongZ};
  scene.obstacles = {lying};
  scene.effects = {GravityEffect{}};
  return scene;
}

/// How far the deepest pinned node is inside, m.
double depth_of_pins(const Simulation<float>& simulation) {
  const Particles<float>& particles = simulation.cloths()[0].particles();
  double deepest = 0;
  each_node(particles.grid(), [&](int r, int c) {
    if (particles.inverse_mass.at(r, c) != 0) return;
    const Vec3 at = particles.position_at(r, c);
    deepest = std::max(deepest, kRailRadius - std::hypot(at.x(), at.y()));
  });
  return deepest;
}

// A chord of a cell, 0.125 m, lies 0.125^2 / (8 kRailRadius) = 4.1 mm deep in the rail.
TEST(LiftNewNodes, AFinerLevelOfAClothOnARailShowsNothingOfIt) {
  for (const Discretization rules : {Discretization::continuum, Discretization::paper}) {
    SimulationDescription scene = on_a_rail();
    scene.cloths[0].discretization = rules;
    Simulation<float> simulation(scene);
    simulation.step();
    EXPECT_LT(depth_of_pins(simulation), 1e-6);
    for (const int level : {6, 4, 5, 6}) {
      simulation.request_level(0, level);
      simulation.step();
      EXPECT_LT(depth_of_pins(simulation), 1e-6) << "level " << level;
    }
  }
}

// All that is bent is pinned, so that no free node is in the rail: what is stretched from chords to arcs is
// between pins, 15 degrees by (7.5 degrees in rad)^2 / 6 = 0.3 %.
TEST(LiftNewNodes, NoMotionPaysForIt) {
  SimulationDescription scene = on_a_rail();
  scene.cloths[0].pins = {{0.125, 0.875, 0, 1}};
  Simulation<float> simulation(scene);
  simulation.step();
  Cloth<float>& cloth = simulation.cloths()[0];
  cloth.request_level(6);
  ASSERT_TRUE(cloth.apply_pending_level());
  const double kinetic = kinetic_energy(cloth.particles()), elastic = cloth.elastic_energy();
  const std::vector<Solid> solids{rail(kRailRadius, 2)};
  cloth.lift_new_pins(solids);
  if (cloth.unsettled(solids)) cloth.settle_down(solids, simulation.time());
  EXPECT_GT(cloth.elastic_energy() - elastic, kinetic);
  EXPECT_NEAR(kinetic_energy(cloth.particles()) / kinetic, 1, 0.01);
}

// The node between the patch's middle one and the next of level 4, after a step of 0.6 m/s upwards.
TEST(LiftNewNodes, ThoseOnAPathGoOnFromWhereTheyWereLifted) {
  SimulationDescription scene = on_a_rail();
  const double dt = scene.time_step;
  scene.cloths[0].pins[0].path = {{dt, {0, 0, 0}}, {dt + 1, {0, 0.6, 0}}};
  Simulation<float> simulation(scene);
  simulation.step();
  simulation.request_level(0, 6);
  simulation.step();
  const Vec3 at = simulation.cloths()[0].particles().position_at(32, 34);
  EXPECT_NEAR(std::hypot(at.x(), at.y() - 0.6 * dt), kRailRadius, 1e-6);
}

TEST(LiftNewNodes, AStateThatIsSavedBetweenLevelAndStepGoesOnToTheSameBits) {
  Simulation<float> simulation(on_a_rail()), other(on_a_rail());
  simulation.step();
  simulation.cloths()[0].request_level(6);
  simulation.cloths()[0].apply_pending_level();
  load_state(other, save_state(simulation));
  simulation.step();
  other.step();
  EXPECT_EQ(save_state(other), save_state(simulation));
  EXPECT_LT(depth_of_pins(other), 1e-6);
}

}  // namespace
}  // namespace weft
