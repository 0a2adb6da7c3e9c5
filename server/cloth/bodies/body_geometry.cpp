#include "cloth/bodies/body_geometry.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>

#include <array>
#include <vector>

namespace weft {
namespace {

/// FCL's form of a mesh: convex, or hollow.
BodyGeometry::Geometry convex_of(const TriangleList& list) {
  auto faces = std::make_shared<std::vector<int>>();
  for (const std::array<int, 3>& triangle : list.triangles) {
    faces->push_back(3);
    faces->insert(faces->end(), triangle.begin(), triangle.end());
  }
  return std::make_shared<fcl::Convexd>(std::make_shared<const std::vector<Vec3>>(list.vertices),
                                        static_cast<int>(list.triangles.size()), faces);
}

BodyGeometry::Geometry hollow_of(const TriangleList& list) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Triangle> triangles;
  for (const std::array<int, 3>& t : list.triangles) {
    triangles.emplace_back(static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]),
                           static_cast<std::size_t>(t[2]));
  }
  model->beginModel();
  model->addSubModel(list.vertices, triangles);
  model->endModel();
  return model;
}

struct GeometryMaker {
  using Made = BodyGeometry::Geometry;
  Made operator()(const Sphere&) const { return nullptr; }
  Made operator()(const HalfSpace&) const { return nullptr; }
  Made operator()(const Box& box) const { return std::make_shared<fcl::Boxd>(Vec3(2 * box.half)); }
  Made operator()(const Capsule& capsule) const {
    return std::make_shared<fcl::Capsuled>(capsule.radius, 2 * capsule.half);
  }
  Made operator()(const Mesh& mesh) const {
    const TriangleList& list = mesh.surface->list();
    Made& known = surfaces[mesh.surface];
    if (!known) known = list.convex ? convex_of(list) : hollow_of(list);
    return known;
  }

  std::map<const TriangleMesh*, Made>& surfaces;
};

}  // namespace

BodyGeometry::Geometry BodyGeometry::of(const Solid& solid) {
  return std::visit(GeometryMaker{surfaces_}, solid.shape);
}

fcl::Transform3d end_of(const Solid& solid) {
  fcl::Transform3d transform = fcl::Transform3d::Identity();
  transform.translation() = solid.position;
  transform.linear() = solid.rotation;
  if (std::holds_alternative<Capsule>(solid.shape)) {  // FCL's lie along z
    Eigen::Matrix3d cyclic;
    cyclic << 0, 1, 0, 0, 0, 1, 1, 0, 0;
    transform.linear() = solid.rotation * cyclic;
  }
  return transform;
}

}  // namespace weft
