// Cloths far from the origin, whose positions are kept relative to a place of their own: what comes to them
// from the world reaches them there as it would at the origin.
#include "cloth/core/place.h"

#include <functional>

#include "bodies.h"
#include "cloth/air/node_air.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/world/simulation.h"
#include "cloth/world/state_hash.h"
#include "faults.h"
#include "fixtures.h"

namespace weft::test {
namespace {

using Scene = SimulationDescription;

/// 10 km from the origin, a multiple of the places' grid: local positions begin with the same bits.
const Vec3 kFar(10000, -400, 8000);

ClothDescription sheet(const Vec3& position, std::vector<PinRegion> pins = {}) {
  ClothDescription cloth;
  cloth.size = {1, 1};
  cloth.position = position;
  cloth.min_level = 2;
  cloth.max_level = 4;
  cloth.initial_level = 3;
  cloth.material = {0.2, 500, 50, 0.01, 0.1};
  cloth.pins = std::move(pins);
  return cloth;
}

Scene hung(const Vec3& at) {
  Scene scene;
  scene.cloths = {sheet(at, {{0, 0, 0, 0}, {1, 1, 0, 0}})};
  scene.effects = {GravityEffect{}, DampingEffect{}, AerodynamicsEffect{}};
  return scene;
}

/// Lying face up.
Scene lying(const Vec3& at, std::vector<PinRegion> pins = {}) {
  Scene scene = hung(at);
  scene.cloths = {sheet(at, std::move(pins))};
  scene.cloths[0].orientation = Quaternion(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  return scene;
}

using Act = std::function<void(Simulation<float>&, const Vec3& at, int step)>;
const Act kNothing = [](Simulation<float>&, const Vec3&, int) {};

/// The farthest that a node, a ball or a body is from where it is in the same scene at the origin, m, after
/// so many steps before each of which `act` has acted.
double stray(const std::function<Scene(const Vec3&)>& scene, int steps, const Act& act = kNothing) {
  Simulation<float> near(scene({0, 0, 0})), far(scene(kFar));
  for (int step = 0; step < steps; ++step) {
    act(near, {0, 0, 0}, step);
    act(far, kFar, step);
    near.step();
    far.step();
  }
  double most = 0;
  for (std::size_t i = 0; i < near.cloths().size(); ++i) {
    const Particles<float>&a = near.cloths()[i].particles(), &b = far.cloths()[i].particles();
    EXPECT_EQ(a.grid(), b.grid());
    EXPECT_LT(b.local_position_at(0, 0).norm(), 4 * kPlaceGrid);
    each_node(a.grid(), [&](int r, int c) {
      most = std::max(most, (b.place - kFar + b.local_position_at(r, c) - a.position_at(r, c)).norm());
    });
  }
  const auto differ = [&](const Vec3& a, const Vec3& b) { most = std::max(most, (b - kFar - a).norm()); };
  for (std::size_t i = 0; i < near.colliders().balls().size(); ++i)
    differ(near.colliders().balls()[i].position, far.colliders().balls()[i].position);
  for (std::size_t i = 0; i < near.colliders().obstacles().size(); ++i)
    differ(near.colliders().obstacles()[i].pose.position, far.colliders().obstacles()[i].pose.position);
  return most;
}

/// What the world's places lose in double precision, 2e-12 m at 10 km, grows as motion does; a float has
/// 1e-3 m there.
constexpr double kTolerance = 1e-5;

}  // namespace

TEST(Place, IsAMultipleOfTheGridNextToAPoint) {
  EXPECT_EQ(place_near({1.9, -1.9, 0}), Vec3(0, 0, 0));
  EXPECT_EQ(place_near({2.1, -2.1, 9999}), Vec3(4, -4, 10000));
  EXPECT_EQ(place_near({kNaN<double>, INFINITY, 5}), Vec3(0, 0, 4));
}

TEST(Place, IsChosenByWhereTheClothBegins) {
  const Simulation<float> flat(hung({201, 0, -1}));
  const Particles<float>& particles = flat.cloths()[0].particles();
  EXPECT_EQ(particles.place, Vec3(200, 0, 0));
  EXPECT_EQ(particles.position_at(0, 0), Vec3(200.5, 0.5, -1));
  EXPECT_LT((flat.centre(0) - Vec3(201, 0, -1)).norm(), 1e-6);

  Scene scene = hung({0, 0, 0});
  const int nodes = scene.cloths[0].base_cells.at(3).nodes();
  for (int i = 0; i < nodes; ++i) scene.cloths[0].nodes.emplace_back(5000 + 0.1 * (i % 9), 0.1 * (i / 9), 0);
  const Simulation<float> given(scene);
  EXPECT_EQ(given.cloths()[0].particles().place, Vec3(5000, 0, 0));
  EXPECT_LT((given.cloths()[0].particles().position_at(8, 8) - Vec3(5000.8, 0.8, 0)).norm(), 1e-6);
}

// Nothing in the step knows where it is: bit for bit the same, through a change of level, too.
TEST(Place, AHungClothMovesAsAtTheOrigin) {
  for (const IntegratorDescription& integrator : default_integrators()) {
    const auto scene = [&](const Vec3& at) {
      Scene made = hung(at);
      made.integrator = integrator;
      return made;
    };
    const auto change_level = [](Simulation<float>& simulation, const Vec3&, int step) {
      if (step % 20 == 10) simulation.request_level(0, step % 40 == 10 ? 4 : 2);
    };
    EXPECT_EQ(stray(scene, 60, change_level), 0) << name_of(integrator);
  }
}

TEST(Place, HandsAndPinsReachIt) {
  const auto pull = [](Simulation<float>& simulation, const Vec3& at, int step) {
    if (step == 5) simulation.grab(0, {0.5, 0.9}, at + Vec3(0.1, -0.4, 0.5), 50);
    if (step == 20) simulation.move_grab(1, at + Vec3(-0.2, -0.2, 0.6));
    if (step == 30) simulation.pin(0, {0.5, 0.5});
    if (step == 40) simulation.release(1);
  };
  EXPECT_LT(stray(hung, 60, pull), kTolerance);
  // Held where it is: a hand that is told no place.
  Simulation<float> far(hung(kFar));
  far.grab(0, {0.5, 0.5}, {}, 50);
  EXPECT_LT((far.cloths()[0].grabs()[0].hand - kFar).norm(), 1e-6);
}

TEST(Place, MovingPinsCarryIt) {
  const auto scene = [](const Vec3& at) {
    Scene made = hung(at);
    made.cloths[0].pins[0].path = {{0, {0, 0, 0}}, {0.5, {0.2, 0.1, -0.3}}, {1, {0, 0, 0}}};
    made.cloths[0].pins[1].obstacle = 0;
    ObstacleDescription rail;
    rail.shape = BoxDescription{{0.1, 0.1, 0.1}};
    rail.path = {{0, {at + Vec3(0.5, 0.6, 0)}},
                 {1, {at + Vec3(0.3, 0.7, 0.2), Quaternion(Eigen::AngleAxisd(0.4, Vec3::UnitX()))}}};
    made.obstacles = {rail};
    return made;
  };
  EXPECT_LT(stray(scene, 70), kTolerance);
}

/// Solves so finely that one iteration more, after a rounding that fell the other way, moves nothing.
IntegratorDescription solving_finely(IntegratorDescription integrator) {
  std::visit(
      [](auto& each) {
        if constexpr (requires { each.tolerance; }) each.tolerance = 1e-6;
      },
      integrator);
  return integrator;
}

TEST(Place, BallsAndBodiesMeetIt) {
  for (const IntegratorDescription& each : default_integrators()) {
    const IntegratorDescription integrator = solving_finely(each);
    const auto scene = [&](const Vec3& at) {
      Scene made = lying(at, {{0, 1, 0, 0}, {0, 1, 1, 1}});
      made.integrator = integrator;
      BallDescription ball;
      ball.position = at + Vec3(0.25, 0.16, 0.02);
      ball.radius = 0.15;
      ball.mass = 0.3;
      ball.motion = BallDescription::Motion::dynamic;
      made.balls = {ball};
      ObstacleDescription box;
      box.shape = BoxDescription{{0.2, 0.2, 0.2}};
      box.position = at + Vec3(-0.2, 0.12, 0.03);
      box.body = BodyDescription{.mass = 0.4};
      made.obstacles = {box};
      return made;
    };
    EXPECT_LT(stray(scene, 30), kTolerance) << name_of(integrator);
  }
}

// Solids are in double: a pile of boxes, a capsule and a ball come to rest on a floor.
TEST(Place, BodiesRestAmongThemselves) {
  const auto pile = [](const Vec3& at) {
    const auto body = [&](const auto& shape, const Vec3& position) {
      ObstacleDescription made;
      made.shape = shape;
      made.position = at + position;
      made.friction = 0.5;
      made.body = BodyDescription{};
      return made;
    };
    ObstacleDescription floor;
    floor.shape = PlaneDescription{};
    floor.position = at;
    floor.friction = 0.5;
    BallDescription ball = flying_ball(at + Vec3(1, 0.25, 0), 0.2, {0, 0, 0}, 0.5);
    const Quaternion lies(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitX()));
    return Bodies({ball}, {floor, body(BoxDescription{{0.4, 0.4, 0.4}}, {0, 0.21, 0}),
                           body(BoxDescription{{0.3, 0.3, 0.3}}, {0.05, 0.6, 0.02}),
                           body(CapsuleDescription{0.1, 0.5, lies}, {-1, 0.15, 0})});
  };
  Bodies near = pile({0, 0, 0}), far = pile(kFar);
  near.run(4);
  far.run(4);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_LT(far.obstacle(i).body->velocity().norm(), 1e-4) << i;
    EXPECT_LT((far.obstacle(i).pose.position - kFar - near.obstacle(i).pose.position).norm(), kTolerance)
        << i;
  }
  EXPECT_LT(far.ball(0).velocity.norm(), 1e-4);
}

TEST(Place, ABodyPutOntoItIsLetOut) {
  const auto put = [](Simulation<float>& simulation, const Vec3& at, int step) {
    BallDescription ball;
    ball.position = at + Vec3(0, 0, 0.02);
    ball.radius = 0.2;
    if (step == 3) simulation.add_ball(ball);
  };
  EXPECT_LT(stray(hung, 20, put), kTolerance);
}

TEST(Place, WindZonesBlowWhereTheyAre) {
  const auto scene = [](const Vec3& at) {
    Scene made = hung(at);
    made.wind.zones = {{SphereZone{0.3}, at + Vec3(0.2, 0, 0), {0, 0, 4}, 0.2}};
    return made;
  };
  EXPECT_LT(stray(scene, 40), kTolerance);
  Simulation<float> still(hung(kFar)), blown(scene(kFar));
  for (int step = 0; step < 40; ++step) still.step(), blown.step();
  EXPECT_GT((blown.centre(0) - still.centre(0)).norm(), 0.01);
}

// The same point of the world, from two places.
TEST(Place, EddiesAreAFunctionOfTheWorld) {
  Wind wind;
  wind.speed = 2;
  wind.turbulence = {0.3, 0.5};
  const Air air(wind, 7);
  const auto velocity = [&](const Vec3& place, const Vec3& local) {
    const Eigen::Vector3f at = local.cast<float>();
    Eigen::Vector3f found(0, 0, 0);
    air.add_eddies(0.3, place, {&at.x(), &at.y(), &at.z()}, 1, {&found.x(), &found.y(), &found.z()});
    return found;
  };
  for (const double far : {0.0, 1000.0}) {
    const Vec3 place(far, 4, -8);
    const auto one = velocity(place, {1.5, 0.25, 0}),
               other = velocity(place + Vec3(4, -4, 0), {-2.5, 4.25, 0});
    EXPECT_GT(one.norm(), 0.01F);
    EXPECT_LT((one - other).norm(), 2e-5F);  // of phases of some turns in float
  }
  EXPECT_GT((velocity({0, 0, 0}, {1, 0, 0}) - velocity({4, 0, 0}, {1, 0, 0})).norm(), 0.01F);
}

// Their places differ: one at 0, the other at 4 m.
TEST(PlaceSlow, ClothsOfDifferentPlacesMeet) {
  const auto scene = [](double x) {
    Scene made = lying({x, 0, 0}, {{0, 0, 0, 1}, {1, 1, 0, 1}});
    ClothDescription upper = sheet({x + 0.2, 0.03, 0.05});
    upper.orientation = made.cloths[0].orientation;
    made.cloths.push_back(upper);
    made.effects.emplace_back(ClothContactEffect{0.01, 0.3});
    return made;
  };
  for (const IntegratorDescription& integrator : default_integrators()) {
    Scene apart = scene(1.9), together = scene(1);
    apart.integrator = together.integrator = integrator;
    Simulation<float> one(apart), other(together);
    EXPECT_EQ(one.cloths()[0].particles().place, Vec3(0, 0, 0));
    EXPECT_EQ(one.cloths()[1].particles().place, Vec3(4, 0, 0));
    for (int step = 0; step < 30; ++step) one.step(), other.step();
    EXPECT_LT((one.centre(1) - other.centre(1) - Vec3(0.9, 0, 0)).norm(), 2e-3) << name_of(integrator);
    EXPECT_GT(one.centre(1).y(), -0.2) << name_of(integrator);  // without the lower one it had fallen 1.2 m
  }
}

TEST(Place, FollowsAClothThatFalls) {
  for (const IntegratorDescription& integrator : default_integrators()) {
    Scene scene = lying({0, 0, 0});
    scene.effects = {GravityEffect{}};
    scene.integrator = integrator;
    scene.sleep_speed = 0;
    Simulation<float> single(scene);
    Simulation<double> exact(scene);
    Vec3 before = single.centre(0);
    for (int step = 0; step < 240; ++step) {
      single.step();
      exact.step();
      const Vec3 now = single.centre(0);
      EXPECT_LT((now - before).norm(), 9.81 * 4 / 60 + 0.01);  // it never jumps
      before = now;
    }
    const Particles<float>& particles = single.cloths()[0].particles();
    EXPECT_LT(before.y(), -70) << name_of(integrator);
    EXPECT_LT(particles.local_position_at(4, 4).cwiseAbs().maxCoeff(), 3 * kPlaceGrid);
    // Of 8 m from the place, half a digit a step and node; a float has 4e-6 m at 70 m.
    EXPECT_LT((before - exact.centre(0)).norm(), 1e-3) << name_of(integrator);
  }
}

TEST(Place, MovingItLeavesTheNodesWhereTheyAre) {
  Particles<float> cloth = flat_sheet<float>(5, 5, {1, 1});
  EXPECT_FALSE(follow(cloth));
  each_node(cloth.grid(),
            [&](int r, int c) { set(cloth.position, r, c, get(cloth.position, r, c) + Vec3(0, -37.25, 0)); });
  const Particles<float> before = cloth;
  EXPECT_TRUE(follow(cloth));
  EXPECT_EQ(cloth.place, Vec3(0, -36, 0));
  each_node(cloth.grid(),
            [&](int r, int c) { EXPECT_EQ(cloth.position_at(r, c), before.position_at(r, c)); });
  EXPECT_FALSE(follow(cloth));
  // As long as something stays it does: a piece may fall off.
  set(cloth.position, 4, 4, {0, -100, 0});
  EXPECT_FALSE(follow(cloth));
}

TEST(Place, AStepThatFailsGoesBackToTheWorldsPlaces) {
  Scene scene = lying({0, 0, 0});
  scene.effects = {GravityEffect{}};
  scene.integrator = SymplecticEulerDescription{};
  scene.sleep_speed = 0;
  Simulation<float> simulation(scene);
  int asked = 0;
  add_fault<float>(simulation.cloths()[0], [&](double time, VectorField<float>& force) {
    if (time > 1.99 && asked++ < 2) force.x.fill(kNaN<float>);
  });
  int places = 0, redone = 0;
  Vec3 place = simulation.cloths()[0].particles().place, before = simulation.centre(0);
  for (int step = 0; step < 130; ++step) {
    simulation.step();
    redone += static_cast<int>(simulation.guard_events().size());
    const Vec3 now = simulation.centre(0);
    EXPECT_LT((now - before).norm(), 0.5);
    before = now;
    places += simulation.cloths()[0].particles().place != place;
    place = simulation.cloths()[0].particles().place;
  }
  EXPECT_GT(places, 2);
  EXPECT_GT(redone, 0);
}

TEST(Place, GoesWithACopyOfTheState) {
  Scene scene = lying({0, 0, 0});
  scene.effects = {GravityEffect{}};
  Simulation<float> falls(scene), copy(scene);
  for (int step = 0; step < 100; ++step) falls.step();
  EXPECT_NE(falls.cloths()[0].particles().place, Vec3(0, 0, 0));
  copy.take_state(falls);
  EXPECT_EQ(state_hash(copy), state_hash(falls));
  for (int step = 0; step < 50; ++step) falls.step(), copy.step();
  EXPECT_EQ(state_hash(copy), state_hash(falls));
  EXPECT_NE(state_hash(Simulation<float>(hung({0, 0, 0}))), state_hash(Simulation<float>(hung({4, 0, 0}))));
}

// -m g . r of its centre, and its bounding sphere's, in the world.
TEST(Place, FiguresAreOfTheWorld) {
  const Simulation<float> far(hung(kFar));
  const Particles<float>& particles = far.cloths()[0].particles();
  EXPECT_NEAR(gravitational_energy(particles, {0, -9.81, 0}), 0.2 * 9.81 * kFar.y(), 1e-3);
  EXPECT_LT((bounding_sphere(particles).centre - kFar).norm(), 1e-6);
  EXPECT_NEAR(bounding_sphere(particles).radius, std::sqrt(0.5), 1e-6);
}

}  // namespace weft::test
