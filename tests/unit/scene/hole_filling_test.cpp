/// Holes of surfaces are filled so that what is left is the solid that it was meant to be.
#include "scene/hole_filling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "cloth/shapes/closed_surface.h"
#include "meshes.h"

namespace weft::scene {
namespace {

/// A prism of height 1 over an outline in the x-z plane, without floor and lid.
TriangleList wall(const std::vector<Vec2>& outline) {
  TriangleList list;
  const int count = static_cast<int>(outline.size());
  for (const double y : {0.0, 1.0}) {
    for (const Vec2& at : outline) list.vertices.emplace_back(at.x(), y, at.y());
  }
  for (int i = 0; i < count; ++i) {
    const int next = (i + 1) % count;
    list.triangles.push_back({i, next, count + next});
    list.triangles.push_back({i, count + next, count + i});
  }
  return list;
}

double volume_of(const TriangleList& list) { return std::abs(enclosed_volume(closed_surface(list))); }

TEST(HoleFilling, LeavesAClosedSurfaceAsItIs) {
  const TriangleList box = weft::test::box_mesh(Vec3(1, 2, 3));
  const FilledSurface filled = fill_holes(box);
  EXPECT_EQ(filled.holes, 0);
  EXPECT_EQ(filled.surface.triangles.size(), box.triangles.size());
}

TEST(HoleFilling, FillsAFaceThatIsMissing) {
  TriangleList box = weft::test::box_mesh(Vec3(1, 2, 3));
  box.triangles.resize(box.triangles.size() - 2);
  const FilledSurface filled = fill_holes(box);
  EXPECT_EQ(filled.holes, 1);
  EXPECT_EQ(filled.surface.triangles.size(), 12u);
  EXPECT_NEAR(volume_of(filled.surface), 48, 1e-12);  // 2 x 4 x 6
}

// A cross of five unit squares: filled about its middle or as a hull it would be larger.
TEST(HoleFilling, FollowsBordersThatAreNotConvex) {
  const std::vector<Vec2> cross{{1, 0}, {2, 0}, {2, 1}, {3, 1}, {3, 2}, {2, 2},
                                {2, 3}, {1, 3}, {1, 2}, {0, 2}, {0, 1}, {1, 1}};
  const FilledSurface filled = fill_holes(wall(cross));
  EXPECT_EQ(filled.holes, 2);
  EXPECT_EQ(filled.surface.vertices.size(), 24u) << "none is added";
  EXPECT_EQ(filled.surface.triangles.size(), 24u + 2 * 10);  // a polygon of 12 corners has 10 triangles
  EXPECT_NEAR(volume_of(filled.surface), 5, 1e-12);
}

// Floor and lid stay open on opposite corners, where the borders of both pairs of faces meet.
TEST(HoleFilling, TakesBordersThatMeetApart) {
  TriangleList box = weft::test::box_mesh(Vec3(1, 1, 1));
  // One triangle of two faces each that share the corner 0 alone.
  std::erase(box.triangles, std::array<int, 3>{0, 4, 6});
  std::erase(box.triangles, std::array<int, 3>{0, 3, 1});
  const FilledSurface filled = fill_holes(box);
  EXPECT_EQ(filled.holes, 2);
  EXPECT_NEAR(volume_of(filled.surface), 8, 1e-12);
}

TEST(HoleFilling, VerticesInOnePlaceAreOneBefore) {
  TriangleList apart;  // each triangle has corners of its own
  const TriangleList box = weft::test::box_mesh(Vec3(1, 1, 1));
  for (const auto& triangle : box.triangles) {
    for (const int corner : triangle)
      apart.vertices.push_back(box.vertices[static_cast<std::size_t>(corner)]);
    const int end = static_cast<int>(apart.vertices.size());
    apart.triangles.push_back({end - 3, end - 2, end - 1});
  }
  apart.triangles.pop_back();
  const FilledSurface filled = fill_holes(apart);
  EXPECT_EQ(filled.holes, 1);
  EXPECT_NEAR(volume_of(filled.surface), 8, 1e-12);
}

std::string refusal(const TriangleList& list) {
  try {
    fill_holes(list);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(HoleFilling, AFlatSheetEnclosesNothing) {
  const TriangleList sheet{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)},
                           {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_EQ(refusal(sheet), "the surface encloses nothing when its holes are filled; a solid has an inside");
}

/// An open cylinder of radius and height 1 about (x, z) = (centre, 0).
TriangleList tube(int corners, double centre = 0) {
  std::vector<Vec2> outline;
  for (int i = 0; i < corners; ++i)
    outline.emplace_back(centre + std::cos(2 * std::numbers::pi * i / corners),
                         std::sin(2 * std::numbers::pi * i / corners));
  return wall(outline);
}

/// So many tubes beside each other.
TriangleList tubes(int count, int corners) {
  TriangleList all;
  for (int i = 0; i < count; ++i) {
    const TriangleList one = tube(corners, 3.0 * i);
    const int first = static_cast<int>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), one.vertices.begin(), one.vertices.end());
    for (const auto& [a, b, c] : one.triangles) all.triangles.push_back({first + a, first + b, first + c});
  }
  return all;
}

// A tube has two holes. Four of 1000 edges are allowed, and of 500 edges, whose cube is an eighth, 32.
TEST(HoleFilling, AllHolesTogetherHaveALimit) {
  EXPECT_EQ(refusal(tubes(2, 1000)), "");
  EXPECT_EQ(refusal(tubes(16, 500)), "");
  EXPECT_EQ(refusal(tubes(17, 500)),
            "its 34 holes have 17000 edges and are too much to fill: as much as 4 of 1000 edges is allowed "
            "(the time grows with the cube of a hole's edges)");
}

TEST(HoleFilling, AHoleHasALimit) {
  EXPECT_EQ(refusal(tube(1000)), "");
  EXPECT_NE(refusal(tube(1001)).find("has more than 1000 edges, the most that are filled"),
            std::string::npos);
}

}  // namespace
}  // namespace weft::scene
