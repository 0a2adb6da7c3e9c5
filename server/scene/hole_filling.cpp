#include "scene/hole_filling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

#include "cloth/shapes/closed_surface.h"

namespace weft::scene {
namespace {

/// Of vertices of a surface, in the direction in which triangles that fill it pass it.
using Border = std::vector<int>;

/// Of the cube around the surface: less is no volume.
constexpr double kLeastVolume = 1e-9;

const Vec3& vertex_of(const TriangleList& surface, int vertex) {
  return surface.vertices[static_cast<std::size_t>(vertex)];
}

/// Where borders meet in a vertex they are taken apart there.
std::vector<Border> borders_of(const TriangleList& surface) {
  std::multimap<int, int> ways;  // against the direction of the one triangle
  for (const auto& [from, to] : open_edges(surface)) ways.emplace(to, from);
  std::vector<Border> borders;
  while (!ways.empty()) {
    Border way{ways.begin()->first};
    // Each vertex of a border has as many ways out as in: the walk ends where it was before.
    for (;;) {
      const auto next = ways.find(way.back());
      if (next == ways.end())
        throw std::invalid_argument("a border of the surface does not come back to where it begins");
      const int to = next->second;
      ways.erase(next);
      const auto before = std::find(way.begin(), way.end(), to);
      if (before == way.end()) {
        way.push_back(to);
        if (way.size() > kMostHoleEdges) {
          throw std::invalid_argument("a hole at " + place_text(vertex_of(surface, to)) + " has more than " +
                                      std::to_string(kMostHoleEdges) + " edges, the most that are filled");
        }
        continue;
      }
      borders.emplace_back(before, way.end());
      way.erase(before + 1, way.end());
      if (way.size() == 1) break;
    }
  }
  return borders;
}

/// Twice the area that it goes round, along its normal (Newell).
Vec3 area_of(const TriangleList& surface, const Border& border) {
  const Vec3& origin = vertex_of(surface, border.front());
  Vec3 area(0, 0, 0);
  for (std::size_t i = 1; i + 1 < border.size(); ++i)
    area += (vertex_of(surface, border[i]) - origin).cross(vertex_of(surface, border[i + 1]) - origin);
  return area;
}

/// Twice the area of the triangle, above 0 if it is counterclockwise.
double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

/// Cuts ears off until a triangle is left. False if there is none to cut: the border crosses itself.
bool fill_by_ears(const TriangleList& surface, const Border& border,
                  std::vector<std::array<int, 3>>& filling) {
  const Vec3 normal = area_of(surface, border).stableNormalized();
  if (!normal.allFinite() || normal.isZero(0)) return false;
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  std::vector<std::pair<int, Vec2>> left;
  for (const int vertex : border) {
    const Vec3& at = vertex_of(surface, vertex);
    left.emplace_back(vertex, Vec2(at.dot(u), at.dot(v)));
  }
  const auto is_ear = [&](std::size_t i) {
    const std::size_t count = left.size();
    const Vec2 &a = left[(i + count - 1) % count].second, &b = left[i].second,
               &c = left[(i + 1) % count].second;
    if (!(turn(a, b, c) > 0)) return false;
    return std::none_of(left.begin(), left.end(), [&](const auto& other) {
      const Vec2& p = other.second;
      return p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
    });
  };
  for (std::size_t i = 0, tried = 0; left.size() > 2;) {
    const std::size_t count = left.size();
    if (tried == count) return false;
    if (!is_ear(i % count)) {
      ++i;
      ++tried;
      continue;
    }
    const std::size_t at = i % count;
    filling.push_back({left[(at + count - 1) % count].first, left[at].first, left[(at + 1) % count].first});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
    // Past the next: ears from all sides make no slivers.
    i = at + 1;
    tried = 0;
  }
  return true;
}

void fill_about_middle(TriangleList& surface, const Border& border) {
  Vec3 middle(0, 0, 0);
  for (const int vertex : border) middle += vertex_of(surface, vertex) / static_cast<double>(border.size());
  const int centre = static_cast<int>(surface.vertices.size());
  surface.vertices.push_back(middle);
  for (std::size_t i = 0; i < border.size(); ++i)
    surface.triangles.push_back({border[i], border[(i + 1) % border.size()], centre});
}

bool encloses_something(const TriangleList& surface) {
  Eigen::AlignedBox3d box;
  for (const Vec3& vertex : surface.vertices) box.extend(vertex);
  const double size = box.diagonal().norm();
  return std::abs(enclosed_volume(surface)) > kLeastVolume * size * size * size;
}

/// That the time all take, which grows with the cube of each one's edges, is within bounds.
void check_work(const std::vector<Border>& borders) {
  constexpr double kMost =
      double{kMostLargestHoles} * double{kMostHoleEdges} * double{kMostHoleEdges} * double{kMostHoleEdges};
  double work = 0;
  std::size_t edges = 0;
  for (const Border& border : borders) {
    const auto size = static_cast<double>(border.size());
    work += size * size * size;
    edges += border.size();
  }
  if (work > kMost)
    throw std::invalid_argument("its " + std::to_string(borders.size()) + " holes have " +
                                std::to_string(edges) + " edges and are too much to fill: as much as " +
                                std::to_string(kMostLargestHoles) + " of " + std::to_string(kMostHoleEdges) +
                                " edges is allowed (the time grows with the cube of a hole's edges)");
}

}  // namespace

FilledSurface fill_holes(const TriangleList& list) {
  FilledSurface filled{welded(list), 0};
  const std::vector<Border> borders = borders_of(filled.surface);
  check_work(borders);
  for (const Border& border : borders) {
    std::vector<std::array<int, 3>> filling;
    if (fill_by_ears(filled.surface, border, filling)) {
      filled.surface.triangles.insert(filled.surface.triangles.end(), filling.begin(), filling.end());
    } else {
      fill_about_middle(filled.surface, border);
    }
  }
  filled.holes = static_cast<int>(borders.size());
  if (!borders.empty() && !encloses_something(filled.surface))
    throw std::invalid_argument(
        "the surface encloses nothing when its holes are filled; a solid has an inside");
  return filled;
}

}  // namespace weft::scene
