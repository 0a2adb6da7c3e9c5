// Obstacles that are bodies: hits, momentum and energy, flying, commands, faults.
#include "cloth/bodies/rigid_body.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>
#include <string_view>

#include "busy_scene.h"
#include "cloth/shapes/mass_properties.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/world/state_hash.h"
#include "meshes.h"

namespace weft {
namespace {

using test::each_node;
using test::run;
using test::set;

// --- One substep's hits ---

constexpr double kBoxMasses[] = {1e-3, 0.03, 1, 30, 1e3};  // kg

/// A box of 1 x 2 x 0.5 m whose upper face is at z = 0, turned about z.
Solid box_of(double mass, const Vec3& velocity, const Vec3& spin) {
  Solid box;
  box.id = kFirstObstacle;
  box.shape = Box{{0.5, 1, 0.25}};
  box.rotation = Eigen::AngleAxisd(0.4, Vec3::UnitZ()).toRotationMatrix();
  box.start = box.position = {0.05, -0.1, -0.2};
  box.inverse_mass = 1 / mass;
  box.inverse_inertia =
      box.rotation * (mass * mass_properties(box.shape).inertia).inverse() * box.rotation.transpose();
  box.velocity = velocity;
  box.spin = spin;
  return box;
}

TEST(YieldingBox, AHitAsideLeavesTheTwoWithOneVelocityThere) {
  // J = u / (1/m + 1/M + (r x n) . I^-1 (r x n)) (Baraff 2001, Eq. 8-18 with no bounce), m = 1 kg, u = 6 m/s.
  for (const double mass : kBoxMasses) {
    // Cells so small that the box meets nodes alone.
    Particles<double> sheet = test::flat_sheet<double>(17, 17, {2, 2});
    const Vec3 place = sheet.position_at(8, 10);  // 0.25 m aside
    each_node(sheet.grid(), [&](int r, int c) { sheet.inverse_mass.at(r, c) = r == 8 && c == 10 ? 1 : 0; });
    set(sheet.velocity, 8, 10, {0, 0, -4});
    const Solid before = box_of(mass, {0, 0, 2}, {0, 0, 0});
    std::vector<Solid> boxes{before};
    Contact<double> contact(sheet.grid());
    ASSERT_EQ(contact.resolve(sheet, boxes, {}), 1);
    const Vec3 arm = place - before.position, lever = arm.cross(Vec3::UnitZ());
    const double impulse = 6 / (1 + 1 / mass + lever.dot(before.inverse_inertia * lever));
    EXPECT_NEAR(sheet.velocity_at(8, 10).z(), -4 + impulse, 1e-13) << mass;
    EXPECT_NEAR(boxes[0].velocity.z(), 2 - impulse / mass, 1e-13) << mass;
    EXPECT_LT((boxes[0].spin + impulse * (before.inverse_inertia * lever)).norm(), 1e-13 * (1 + 1 / mass));
    const Vec3 there = boxes[0].velocity + boxes[0].spin.cross(arm);
    EXPECT_NEAR(there.z(), sheet.velocity_at(8, 10).z(), 1e-12) << mass;
  }
}

TEST(YieldingBox, AHundredHitsKeepBothMomentaAndAddNoEnergy) {
  // Where the nodes were when they were hit: leading them out of the box changes no velocity.
  for (const double mass : kBoxMasses) {
    for (const double friction : {0.0, 0.3, 1e6}) {
      Particles<double> sheet = test::flat_sheet<double>(65, 65, {2, 2});
      test::share_mass(sheet, 1, Discretization::continuum);
      test::randomise(sheet.velocity, -3, 3, 2);
      const Particles<double> before = sheet;
      std::vector<Solid> boxes{box_of(mass, {0, 1, 2}, {1, -2, 0.5})};
      boxes[0].turn = boxes[0].spin / 60;
      boxes[0].friction = friction;
      const Solid box = boxes[0];
      const Eigen::Matrix3d inertia = box.inverse_inertia.inverse();
      const auto energy = [&](const Particles<double>& nodes, const Solid& solid) {
        return kinetic_energy(nodes) + mass * solid.velocity.squaredNorm() / 2 +
               solid.spin.dot(inertia * solid.spin) / 2;
      };
      Contact<double> contact(sheet.grid());
      ASSERT_GT(contact.resolve(sheet, boxes, {}), 100);
      Vec3 impulse(0, 0, 0), turning(0, 0, 0);
      each_node(sheet.grid(), [&](int r, int c) {
        const Vec3 given = sheet.mass.at(r, c) * (sheet.velocity_at(r, c) - before.velocity_at(r, c));
        impulse += given;
        turning += (before.position_at(r, c) - box.position).cross(given);
      });
      EXPECT_GT(turning.norm(), 1e-4);
      EXPECT_LT((impulse + mass * (boxes[0].velocity - box.velocity)).norm(), 1e-12 * (1 + mass)) << mass;
      EXPECT_LT((turning + inertia * (boxes[0].spin - box.spin)).norm(), 1e-12 * (1 + mass)) << mass;
      EXPECT_LT(energy(sheet, boxes[0]), energy(before, box)) << mass;
    }
  }
}

// --- Whole steps ---

ObstacleDescription flying_box(double mass, const Vec3& position, const Vec3& velocity, const Vec3& spin) {
  ObstacleDescription box;
  box.shape = BoxDescription{{0.6, 0.4, 0.3}};
  box.position = position;
  box.body = BodyDescription{mass, true, velocity, spin};
  return box;
}

double energy(const RigidBody& body, const Pose& pose) {
  const Vec3 spin = body.spin(pose.orientation);
  return body.mass() * body.velocity().squaredNorm() / 2 + spin.dot(body.angular_momentum()) / 2;
}

/// A free sheet at rest that a box flies at, without gravity.
SimulationDescription hit_sheet(double mass, const IntegratorDescription& integrator) {
  SimulationDescription scene = test::hung_scene();
  scene.cloths[0].perturbation = 0;
  scene.cloths[0].pins.clear();
  scene.effects.clear();
  scene.integrator = integrator;
  scene.obstacles = {flying_box(mass, {0.1, -0.05, 0.4}, {0, 0, -2}, {1, 2, 3})};
  scene.obstacles[0].friction = 0.3;
  return scene;
}

Vec3 momentum(const Simulation<double>& simulation) {
  const RigidBody& body = *simulation.colliders().obstacles()[0].body;
  Vec3 sum = body.mass() * body.velocity();
  for (const Cloth<double>& cloth : simulation.cloths()) sum += linear_momentum(cloth.particles());
  return sum;
}

Vec3 angular_momentum(const Simulation<double>& simulation) {
  const Obstacle& box = simulation.colliders().obstacles()[0];
  Vec3 sum =
      box.body->angular_momentum() + box.pose.position.cross(Vec3(box.body->mass() * box.body->velocity()));
  for (const Cloth<double>& cloth : simulation.cloths()) {
    const Particles<double>& nodes = cloth.particles();
    each_node(nodes.grid(), [&](int r, int c) {
      sum += nodes.position_at(r, c).cross(Vec3(nodes.mass.at(r, c) * nodes.velocity_at(r, c)));
    });
  }
  return sum;
}

TEST(DynamicBox, ClothAndBoxTogetherKeepTheirMomenta) {
  // An explicit method, so that the linear one is kept to rounding. Nodes that are led out of the box take
  // their momentum along to another place: what that changes of the angular one shrinks with the step.
  double last = 1;
  for (const int substeps : {40, 160}) {
    Simulation<double> simulation(hit_sheet(0.2, SymplecticEulerDescription{substeps}));
    const Vec3 linear = momentum(simulation), angular = angular_momentum(simulation);
    const Vec3 spun = simulation.colliders().obstacles()[0].body->angular_momentum();
    run(simulation, 30);
    EXPECT_LT((momentum(simulation) - linear).norm(), 1e-12);
    const Vec3 given = simulation.colliders().obstacles()[0].body->angular_momentum() - spun;
    const double lost = (angular_momentum(simulation) - angular).norm() / given.norm();
    EXPECT_LT(lost, last);
    last = lost / 2;
    EXPECT_LT(linear_momentum(simulation.cloths()[0].particles()).z(), -0.05);
  }
  EXPECT_LT(last * 2, 0.02);
}

TEST(DynamicBox, AMeshOfItsFacesIsHitAsItIs) {
  // Rays and nearest points of the two differ in the last digits only.
  SimulationDescription scene = hit_sheet(0.2, SymplecticEulerDescription{40});
  Simulation<double> boxes(scene);
  scene.obstacles[0].shape =
      MeshDescription{std::make_shared<const TriangleMesh>(test::box_mesh({0.3, 0.2, 0.15}))};
  Simulation<double> meshes(scene);
  run(boxes, 10);
  run(meshes, 10);
  const Obstacle &box = boxes.colliders().obstacles()[0], &mesh = meshes.colliders().obstacles()[0];
  EXPECT_GT(boxes.report(0).nodes_in_contact, 0);
  EXPECT_LT((box.body->velocity() - mesh.body->velocity()).norm(), 1e-6);
  EXPECT_LT((box.body->angular_momentum() - mesh.body->angular_momentum()).norm(), 1e-6);
  EXPECT_LT((momentum(meshes) - Vec3(0, 0, -0.4)).norm(), 1e-12);
}

TEST(DynamicBox, ThreeSheetsThatShareABoxKeepTheMomentumToo) {
  SimulationDescription scene = hit_sheet(0.2, SymplecticEulerDescription{});
  for (const double behind : {0.0005, 0.001}) {
    scene.cloths.push_back(scene.cloths[0]);
    scene.cloths.back().position.z() -= behind;
  }
  Simulation<double> simulation(scene);
  const Vec3 before = momentum(simulation);
  int most = 0;
  for (int step = 0; step < 30; ++step) {
    simulation.step();
    most = std::max(most, simulation.colliders().obstacles()[0].body->sharing());
  }
  EXPECT_GE(most, 2);
  EXPECT_LT((momentum(simulation) - before).norm(), 1e-12);
}

/// The box flies at the sheet at 2 m/s, and meets it.
void gain_no_energy(const SimulationDescription& scene) {
  Simulation<double> simulation(scene);
  const auto all = [&] {
    const Obstacle& box = simulation.colliders().obstacles()[0];
    const Cloth<double>& cloth = simulation.cloths()[0];
    return energy(*box.body, box.pose) + kinetic_energy(cloth.particles()) +
           cloth.springs().energy(cloth.particles().position);
  };
  // What flying alone sways by, between the spins of two steps' ends, is 1 % of the turning's.
  const RigidBody& body = *simulation.colliders().obstacles()[0].body;
  const double before = all(), sway = 0.01 * (before - body.mass() * 2 * 2 / 2);
  const Vec3 flew = body.velocity();
  int contacts = 0;
  for (int step = 0; step < 120; ++step) {
    simulation.step();
    contacts += simulation.report(0).nodes_in_contact;
    ASSERT_LE(all(), before + sway) << "step " << step;
  }
  EXPECT_GT(contacts, 0);
  EXPECT_NE(body.velocity(), flew);
}

struct Collision {
  const char* name;
  IntegratorDescription integrator;
  double mass;  ///< kg; the sheet's is 0.4
};
std::ostream& operator<<(std::ostream& out, const Collision& collision) { return out << collision.name; }
class SheetAndBox : public ::testing::TestWithParam<Collision> {};

TEST_P(SheetAndBox, GainNoEnergyWhenTheyHit) {
  gain_no_energy(hit_sheet(GetParam().mass, GetParam().integrator));
}

TEST(DynamicBoxSlow, ItsEdgesAndCornersBringInNoEnergy) {
  // They pass nodes on their way, whose own straight ways would cut them.
  for (const IntegratorDescription& integrator :
       {IntegratorDescription(BackwardEulerDescription{}), IntegratorDescription(Bdf2Description{})}) {
    for (int turned = 0; turned < 12; ++turned) {
      SCOPED_TRACE(turned);
      SimulationDescription scene = hit_sheet(0.4, integrator);
      scene.cloths[0].initial_level = 4 + turned % 2;
      scene.obstacles[0].position.z() = 0.45;
      std::get<BoxDescription>(scene.obstacles[0].shape).orientation =
          Eigen::AngleAxisd(0.7 * turned, Vec3(std::cos(turned), std::sin(turned), 0.3).normalized());
      gain_no_energy(scene);
    }
  }
}

const Collision kCollisions[] = {
    {"backward_euler_light", BackwardEulerDescription{}, 0.4e-3},
    {"backward_euler_even", BackwardEulerDescription{}, 0.4},
    {"backward_euler_heavy", BackwardEulerDescription{}, 400},
    {"bdf2_light", Bdf2Description{}, 0.4e-3},
    {"bdf2_even", Bdf2Description{}, 0.4},
    {"bdf2_heavy", Bdf2Description{}, 400},
    {"xpbd_light", XpbdDescription{}, 0.4e-3},
    {"xpbd_even", XpbdDescription{}, 0.4},
    {"xpbd_heavy", XpbdDescription{}, 400},
};
INSTANTIATE_TEST_SUITE_P(Collisions, SheetAndBox, ::testing::ValuesIn(kCollisions),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(DynamicBoxSlow, ComesToRestOnASheet) {
  // Held by its four corners; at rest is what is slower than the speed below which a cloth may sleep.
  for (const IntegratorDescription& integrator :
       {IntegratorDescription(BackwardEulerDescription{}), IntegratorDescription(Bdf2Description{})}) {
    SimulationDescription scene = test::hung_scene();
    scene.cloths[0].perturbation = 0;
    scene.cloths[0].orientation = Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX());
    scene.cloths[0].pins.insert(scene.cloths[0].pins.end(), {{0, 0, 1, 1}, {1, 1, 1, 1}});
    scene.integrator = integrator;
    scene.obstacles = {flying_box(1, {0, 0.22, 0}, {0, 0, 0}, {0, 0, 0})};
    scene.obstacles[0].friction = 0.5;
    Simulation<float> simulation(scene);
    run(simulation, 14 * 60);
    const Obstacle& box = simulation.colliders().obstacles()[0];
    for (int step = 0; step < 60; ++step) {
      simulation.step();
      ASSERT_LT(box.body->velocity().norm(), scene.sleep_speed) << "step " << step;
    }
    EXPECT_GT(simulation.report(0).nodes_in_contact, 0);
    EXPECT_TRUE(box.rest.asleep() && simulation.cloths()[0].asleep()) << "both, in the same step";
  }
}

// --- Commands, resets, faults ---

TEST(DynamicBox, FallsFreely) {
  // Semi-implicit: after n steps -g h^2 n (n + 1) / 2.
  Colliders colliders({}, {flying_box(2, {0, 0, 0}, {1, 0, 0}, {0, 0, 0})});
  for (int step = 0; step < 60; ++step) {
    colliders.begin_step(step / 60.0, 1.0 / 60, standard_gravity());
    colliders.end_step();
  }
  const Obstacle& box = colliders.obstacles()[0];
  EXPECT_LT((box.pose.position - Vec3(1, -9.81 * 61 / 120, 0)).norm(), 1e-12);
  EXPECT_LT((box.body->velocity() - Vec3(1, -9.81, 0)).norm(), 1e-12);
  EXPECT_TRUE(box.pose.orientation.isApprox(Quaternion::Identity(), 1e-15));
}

TEST(DynamicBox, IsHeldThrownAndReset) {
  SimulationDescription scene = test::hung_scene();
  scene.obstacles = {flying_box(1, {0, 0, 3}, {0, 0, 0}, {0, 4, 0})};
  Simulation<float> simulation(scene);
  const Obstacle& box = simulation.colliders().obstacles()[0];
  run(simulation, 10);
  const std::uint64_t ten = state_hash(simulation);
  EXPECT_TRUE(box.mobile);
  EXPECT_TRUE(simulation.move_obstacle(0, {{0, 1, 3}, Quaternion::Identity()}));
  run(simulation, 5);
  EXPECT_FALSE(box.flies());
  EXPECT_EQ(box.pose.position, Vec3(0, 1, 3));
  EXPECT_TRUE(box.solid.spin.isZero(0));
  EXPECT_FALSE(box.solid.yields());
  EXPECT_TRUE(simulation.throw_obstacle(0, {0, 5, 0}, {3, 0, 0}));
  run(simulation, 1);
  EXPECT_TRUE(simulation.colliders().solids()[0].yields());
  EXPECT_GT(box.pose.position.y(), 1.05);
  EXPECT_LT((box.solid.spin - Vec3(3, 0, 0)).norm(), 1e-12);
  simulation.reset();
  run(simulation, 10);
  EXPECT_EQ(state_hash(simulation), ten);
}

TEST(DynamicBox, TheHashSeesItsTurnAndItsSpin) {
  const auto hash = [](const Vec3& spin, int steps) {
    SimulationDescription scene = test::hung_scene();
    scene.obstacles = {flying_box(1, {0, 0, 3}, {0, 0, 0}, spin)};
    Simulation<float> simulation(scene);
    run(simulation, steps);
    return state_hash(simulation);
  };
  EXPECT_NE(hash({0, 4, 0}, 0), hash({0, 4.0000001, 0}, 0));
  EXPECT_EQ(hash({0, 4, 0}, 7), hash({0, 4, 0}, 7));
}

TEST(DynamicBox, OnlyBodiesAreThrown) {
  ObstacleDescription wall = flying_box(1, {0, 0, 0}, {0, 0, 0}, {0, 0, 0});
  wall.body.reset();
  Colliders colliders({}, {wall});
  EXPECT_FALSE(colliders.throw_obstacle(0, {0, 0, 1}, {0, 0, 0}));
  EXPECT_FALSE(colliders.throw_obstacle(1, {0, 0, 1}, {0, 0, 0}));
}

TEST(DynamicBox, TurnsByHalfATurnAStepAtMost) {
  Colliders colliders({}, {flying_box(1, {0, 0, 0}, {0, 0, 0}, {0, 0, 1e6})});
  colliders.begin_step(0, 1.0 / 60, {0, 0, 0});
  EXPECT_NEAR(colliders.solids()[0].spin.z(), 60 * std::numbers::pi, 1e-9);
  colliders.end_step();
  EXPECT_LT(colliders.obstacles()[0].body->spin(Quaternion::Identity()).norm(), 60 * std::numbers::pi + 1e-9);
}

TEST(DynamicBox, ThatIsNowhereIsPutBack) {
  for (const Vec3& velocity : {Vec3(0, 1e308, 0), Vec3(std::nan(""), 0, 0)}) {
    SimulationDescription scene = test::hung_scene();
    scene.obstacles = {flying_box(1, {0, 0, 3}, {0, 0, 0}, {0, 0, 0})};
    scene.effects.clear();
    Simulation<float> simulation(scene);
    run(simulation, 3);
    simulation.throw_obstacle(0, velocity, {0, 0, 0});
    simulation.step();
    ASSERT_EQ(simulation.guard_events().size(), 1U);
    const GuardEvent& event = simulation.guard_events()[0];
    EXPECT_EQ(event.action, GuardEvent::Action::ball_stopped);
    EXPECT_EQ(describe(event, ""),
              "obstacle 0: step 4 gave a position or velocity that is not finite: put back "
              "to its last good place, at rest");
    run(simulation, 3);
    EXPECT_EQ(simulation.colliders().obstacles()[0].pose.position, Vec3(0, 0, 3));
    EXPECT_TRUE(simulation.guard_events().empty());
  }
}

}  // namespace
}  // namespace weft
