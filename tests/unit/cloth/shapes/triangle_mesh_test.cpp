// Solids within closed surfaces of triangles: distances and sides against FCL, the crossings of rays and
// figures by hand; ways in and out; surfaces that enclose nothing are refused.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>

#include "cloth/shapes/shape.h"
#include "cloth/shapes/triangle_mesh.h"
#include "meshes.h"

namespace weft {
namespace {

constexpr double kRounding = 1e-13;  // coordinates are about 1 m

using test::box_mesh, test::sphere_mesh, test::torus_mesh;

/// A torus, lumpy and with ridges in which points are nearest to edges and corners.
TriangleList knobbly_torus() {
  TriangleList torus = torus_mesh(1, 0.35, 36, 70);  // 5040 triangles
  for (Vec3& v : torus.vertices)
    v += 0.1 * Vec3(std::sin(9 * v.z()), std::cos(7 * v.x()), std::sin(8 * v.y()));
  return torus;
}

/// A tetrahedron with three edges along the axes, 1 m each.
TriangleList corner_tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

constexpr double kBall = 1e-3;

/// FCL's distance to the surface, m: of a ball whose size is taken off.
class Oracle {
 public:
  explicit Oracle(const TriangleList& list) : list_(list) {
    model_->beginModel();
    for (const auto& [a, b, c] : list.triangles) model_->addTriangle(corner(a), corner(b), corner(c));
    model_->endModel();
  }
  double distance(const Vec3& point) const {
    const fcl::CollisionObjectd surface(model_);
    const fcl::CollisionObjectd ball(std::make_shared<fcl::Sphered>(kBall), Eigen::Matrix3d::Identity(),
                                     point);
    fcl::DistanceResultd result;
    return fcl::distance(&surface, &ball, fcl::DistanceRequestd(), result) + kBall;
  }
  /// By the number of triangles that a ray crosses (Moeller and Trumbore 1997), odd inside.
  bool inside(const Vec3& point, const Vec3& direction) const {
    int crossings = 0;
    for (const auto& [ia, ib, ic] : list_.triangles) {
      const Vec3 a = corner(ia), e1 = corner(ib) - a, e2 = corner(ic) - a;
      const Vec3 p = direction.cross(e2), t = point - a, q = t.cross(e1);
      const double det = e1.dot(p), u = t.dot(p) / det, v = direction.dot(q) / det;
      if (u >= 0 && v >= 0 && u + v <= 1 && e2.dot(q) / det > 0) ++crossings;
    }
    return crossings % 2 == 1;
  }

 private:
  Vec3 corner(int i) const { return list_.vertices[static_cast<std::size_t>(i)]; }
  TriangleList list_;
  std::shared_ptr<fcl::BVHModel<fcl::OBBRSSd>> model_ = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
};

class Points {
 public:
  explicit Points(double reach) : place_(-reach, reach) {}
  Vec3 next() { return {place_(random_), place_(random_), place_(random_)}; }

 private:
  std::mt19937_64 random_{1};
  std::uniform_real_distribution<double> place_;
};

TEST(TriangleMesh, DistancesAreFclsAndSidesThoseOfRaysSlow) {
  const TriangleList list = knobbly_torus();
  const TriangleMesh mesh(list);
  const Oracle oracle(list);
  Points points(1.6);
  int inside = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Vec3 point = points.next();
    const TriangleMesh::Nearest nearest = mesh.nearest(point);
    const double distance = oracle.distance(point);
    // Nearer than its radius FCL's ball touches the surface, and it says no more than that.
    if (distance > kBall) {
      EXPECT_NEAR(std::abs(nearest.distance), distance, 1e-9) << point.transpose();
    }
    const bool in = oracle.inside(point, Vec3(0.36, 0.48, 0.8));
    EXPECT_EQ(nearest.distance < 0, in) << point.transpose();
    EXPECT_EQ(mesh.contains(point), in) << point.transpose();
    EXPECT_TRUE(mesh.may_touch(point, distance + 1e-9)) << point.transpose();
    EXPECT_NEAR(nearest.normal.norm(), 1, kRounding);
    // The point of the surface is one.
    EXPECT_NEAR(mesh.nearest(point - nearest.distance * nearest.normal).distance, 0, kRounding);
    if (in) ++inside;
  }
  EXPECT_GT(inside, 200);  // of a smooth torus 2 pi^2 1 0.35^2 / 3.2^3 = 7.4 %: 221
}

TEST(TriangleMesh, PointsFarFromTheSurfaceHaveADistanceToo) {
  const TriangleList list = knobbly_torus();
  const TriangleMesh mesh(list);
  const Oracle oracle(list);
  Points points(40);
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 point = points.next();
    EXPECT_NEAR(mesh.nearest(point).distance, oracle.distance(point), 1e-9);
    EXPECT_FALSE(mesh.may_touch(point, 1) && oracle.distance(point) > 5) << point.transpose();
  }
}

TEST(TriangleMesh, SidesBesideEdgesAndCornersSlow) {
  // Straight out of each vertex and edge of a lumpy torus, and in: the face normals there disagree on the
  // side.
  const TriangleList list = knobbly_torus();
  const TriangleMesh mesh(list);
  const Oracle oracle(list);
  Points points(1);
  for (std::size_t v = 0; v < list.vertices.size(); ++v) {
    const Vec3 point = list.vertices[v] + 1e-4 * points.next();
    EXPECT_EQ(mesh.contains(point), oracle.inside(point, Vec3(0.36, 0.48, 0.8))) << v;
  }
}

// Its cells hold triangles of both sides, which face away from each other.
TEST(TriangleMesh, SidesOfAThinLensKnownToBeConvexSlow) {
  TriangleList lens = sphere_mesh(1, 20, 40);
  for (Vec3& v : lens.vertices) v.y() *= 0.03;
  const Oracle oracle(lens);
  const TriangleMesh unknown(lens);
  lens.convex = true;
  const TriangleMesh known(lens);
  Points points(1.02);
  int inside = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    Vec3 point = points.next();
    point.y() *= 0.05;
    const bool in = oracle.inside(point, Vec3(0.36, 0.48, 0.8));
    EXPECT_EQ(known.contains(point), in) << point.transpose();
    EXPECT_EQ(unknown.contains(point), in) << point.transpose();
    if (in) ++inside;
  }
  EXPECT_NEAR(inside / 5000.0, 4 * M_PI / 3 * 0.03 / (8 * 1.02 * 1.02 * 1.02 * 0.05), 0.02);  // 30 %
}

TEST(TriangleMesh, OfATetrahedron) {
  const TriangleMesh mesh(corner_tetrahedron());
  // (0.1, 0.1, 0.1) is 0.1 m from three faces and (1 - 0.3) / sqrt 3 from the slanted one.
  EXPECT_NEAR(mesh.nearest({0.1, 0.1, 0.05}).distance, -0.05, kRounding);
  EXPECT_LT((mesh.nearest({0.1, 0.1, 0.05}).normal - Vec3(0, 0, -1)).norm(), kRounding);
  const TriangleMesh::Nearest slanted = mesh.nearest({1, 1, 1});  // (3 - 1) / sqrt 3
  EXPECT_NEAR(slanted.distance, 2 / std::sqrt(3.0), kRounding);
  EXPECT_LT((slanted.normal - Vec3(1, 1, 1) / std::sqrt(3.0)).norm(), kRounding);
  const TriangleMesh::Nearest edge = mesh.nearest({0.5, -0.3, -0.4});  // from the edge along x
  EXPECT_NEAR(edge.distance, 0.5, kRounding);
  EXPECT_LT((edge.normal - Vec3(0, -0.6, -0.8)).norm(), kRounding);
  const TriangleMesh::Nearest corner = mesh.nearest({-0.2, -0.3, -0.6});
  EXPECT_NEAR(corner.distance, 0.7, kRounding);
  EXPECT_LT((corner.normal - Vec3(-2, -3, -6) / 7).norm(), kRounding);
  const TriangleMesh::Nearest on = mesh.nearest({0, 0, 0});  // a corner: the angles there are 90 degrees each
  EXPECT_EQ(on.distance, 0);
  EXPECT_LT((on.normal + Vec3(1, 1, 1) / std::sqrt(3.0)).norm(), kRounding);
}

TEST(TriangleMesh, OfABoxIsTheBox) {
  const Vec3 half(0.4, 0.8, 1.3);
  const TriangleMesh surface(box_mesh(half));
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 2) / 3).toRotationMatrix();
  const PlacedShape mesh{Mesh{&surface}, {0.1, 0.2, -0.3}, turn}, box{Box{half}, {0.1, 0.2, -0.3}, turn};
  Points points(2);
  int entries = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Vec3 from = points.next(), to = points.next();
    const Surface expected = box.surface(from), found = mesh.surface(from);
    EXPECT_NEAR(found.distance, expected.distance, kRounding);
    EXPECT_LT((found.normal - expected.normal).norm(), 1e-9);
    EXPECT_EQ(mesh.contains(from), box.contains(from));
    if (box.contains(from)) {
      EXPECT_NEAR(mesh.way_out(from, (to - from).normalized()), box.way_out(from, (to - from).normalized()),
                  1e-12);
      continue;
    }
    const auto hit = box.first_hit(from, to), entry = mesh.first_hit(from, to);
    ASSERT_EQ(hit.has_value(), entry.has_value());
    if (!hit) continue;
    ++entries;
    EXPECT_NEAR(entry->fraction, hit->fraction, 1e-12);
    EXPECT_LT((entry->normal - hit->normal).norm(), 1e-12);
  }
  EXPECT_GT(entries, 200);
  EXPECT_LT((mesh.bounds().min() - box.bounds().min()).norm(), kRounding);
  EXPECT_LT((mesh.bounds().max() - box.bounds().max()).norm(), kRounding);
}

TEST(TriangleMesh, NoWayPassesUnseen) {
  // Every way between two points outside whose middle is inside, short or long, into the knobbly torus, with
  // many aimed right at its corners and along its edges.
  const TriangleList list = knobbly_torus();
  const TriangleMesh mesh(list);
  Points points(1.6);
  std::mt19937_64 random(2);
  std::uniform_int_distribution<std::size_t> any(0, list.triangles.size() - 1);
  int entries = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const auto [a, b, c] = list.triangles[any(random)];
    const auto vertex = [&](int i) { return list.vertices[static_cast<std::size_t>(i)]; };
    const Vec3 corner = vertex(a), edge = (vertex(a) + vertex(b)) / 2;
    const Vec3 aim = trial % 3 == 0 ? corner : trial % 3 == 1 ? edge : points.next();
    const Vec3 from = points.next();
    if (mesh.contains(from)) continue;
    const Vec3 to = aim + 0.5 * (aim - from).normalized() * (trial % 2);
    const auto entry = mesh.first_entry(from, to - from);
    const double until = entry ? entry->fraction : 1.0;
    for (int i = 1; i < 40; ++i) {  // nothing of the way so far is inside
      const Vec3 place = from + until * i / 40 * (to - from);
      EXPECT_FALSE(mesh.contains(place) && mesh.nearest(place).distance < -kRounding) << trial;
    }
    if (!entry) {
      EXPECT_FALSE(mesh.contains(to) && mesh.nearest(to).distance < -kRounding) << trial;
      continue;
    }
    ++entries;
    EXPECT_NEAR(mesh.nearest(from + entry->fraction * (to - from)).distance, 0, kRounding);
    EXPECT_LE(entry->normal.dot(to - from), 0);
  }
  EXPECT_GT(entries, 8000);
}

TEST(TriangleMesh, AWayFromTheSurfaceIsNoEntry) {
  const TriangleMesh mesh(box_mesh({1, 1, 1}));
  EXPECT_FALSE(mesh.first_entry({0.3, 1, 0.2}, {0, 1, 0}));
  EXPECT_FALSE(mesh.first_entry({0.3, 1, 0.2}, {1, 0, 0}));  // along it
  EXPECT_FALSE(mesh.first_entry({0.3, 1.5, 0.2}, {0, 0, 0}));
  const auto entry = mesh.first_entry({0.3, 1, 0.2}, {0, -1, 0});
  ASSERT_TRUE(entry);
  EXPECT_EQ(entry->fraction, 0);
  EXPECT_LT((entry->normal - Vec3(0, 1, 0)).norm(), kRounding);
}

TEST(TriangleMesh, InnerRadiusIsHalfItsWidth) {
  EXPECT_NEAR(TriangleMesh(box_mesh({0.5, 0.2, 0.7})).inner_radius(), 0.2, 1e-9);
  // Facets of the sphere lie at most R (1 - cos(a / 2)) below it, a the angle of their longest sides.
  const double facet = 1 - std::cos(std::hypot(std::numbers::pi / 20, 2 * std::numbers::pi / 40) / 2);
  EXPECT_NEAR(TriangleMesh(sphere_mesh(1, 20, 40)).inner_radius(), 1 - facet, facet);
}

TEST(TriangleMesh, AHoleIsOutside) {
  const TriangleMesh mesh(torus_mesh(1, 0.35, 36, 70));
  EXPECT_FALSE(mesh.contains({0, 0, 0}));
  EXPECT_FALSE(mesh.first_entry({0.1, 2, 0.1}, {0, -4, 0}));  // down through it
  EXPECT_TRUE(mesh.contains({1, 0, 0}));
  EXPECT_NEAR(mesh.way_out({-1, 0, 0}, {1, 0, 0}), 0.35,
              0.35 * (1 - std::cos(std::numbers::pi / 36)) + 1e-12);
}

TEST(TriangleMesh, IsTurnedRightAndWelded) {
  TriangleList clockwise = box_mesh({1, 1, 1});
  for (auto& [a, b, c] : clockwise.triangles) std::swap(b, c);
  TriangleList loose;  // each triangle with corners of its own
  for (const auto& triangle : clockwise.triangles) {
    for (const int corner : triangle) {
      loose.vertices.push_back(clockwise.vertices[static_cast<std::size_t>(corner)]);
    }
    const int n = static_cast<int>(loose.vertices.size());
    loose.triangles.push_back({n - 3, n - 2, n - 1});
  }
  loose.triangles.push_back({0, 1, 0});
  const TriangleMesh mesh(loose);
  EXPECT_EQ(mesh.list().vertices.size(), 8u);
  EXPECT_EQ(mesh.list().triangles.size(), 12u);
  EXPECT_TRUE(mesh.contains({0.9, -0.9, 0.9}));
  EXPECT_FALSE(mesh.contains({1.1, 0, 0}));
}

std::string refusal(const TriangleList& list) {
  try {
    const TriangleMesh mesh(list);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "taken";
}

TEST(TriangleMesh, RefusesWhatEnclosesNothing) {
  using ::testing::HasSubstr;
  TriangleList list = box_mesh({1, 1, 1});
  list.triangles.pop_back();
  EXPECT_THAT(refusal(list), HasSubstr("not closed: 3 edges have one triangle"));
  list = box_mesh({1, 1, 1});
  std::swap(list.triangles[3][0], list.triangles[3][1]);
  EXPECT_THAT(refusal(list), HasSubstr("same direction"));
  list.triangles[3] = {0, 1, 8};
  EXPECT_THAT(refusal(list), HasSubstr("triangle 3 has corner 8; there are 8 vertices"));
  EXPECT_THAT(refusal({}), HasSubstr("no triangle"));
  EXPECT_THAT(refusal({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}, {0, 2, 1}}}), HasSubstr("no area"));
  list = box_mesh({1, 1, std::numeric_limits<double>::infinity()});
  EXPECT_THAT(refusal(list), HasSubstr("vertex 0 is not finite"));
}

}  // namespace
}  // namespace weft
