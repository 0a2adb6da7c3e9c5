#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "cloth/shapes/closed_surface.h"
#include "scene/convex_hull.h"
#include "scene/hole_filling.h"
#include "scene/lathe.h"
#include "scene/obj_file.h"
#include "scene/readers.h"

namespace weft::scene {
namespace {

using nlohmann::json;

constexpr Range kScale{1e-6, 1e6};
constexpr const char* kFile = "file";
constexpr const char* kLathe = "lathe";
constexpr const char* kPoints = "points";
constexpr const char* kVertices = "vertices";

std::vector<Vec3> read_points(Object& object, const char* key, std::size_t fewest) {
  std::vector<Vec3> points;
  object.each(key, fewest, kMaxMeshTriangles, [&](const json& value, const std::string& at) {
    Vec3 point(0, 0, 0);
    read_numbers(value, at, kPosition, point.data(), 3, object.report());
    points.push_back(point);
  });
  return points;
}

TriangleList read_vertices(Object& object) {
  TriangleList list;
  list.vertices = read_points(object, kVertices, 4);
  object.require("triangles", "an array of arrays of 3 vertices, counted from 0");
  object.each("triangles", 4, kMaxMeshTriangles, [&](const json& value, const std::string& at) {
    const Range known{0, static_cast<double>(list.vertices.size()) - 1};
    std::array<double, 3> corners{};
    if (!read_numbers(value, at, known, corners.data(), 3, object.report())) return;
    if (corners != std::array{std::trunc(corners[0]), std::trunc(corners[1]), std::trunc(corners[2])}) {
      object.report().refuse(value, at, "3 integers");
    }
    list.triangles.push_back(
        {static_cast<int>(corners[0]), static_cast<int>(corners[1]), static_cast<int>(corners[2])});
  });
  return list;
}

TriangleList read_lathe(const json& value, const std::string& path, Report& report) {
  constexpr std::size_t kMostPoints = 1000;
  constexpr Range kDistance{0, 1e4, "m"}, kSides{3, 1000};
  Object object(value, path, report);
  std::vector<Vec2> outline;
  object.require("outline", "an array of [distance from the axis, height]");
  object.each("outline", 3, kMostPoints, [&](const json& point, const std::string& at) {
    Vec2 read(0, 0);
    if (!read_numbers(point, at, kPosition, read.data(), 2, report)) return;
    if (read.x() < kDistance.min) report.refuse(point[0], at + "/0", "a number " + kDistance.text());
    outline.push_back(read);
  });
  int sides = 48;
  object.integer("sides", sides, kSides);
  try {
    if (outline.size() >= 3) return lathe(outline, sides);
  } catch (const std::invalid_argument& error) {
    object.problem("outline", error.what());
  }
  return {};
}

/// The one of `sources` that the object has; nullptr, which is reported, if it has none or several.
const char* source_of(Object& object, const std::vector<const char*>& sources) {
  const char* source = nullptr;
  std::vector<std::string_view> names(sources.begin(), sources.end());
  for (const char* each : sources) {
    if (!object.has(each)) continue;
    if (source != nullptr) {
      object.problem(each, "is given beside " + std::string(source) + "; exactly one of " +
                               quoted_list(names) + " says what the surface is");
      return nullptr;
    }
    source = each;
  }
  if (source == nullptr) object.problem(kFile, "is missing; one of " + quoted_list(names) + " is needed");
  return source;
}

std::shared_ptr<const TriangleMesh> solid_within(const TriangleList& list) {
  try {
    return std::make_shared<const TriangleMesh>(list);
  } catch (const OpenSurface& error) {
    throw std::invalid_argument("is no solid: " + std::string(error.what()) +
                                R"(; "fill_holes": true closes it)");
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("is no solid: " + std::string(error.what()));
  }
}

}  // namespace

MeshDescription read_mesh(Object& object, bool convex, std::size_t room, const SceneFolder& folder) {
  MeshDescription mesh;
  mesh.convex = convex;
  double scale = 1;
  object.number("scale", scale, kScale);
  mesh.orientation = read_turn(object, Quaternion::Identity());
  bool fill = false;
  if (!convex) object.boolean("fill_holes", fill);  // a hull has none
  std::string file;
  const bool named = object.string(kFile, file, 1000);
  const char* source = source_of(object, {kFile, kLathe, convex ? kPoints : kVertices});
  if (source == nullptr || (source == kFile && !named)) return mesh;
  TriangleList list;
  const std::size_t problems = object.report().count();
  try {
    if (source == kFile) {
      if (!folder) throw std::invalid_argument("is given by a scene that is not a file itself");
      list = read_obj_file(*folder, file);
    } else if (source == kLathe) {
      list = read_lathe(*object.find(kLathe), object.path(kLathe), object.report());
    } else if (convex) {
      list.vertices = read_points(object, kPoints, 4);
    } else {
      list = read_vertices(object);
    }
    if (object.report().count() > problems) return mesh;
    for (Vec3& vertex : list.vertices) {
      vertex *= scale;
      const bool near = (vertex.array().abs() <= kPosition.max).all();
      if (!near) throw std::invalid_argument("has a vertex beyond 10000 m of the origin, or not finite");
    }
    if (convex) list = convex_hull(list.vertices);
    if (fill) {
      FilledSurface filled = fill_holes(list);
      list = std::move(filled.surface);
      if (filled.holes > 0)
        object.report().note(object.path(source) + ": holes filled: " + std::to_string(filled.holes));
    }
    if (list.triangles.size() > room) {
      throw std::invalid_argument("has " + std::to_string(list.triangles.size()) + " triangles; at most " +
                                  std::to_string(kMaxMeshTriangles) +
                                  " are allowed in all of a scene, of which " + std::to_string(room) +
                                  " are left");
    }
    mesh.surface = solid_within(list);
  } catch (const std::invalid_argument& error) {
    object.problem(source,
                   (source == kFile ? "is \"" + file + "\", which " : "") + std::string(error.what()));
  }
  return mesh;
}

}  // namespace weft::scene
