#include "cli/writers/body_mesh.h"

#include <array>
#include <cmath>
#include <utility>

namespace weft::cli {
namespace {

constexpr int kSegments = 32;          // around
constexpr int kRings = kSegments / 2;  // from pole to pole
constexpr double kPlaneHalf = 10;      // m
constexpr double kPi = 3.14159265358979323846;

void append_vertex(BodyMesh& mesh, const Vec3& position, const Vec3& normal) {
  for (const double x : position) mesh.positions.push_back(static_cast<float>(x));
  for (const double x : normal) mesh.normals.push_back(static_cast<float>(x));
}

/// Of one flat face: a, b, c, d counterclockwise.
void append_quad(BodyMesh& mesh, const std::array<Vec3, 4>& corners, const Vec3& normal) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size() / 3);
  for (const Vec3& corner : corners) append_vertex(mesh, corner, normal);
  for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.triangles.push_back(first + corner);
}

/// All within `radius` of the y axis' stretch of length 2 `half` about the origin.
void append_round(BodyMesh& mesh, double half, double radius) {
  // Rows of vertices from the upper pole down; the middle one twice where there is a stretch between.
  std::vector<std::pair<double, double>> rows;  // angle from the pole, shift along y
  for (int i = 0; i <= kRings; ++i) {
    const double angle = kPi * i / kRings;
    if (2 * i <= kRings) rows.emplace_back(angle, half);
    if (2 * i > kRings || (2 * i == kRings && half > 0)) rows.emplace_back(angle, -half);
  }
  for (const auto& [angle, shift] : rows) {
    for (int segment = 0; segment <= kSegments; ++segment) {
      const double around = 2 * kPi * segment / kSegments;
      const Vec3 normal(std::sin(angle) * std::sin(around), std::cos(angle),
                        std::sin(angle) * std::cos(around));
      append_vertex(mesh, radius * normal + Vec3(0, shift, 0), normal);
    }
  }
  const auto width = static_cast<std::uint32_t>(kSegments + 1),
             last = static_cast<std::uint32_t>(rows.size() - 1);
  for (std::uint32_t row = 0; row < last; ++row) {
    for (std::uint32_t segment = 0; segment < kSegments; ++segment) {
      const std::uint32_t a = row * width + segment, b = a + width;
      // At a pole one of the two would have no area.
      if (row + 1 < last) mesh.triangles.insert(mesh.triangles.end(), {a, b, b + 1});
      if (row > 0) mesh.triangles.insert(mesh.triangles.end(), {a, b + 1, a + 1});
    }
  }
}

void append_box(BodyMesh& mesh, const Vec3& half) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 normal = Vec3::Zero(), u = Vec3::Zero(), v = Vec3::Zero();
      normal[axis] = side;
      u[(axis + 1) % 3] = half[(axis + 1) % 3];
      v[(axis + 2) % 3] = side * half[(axis + 2) % 3];
      const Vec3 centre = half[axis] * normal;
      append_quad(mesh, {centre - u - v, centre + u - v, centre + u + v, centre - u + v}, normal);
    }
  }
}

/// Each triangle has corners of its own: a body has edges, and files tell none.
void append_triangles(BodyMesh& mesh, const TriangleList& list) {
  for (const std::array<int, 3>& triangle : list.triangles) {
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = list.vertices[static_cast<std::size_t>(triangle[i])];
    const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).stableNormalized();
    for (const Vec3& corner : corners) {
      mesh.triangles.push_back(static_cast<std::uint32_t>(mesh.positions.size() / 3));
      append_vertex(mesh, corner, normal);
    }
  }
}

void append(BodyMesh& mesh, const Sphere& sphere) { append_round(mesh, 0, sphere.radius); }
void append(BodyMesh& mesh, const Box& box) { append_box(mesh, box.half); }
void append(BodyMesh& mesh, const Capsule& capsule) { append_round(mesh, capsule.half, capsule.radius); }
void append(BodyMesh& mesh, const Mesh& solid) { append_triangles(mesh, solid.surface->list()); }
void append(BodyMesh& mesh, const HalfSpace&) {
  constexpr double kHalf = kPlaneHalf;
  append_quad(
      mesh, {Vec3(-kHalf, 0, kHalf), Vec3(kHalf, 0, kHalf), Vec3(kHalf, 0, -kHalf), Vec3(-kHalf, 0, -kHalf)},
      Vec3(0, 1, 0));
}

}  // namespace

BodyMesh body_mesh(std::string name, const Shape& shape) {
  BodyMesh mesh;
  mesh.name = std::move(name);
  std::visit([&](const auto& each) { append(mesh, each); }, shape);
  return mesh;
}

BodyMesh body_mesh(std::string name, const TriangleList& list) {
  BodyMesh mesh;
  mesh.name = std::move(name);
  append_triangles(mesh, list);
  return mesh;
}

}  // namespace weft::cli
