#include "cloth/shapes/triangle_octree.h"

#include <algorithm>
#include <cmath>

namespace weft {
namespace {

/// A cell with at most so many triangles is not divided. 12 make cells that take twice the time and memory to
/// bake, and answer no faster.
constexpr std::size_t kFew = 24;
/// Nor one after so many divisions: where more triangles than that meet in a corner.
constexpr int kMaxDepth = 10;
/// By which cells are taken to be larger than they are, relative to them: more than rounding.
constexpr double kSlack = 1e-9;
/// The whole surface, and some room: points beside it have a cell, too.
constexpr double kRoom = 1.05;

}  // namespace

TriangleOctree::TriangleOctree(const std::vector<Triangle>& triangles, bool convex, const Inside& inside)
    : triangles_(triangles), convex_(convex) {
  Eigen::AlignedBox3d box;
  Candidates all;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const Vec3& corner : triangles[i].corner) box.extend(corner);
    all.triangles.push_back(static_cast<std::uint32_t>(i));
    balls_.push_back(ball_around(triangles[i]));
  }
  root_ = {box.center(), kRoom * box.sizes().maxCoeff() / 2};
  cells_.emplace_back();
  build(0, root_, 0, candidates_of(root_, all.triangles), inside);
  cells_.shrink_to_fit();
  indices_.shrink_to_fit();
}

TriangleOctree::Ball TriangleOctree::ball_around(const Triangle& triangle) {
  const auto& [a, b, c] = triangle.corner;
  const Eigen::Vector3f centre = ((a + b + c) / 3).cast<float>();
  const Vec3 middle = centre.cast<double>();
  const double radius = std::sqrt(
      std::max({(a - middle).squaredNorm(), (b - middle).squaredNorm(), (c - middle).squaredNorm()}));
  return {centre.x(), centre.y(), centre.z(), static_cast<float>(radius * (1 + 1e-6))};
}

/// A triangle nearest to any point in a cell is at most a diagonal farther from the centre than the nearest.
TriangleOctree::Candidates TriangleOctree::candidates_of(const Place& place,
                                                         const std::vector<std::uint32_t>& parents) const {
  Candidates found;
  std::vector<double> squares;
  squares.reserve(parents.size());
  for (const std::uint32_t i : parents) {
    const NearestOnTriangle on = nearest_on(triangles_[i], place.centre);
    squares.push_back((place.centre - on.point).squaredNorm());
    if (squares.back() < found.nearest.square) found.nearest = {i, on, squares.back()};
  }
  const double farthest = std::sqrt(found.nearest.square) + (1 + kSlack) * 2 * std::sqrt(3.0) * place.half;
  for (std::size_t i = 0; i < parents.size(); ++i) {
    if (squares[i] <= farthest * farthest) found.triangles.push_back(parents[i]);
  }
  // Asked first, it saves looking closely at most others.
  std::swap(found.triangles.front(),
            *std::find(found.triangles.begin(), found.triangles.end(), found.nearest.triangle));
  return found;
}

void TriangleOctree::build(std::size_t cell, const Place& place, int depth, const Candidates& candidates,
                           const Inside& inside) {
  const double radius = (1 + kSlack) * std::sqrt(3.0) * place.half;
  const double distance = std::sqrt(candidates.nearest.square);
  const bool crossed = distance <= radius;
  if (crossed && candidates.triangles.size() > kFew && depth < kMaxDepth) {
    const std::size_t children = cells_.size();
    cells_[cell].children = static_cast<std::int32_t>(children);
    cells_.resize(children + 8);
    for (int child = 0; child < 8; ++child) {
      const Place part = child_of(place, child);
      build(children + static_cast<std::size_t>(child), part, depth + 1,
            candidates_of(part, candidates.triangles), inside);
    }
    return;
  }
  Cell& leaf = cells_[cell];
  // Rounded down.
  leaf.clearance = static_cast<float>(std::max(0.0, (distance - radius) * (1 - 1e-6)));
  leaf.side = crossed                                    ? Side::crossed
              : inside(place.centre, candidates.nearest) ? Side::inside
                                                         : Side::outside;
  if (!crossed) return;
  leaf.begin = static_cast<std::uint32_t>(indices_.size());
  leaf.count = static_cast<std::uint32_t>(candidates.triangles.size());
  leaf.convex = convex_ || are_convex(candidates.triangles);
  indices_.insert(indices_.end(), candidates.triangles.begin(), candidates.triangles.end());
}

/// Then what is nearest to a point inside has it below its own plane and, facing no other way, below theirs;
/// a point outside is above the plane of one of those that meet in what is nearest to it.
bool TriangleOctree::are_convex(const std::vector<std::uint32_t>& candidates) const {
  const double flat = kSlack * root_.half;
  return std::all_of(candidates.begin(), candidates.end(), [&](std::uint32_t plane) {
    return std::all_of(candidates.begin(), candidates.end(), [&](std::uint32_t other) {
      const Triangle &below = triangles_[other], &above = triangles_[plane];
      return above.normal.dot(below.normal) >= -kSlack &&
             std::all_of(below.corner.begin(), below.corner.end(),
                         [&](const Vec3& corner) { return height_over(above, corner) <= flat; });
    });
  });
}

const TriangleOctree::Cell* TriangleOctree::cell_at(const Vec3& point) const {
  if (!holds(point)) return nullptr;
  // In whole widths of the smallest cell from the lowest corner: a bit an axis for each division.
  const Vec3 from_corner = (point - root_.centre).array() + root_.half;
  const double widths = (1 << kMaxDepth) / (2 * root_.half);
  std::array<int, 3> at{};
  for (int axis = 0; axis < 3; ++axis) {
    at[static_cast<std::size_t>(axis)] =
        std::min(static_cast<int>(widths * from_corner[axis]), (1 << kMaxDepth) - 1);
  }
  const Cell* cell = cells_.data();
  for (int bit = kMaxDepth - 1; cell->children >= 0; --bit) {
    cell = &child_cell(*cell, (at[0] >> bit & 1) | (at[1] >> bit & 1) << 1 | (at[2] >> bit & 1) << 2);
  }
  return cell;
}

double TriangleOctree::clearance(const Vec3& point, const Cell* cell) const {
  if (cell != nullptr) return double(cell->clearance);
  // The surface keeps off the root's faces.
  return ((point - root_.centre).cwiseAbs().array() - root_.half).maxCoeff();
}

TriangleOctree::Nearest TriangleOctree::nearest(const Vec3& point, const Cell* cell) const {
  Nearest best;
  if (cell != nullptr && cell->count > 0) {
    consider(*cell, point, best);
  } else {
    search(cells_.front(), root_, point, best);
  }
  return best;
}

void TriangleOctree::consider(const Cell& cell, const Vec3& point, Nearest& best) const {
  double distance = std::sqrt(best.square);
  for (std::size_t i = cell.begin; i < cell.begin + cell.count; ++i) {
    const Ball& ball = balls_[indices_[i]];
    const double reach = distance + double(ball.radius);
    const Vec3 from_ball = point - Vec3(double(ball.x), double(ball.y), double(ball.z));
    if (from_ball.squaredNorm() > reach * reach) continue;
    const Triangle& triangle = triangles_[indices_[i]];
    if (std::abs(height_over(triangle, point)) >= distance) continue;
    const NearestOnTriangle on = nearest_on(triangle, point);
    const double square = (point - on.point).squaredNorm();
    if (square >= best.square) continue;
    best = {indices_[i], on, square};
    distance = std::sqrt(square);
  }
}

/// Of the cells near the surface the nearest first.
void TriangleOctree::search(const Cell& cell, const Place& place, const Vec3& point, Nearest& best) const {
  const auto square_to = [&](const Place& p) {
    return ((point - p.centre).cwiseAbs().array() - p.half).cwiseMax(0.0).matrix().squaredNorm();
  };
  if (cell.children < 0) {
    consider(cell, point, best);
    return;
  }
  struct Part {
    double square;
    int child;
  };
  std::array<Part, 8> parts{};
  for (int child = 0; child < 8; ++child) {
    parts[static_cast<std::size_t>(child)] = {square_to(child_of(place, child)), child};
  }
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    return a.square != b.square ? a.square < b.square : a.child < b.child;
  });
  for (const Part& part : parts) {
    if (part.square >= best.square) break;
    search(child_cell(cell, part.child), child_of(place, part.child), point, best);
  }
}

/// Slabs, as wide as rounding may make them.
bool TriangleOctree::crosses(const Place& place, const Vec3& from, const Vec3& way) {
  const double half = (1 + kSlack) * place.half;
  double enter = 0, leave = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double offset = from[axis] - place.centre[axis];
    if (way[axis] == 0) {
      if (std::abs(offset) > half) return false;
      continue;
    }
    const double in = (-half - offset) / way[axis], out = (half - offset) / way[axis];
    enter = std::max(enter, std::min(in, out));
    leave = std::min(leave, std::max(in, out));
  }
  return enter <= leave;
}

}  // namespace weft
