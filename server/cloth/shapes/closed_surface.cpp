#include "cloth/shapes/closed_surface.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace weft {
namespace {

/// A triangle lower than this part of its longest edge has no normal that means anything.
constexpr double kFlat = 1e-9;

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

void check_areas(const TriangleList& list) {
  for (const std::array<int, 3>& triangle : list.triangles) {
    const auto vertex = [&](std::size_t k) { return list.vertices[static_cast<std::size_t>(triangle[k])]; };
    const Vec3 a = vertex(0), ab = vertex(1) - a, ac = vertex(2) - a, bc = vertex(2) - vertex(1);
    const double longest = std::max({ab.norm(), ac.norm(), bc.norm()});
    if (!(ab.cross(ac).norm() > kFlat * longest * longest)) {
      refuse("a triangle at " + place_text(a) + " has no area");
    }
  }
}

/// By its two ends, in the triangle's direction.
using Edge = std::pair<int, int>;

/// The triangle of each directed edge, and which of its edges it is.
std::map<Edge, std::pair<int, std::size_t>> edges_of(const TriangleList& list) {
  std::map<Edge, std::pair<int, std::size_t>> edges;
  for (std::size_t t = 0; t < list.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Edge edge{list.triangles[t][k], list.triangles[t][(k + 1) % 3]};
      if (edges.try_emplace(edge, static_cast<int>(t), k).second) continue;
      refuse("two triangles pass the edge at " +
             place_text(list.vertices[static_cast<std::size_t>(edge.first)]) +
             " in the same direction: more than two meet there, or they do not agree on which side is out");
    }
  }
  return edges;
}

}  // namespace

std::string place_text(const Vec3& v) {
  std::ostringstream text;
  text << '[' << v.x() << ", " << v.y() << ", " << v.z() << ']';
  return text.str();
}

TriangleList welded(const TriangleList& list) {
  TriangleList result;
  result.convex = list.convex;
  std::map<std::tuple<double, double, double>, int> places;
  for (std::size_t t = 0; t < list.triangles.size(); ++t) {
    std::array<int, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const int corner = list.triangles[t][k];
      if (corner < 0 || corner >= static_cast<int>(list.vertices.size())) {
        refuse("triangle " + std::to_string(t) + " has corner " + std::to_string(corner) + "; there are " +
               std::to_string(list.vertices.size()) + " vertices, counted from 0");
      }
      const Vec3 vertex = list.vertices[static_cast<std::size_t>(corner)] + Vec3(0, 0, 0);  // no -0
      if (!vertex.allFinite()) refuse("vertex " + std::to_string(corner) + " is not finite");
      const auto [place, is_new] =
          places.try_emplace({vertex.x(), vertex.y(), vertex.z()}, static_cast<int>(result.vertices.size()));
      if (is_new) result.vertices.push_back(vertex);
      triangle[k] = place->second;
    }
    const auto [a, b, c] = triangle;
    if (a != b && b != c && c != a) result.triangles.push_back(triangle);
  }
  return result;
}

double enclosed_volume(const TriangleList& surface) {
  double six_fold = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    const auto vertex = [&](int i) { return surface.vertices[static_cast<std::size_t>(i)]; };
    six_fold += vertex(a).dot(vertex(b).cross(vertex(c)));
  }
  return six_fold / 6;
}

std::vector<std::pair<int, int>> open_edges(const TriangleList& surface) {
  const auto edges = edges_of(surface);
  std::vector<std::pair<int, int>> open;
  for (const auto& [edge, triangle] : edges) {
    if (!edges.contains({edge.second, edge.first})) open.push_back(edge);
  }
  return open;
}

TriangleList closed_surface(const TriangleList& list) {
  TriangleList surface = welded(list);
  if (surface.triangles.empty()) refuse("there is no triangle");
  check_areas(surface);
  const auto open = open_edges(surface);
  if (!open.empty()) {
    throw OpenSurface("the surface is not closed: " + std::to_string(open.size()) +
                      " edges have one triangle, the first at " +
                      place_text(surface.vertices[static_cast<std::size_t>(open.front().first)]) +
                      "; a solid has an inside");
  }
  if (enclosed_volume(surface) < 0) {
    for (auto& [a, b, c] : surface.triangles) std::swap(b, c);
  }
  return surface;
}

std::vector<std::array<int, 3>> edge_neighbours(const TriangleList& surface) {
  std::vector<std::array<int, 3>> neighbours(surface.triangles.size());
  const auto edges = edges_of(surface);
  for (const auto& [edge, triangle] : edges) {
    neighbours[static_cast<std::size_t>(triangle.first)][triangle.second] =
        edges.at({edge.second, edge.first}).first;
  }
  return neighbours;
}

}  // namespace weft
