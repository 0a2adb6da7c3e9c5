// Cloths and nodes on solids within triangles: as on the analytic shapes that these describe, never through.
#include <gtest/gtest.h>

#include <memory>
#include <numbers>
#include <random>

#include "cloth/bodies/collider_description.h"
#include "cloth/contact/recovery/contact.h"
#include "cloth/shapes/triangle_mesh.h"
#include "cloth/world/simulation.h"
#include "cloth/world/state_hash.h"
#include "fixtures.h"
#include "loose_contact.h"
#include "meshes.h"
#include "swept_sheet.h"

namespace weft {
namespace {

using std::numbers::pi;
using test::each_node;
using test::kFrame;
using test::set;

Quaternion turned(const Vec3& axis, double angle) { return Quaternion(Eigen::AngleAxisd(angle, axis)); }

ObstacleDescription mesh_obstacle(const TriangleList& list) {
  ObstacleDescription obstacle;
  obstacle.shape = MeshDescription{.surface = std::make_shared<const TriangleMesh>(list)};
  return obstacle;
}

Solid solid_of(const Shape& shape) {
  Solid solid;
  solid.id = kFirstObstacle;
  solid.shape = shape;
  return solid;
}

template <class Real>
class MeshContact : public ::testing::Test {
 public:
  static constexpr double kRounding = 32 * double(std::numeric_limits<Real>::epsilon());
};
using Scalars = ::testing::Types<float, double>;
TYPED_TEST_SUITE(MeshContact, Scalars);

TYPED_TEST(MeshContact, ANodeShotThroughABoardStopsAtIt) {
  // As ContinuousContact's board of 2 cm, of triangles: a node at 100 m/s keeps its 3 m/s along it.
  const TriangleMesh surface(test::box_mesh({0.5, 0.01, 0.5}));
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(9, 9, {8, 8});
  set(sheet.position, 4, 4, {0.1, 0.5 - 100 * kFrame, 0.2});
  set(sheet.velocity, 4, 4, {3, -100, 0});
  std::vector<Solid> solids{solid_of(Mesh{&surface})};
  test::LooseContact<TypeParam> contact(sheet.grid());
  EXPECT_EQ(contact.resolve(sheet, solids, {0, 1, kFrame}), 1);
  EXPECT_LT((sheet.position_at(4, 4) - Vec3(0.1, 0.01, 0.2)).norm(), this->kRounding);
  EXPECT_LT((sheet.velocity_at(4, 4) - Vec3(3, 0, 0)).norm(), 100 * this->kRounding);
}

TYPED_TEST(MeshContact, NodesShotAtATorusFromEverywhereStayOutside) {
  // Each node's way is a chord of up to 4 m; those of them that meet the torus end at it, on the side they
  // came from: what is before the first entry into it is seen from where they end.
  const TriangleMesh surface(test::torus_mesh(0.5, 0.1, 24, 60));
  const PlacedShape shape{Mesh{&surface}, {0, 0, 0}};
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(65, 65, {2, 2});
  VectorField<TypeParam> start = sheet.position;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(-1, 1);
  each_node(sheet.grid(), [&](int r, int c) {
    Vec3 from(0, 0, 0);
    do from = {place(random), place(random), place(random)};
    while (shape.contains(from));
    set(start, r, c, from);
    set(sheet.position, r, c, {place(random), place(random), place(random)});
  });
  const Particles<TypeParam> aimed = sheet;
  std::vector<Solid> solids{solid_of(Mesh{&surface})};
  solids[0].friction = 1e6;  // nothing slides
  test::LooseContact<TypeParam> contact(sheet.grid());
  each_node(sheet.grid(), [&](int r, int c) {
    const Vec3 way = sheet.position_at(r, c) - test::get(start, r, c);
    set(sheet.velocity, r, c, way / kFrame);
  });
  contact.resolve(sheet, solids, {0, 1, kFrame}, &start);
  int met = 0;
  each_node(sheet.grid(), [&](int r, int c) {
    const Vec3 from = test::get(start, r, c), to = aimed.position_at(r, c), now = sheet.position_at(r, c);
    EXPECT_FALSE(shape.contains(now));
    const auto hit = shape.first_hit(from, to);
    if (!hit) {
      EXPECT_EQ(now, to);
      return;
    }
    ++met;
    EXPECT_LT((now - (from + hit->fraction * (to - from))).norm(), this->kRounding);
  });
  EXPECT_GT(met, 300);
}

TYPED_TEST(MeshContact, ATurningBladeSweepsEveryNodeInItsWay) {
  constexpr double kHalf = 1, kThick = 0.02;
  const TriangleMesh surface(test::box_mesh({kThick, kHalf, 0.02}));
  const int swept = test::expect_swept<TypeParam>(
      {Mesh{&surface}, kThick, 0.95 * kHalf, std::hypot(kHalf, kThick)}, this->kRounding);
  EXPECT_GT(swept, 280);  // of 80/180 pi 0.95^2 / (1.9 / 32)^2 = 357, less the thickness and the middle
}

TYPED_TEST(MeshContact, AThinFinHoldsSlowNodes) {
  // A fin of a tenth of a millimetre, met at 0.1 m/s: 1.7 mm a step, past it at the step's end.
  const TriangleMesh surface(test::box_mesh({0.5, 0.00005, 0.5}));
  Particles<TypeParam> sheet = test::flat_sheet<TypeParam>(9, 9, {8, 8});
  set(sheet.position, 4, 4, {0.1, 0.001 - 0.1 * kFrame, 0.2});
  set(sheet.velocity, 4, 4, {0, -0.1, 0});
  std::vector<Solid> solids{solid_of(Mesh{&surface})};
  test::LooseContact<TypeParam> contact(sheet.grid());
  EXPECT_EQ(contact.resolve(sheet, solids, {0, 1, kFrame}), 1);
  EXPECT_NEAR(sheet.position_at(4, 4).y(), 0.00005, this->kRounding);
}

/// A square of cotton, 1 m, that falls by 5 cm onto something at the origin.
SimulationDescription dropped(const ObstacleDescription& obstacle, double height, int level) {
  SimulationDescription scene;
  ClothDescription cloth;
  cloth.size = {1, 1};
  cloth.position = {0, height, 0};
  cloth.orientation = turned(Vec3::UnitX(), -pi / 2);
  cloth.min_level = cloth.max_level = cloth.initial_level = level;
  scene.cloths = {cloth};
  scene.obstacles = {obstacle};
  scene.effects = {GravityEffect{}, DampingEffect{}};
  return scene;
}

TEST(DrapedMeshSlow, AsOverTheBox) {
  // The same box, of its faces and of triangles, under a cloth that stays on its top: the same way to fall,
  // the same height to rest at.
  ObstacleDescription box = {.shape = BoxDescription{.size = {0.6, 0.4, 0.6}}, .friction = 0.5};
  ObstacleDescription mesh = mesh_obstacle(test::box_mesh({0.3, 0.2, 0.3}));
  mesh.friction = 0.5;
  Simulation<float> over_box(dropped(box, 0.25, 4)), over_mesh(dropped(mesh, 0.25, 4));
  for (int step = 0; step < 600; ++step) {
    over_box.step();
    over_mesh.step();
  }
  const Particles<float>& a = over_box.cloths()[0].particles();
  const Particles<float>& b = over_mesh.cloths()[0].particles();
  double farthest = 0;
  each_node(a.grid(), [&](int r, int c) {
    farthest = std::max(farthest, (a.position_at(r, c) - b.position_at(r, c)).norm());
  });
  EXPECT_LT(farthest, 0.01);  // a hundredth of its size: folds form by chance, where the box is followed less
  EXPECT_NEAR(b.position_at(8, 8).y(), 0.2, 1e-4);
}

TEST(DrapedMeshSlow, OverASphereAsOverTheBallWithinAFacetsHeight) {
  // 5000 triangles whose corners lie on a ball of 0.3 m: their middles are lower by R (1 - cos(a / 2)) = 0.73
  // mm at most, a the angle of their longest sides. The fall's bounce and the folds go their own ways; how
  // high the cloth's middle, held by friction, rests in the end does not, and no node gets inside.
  constexpr double kRadius = 0.3, kClearance = 1e-4;
  const double facet = kRadius * (1 - std::cos(std::hypot(pi / 51, 2 * pi / 50) / 2));
  ObstacleDescription sphere = mesh_obstacle(test::sphere_mesh(kRadius, 51, 50));
  const TriangleMesh& surface = *std::get<MeshDescription>(sphere.shape).surface;
  ASSERT_EQ(surface.list().triangles.size(), 5000u);
  sphere.friction = 1;
  SimulationDescription over_ball = dropped({}, kRadius + 0.05, 5);
  over_ball.obstacles.clear();
  BallDescription ball;
  ball.radius = kRadius;
  ball.friction = 1;
  over_ball.balls = {ball};
  Simulation<float> a(over_ball), b(dropped(sphere, kRadius + 0.05, 5));
  for (int step = 0; step < 600; ++step) {
    a.step();
    b.step();
  }
  const Particles<float>& on_ball = a.cloths()[0].particles();
  const Particles<float>& on_mesh = b.cloths()[0].particles();
  double lowest_on_ball = 1, lowest_on_mesh = 1;  // of the middle's nodes: some may be in a fold
  each_node(on_mesh.grid(), [&](int r, int c) {
    const Vec3 place = on_mesh.position_at(r, c);
    EXPECT_GE(surface.nearest(place).distance, -1e-6);
    EXPECT_GE(place.norm(), kRadius - facet);
    if (std::hypot(r - 16, c - 16) > 2) return;
    lowest_on_ball = std::min(lowest_on_ball, on_ball.position_at(r, c).norm());
    lowest_on_mesh = std::min(lowest_on_mesh, place.norm());
  });
  EXPECT_NEAR(lowest_on_ball, kRadius, kClearance);
  EXPECT_NEAR(lowest_on_mesh, lowest_on_ball, facet + kClearance);
}

TEST(DrapedMeshSlow, SameBitsTwiceAndWhereverElseItIsUsed) {
  const ObstacleDescription torus = mesh_obstacle(test::torus_mesh(0.3, 0.1, 24, 60));
  Simulation<float> a(dropped(torus, 0.15, 5)), b(dropped(torus, 0.15, 5));
  int most = 0;  // it slides off within 80 steps
  for (int step = 0; step < 50; ++step) {
    a.step();
    most = std::max(most, a.last_advance(0).nodes_in_contact);
  }
  for (int step = 0; step < 50; ++step) b.step();
  EXPECT_EQ(state_hash(a), state_hash(b));
  EXPECT_GT(most, 50) << "it lies on the torus";
}

TEST(DrapedMesh, CarriesPinsAndIsMoved) {
  // Pinned to a torus that is moved by 1 m and turned by a quarter about y.
  SimulationDescription scene = dropped(mesh_obstacle(test::torus_mesh(0.3, 0.1, 24, 60)), 0.15, 4);
  PinRegion middle{0.5, 0.5, 0.5, 0.5};
  middle.obstacle = 0;
  scene.cloths[0].pins = {middle};
  Simulation<float> simulation(scene);
  for (int step = 0; step < 30; ++step) simulation.step();
  const Vec3 before = simulation.cloths()[0].particles().position_at(8, 8);
  EXPECT_TRUE(simulation.colliders().obstacles()[0].surface != nullptr);
  simulation.move_obstacle(0, {{1, 0, 0}, turned(Vec3::UnitY(), pi / 2)});
  for (int step = 0; step < 30; ++step) {
    simulation.step();
    ASSERT_TRUE(simulation.healthy());
    const PlacedShape shape = simulation.colliders().solids()[0].placed(1);
    const Particles<float>& particles = simulation.cloths()[0].particles();
    each_node(particles.grid(), [&](int r, int c) {
      if (r != 8 || c != 8) {
        ASSERT_GE(shape.surface(particles.position_at(r, c)).distance, -1e-5);
      }
    });
  }
  const Vec3 carried = Vec3(1, 0, 0) + turned(Vec3::UnitY(), pi / 2) * before;
  EXPECT_LT((simulation.cloths()[0].particles().position_at(8, 8) - carried).norm(), 1e-5);
}

}  // namespace
}  // namespace weft
