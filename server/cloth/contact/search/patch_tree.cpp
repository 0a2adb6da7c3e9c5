#include "cloth/contact/search/patch_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace weft {
namespace {

/// Sine and cosine of the angle between cones.
constexpr double kSine = 0.5, kCosine = 0.8660254037844386;
/// Of edges that may lie in any direction.
constexpr Bounds kAnyDirection{{-1e100, -1e100, -1e100}, {1e100, 1e100, 1e100}};
/// Patches in the rectangle around two that are looked at together at most.
constexpr int kMostPatches = 9;

struct DirectionBall {
  Vec3 centre;
  double radius;
};
DirectionBall ball_around(const Bounds& box) {
  const Vec3 low(box.low.data()), high(box.high.data());
  return {(low + high) / 2, (high - low).norm() / 2};
}

constexpr std::array<std::array<int, 2>, 4> kChildren{{{0, 0}, {0, 1}, {1, 0}, {1, 1}}};
Cell child(Cell patch, std::size_t i) {
  return {2 * patch.row + kChildren[i][0], 2 * patch.col + kChildren[i][1]};
}

}  // namespace

PatchTree::PatchTree(const Grid& grid) : grid_(grid) {
  int rows = grid.rows - 1, cols = grid.cols - 1;
  for (;;) {
    levels_.push_back({rows, cols, std::vector<Patch>(static_cast<std::size_t>(rows * cols)), {}});
    if (rows % 2 != 0 || cols % 2 != 0) break;
    rows /= 2;
    cols /= 2;
  }
}

void PatchTree::refit(const Vec3* start, const Vec3* end) {
  for (Level& level : levels_) level.marked.clear();
  Level& cells = levels_.front();
  for (int r = 0; r < cells.rows; ++r) {
    for (int c = 0; c < cells.cols; ++c) {
      Patch& patch = cells.patches[cells.index(r, c)];
      patch = {};
      const std::size_t top = grid_.index(r, c), bottom = grid_.index(r + 1, c);
      for (const Vec3* x : {start, end}) {
        const Vec3 &a = x[top], &b = x[top + 1], &d = x[bottom], &e = x[bottom + 1];
        for (const Vec3* corner : {&a, &b, &d, &e}) patch.place.extend(*corner);
        patch.along_u.extend(b - a);
        patch.along_u.extend(e - d);
        patch.along_v.extend(d - a);
        patch.along_v.extend(e - b);
      }
    }
  }
  for (const std::uint32_t cell : torn_) cells.patches[cell].along_u = kAnyDirection;
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    Level& coarse = levels_[level];
    const Level& fine = levels_[level - 1];
    for (int r = 0; r < coarse.rows; ++r) {
      for (int c = 0; c < coarse.cols; ++c) {
        Patch patch;
        for (std::size_t i = 0; i < 4; ++i) {
          const Patch& part = fine.at(child({r, c}, i));
          patch.place.extend(part.place);
          patch.along_u.extend(part.along_u);
          patch.along_v.extend(part.along_v);
        }
        coarse.patches[coarse.index(r, c)] = patch;
      }
    }
  }
  bounds_ = {};
  for (const Patch& patch : levels_.back().patches) bounds_.extend(patch.place);
}

void PatchTree::mark(const char* nodes) {
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    Level& now = levels_[level];
    now.marked.resize(now.patches.size());
    for (int r = 0; r < now.rows; ++r) {
      for (int c = 0; c < now.cols; ++c) {
        bool any = false;
        for (std::size_t i = 0; i < 4; ++i) {
          any = any || (level == 0 ? nodes[grid_.index(r + kChildren[i][0], c + kChildren[i][1])] != 0
                                   : levels_[level - 1].has_marked(child({r, c}, i)));
        }
        now.marked[now.index(r, c)] = any ? 1 : 0;
      }
    }
  }
}

bool PatchTree::one_to_one(const Patch& patch) {
  const DirectionBall u = ball_around(patch.along_u), v = ball_around(patch.along_v);
  const double nu = u.centre.norm(), nv = v.centre.norm();
  if (u.radius >= nu || v.radius >= nv) return false;
  // alpha and beta, the cones' half angles, and theta between their axes: alpha + beta + 30 degrees <= theta.
  const double sa = u.radius / nu, sb = v.radius / nv;
  const double ca = std::sqrt(1 - sa * sa), cb = std::sqrt(1 - sb * sb);
  const double sine = sa * cb + ca * sb, cosine = ca * cb - sa * sb;
  if (cosine <= kSine) return false;  // alpha + beta >= 60 degrees: no theta is enough
  const double cos_theta = std::abs(u.centre.dot(v.centre)) / (nu * nv);
  return cos_theta <= kCosine * cosine - kSine * sine;
}

bool PatchTree::one_to_one(std::size_t level, Cell a, Cell b) const {
  const int rows = std::abs(a.row - b.row) + 1, cols = std::abs(a.col - b.col) + 1;
  if (rows * cols > kMostPatches) return false;
  Patch all;
  const int row = std::min(a.row, b.row), col = std::min(a.col, b.col);
  for (int r = row; r < row + rows; ++r) {
    for (int c = col; c < col + cols; ++c) {
      const Patch& part = levels_[level].at({r, c});
      all.along_u.extend(part.along_u);
      all.along_v.extend(part.along_v);
    }
  }
  return one_to_one(all);
}

void PatchTree::find_own_pairs(double margin, std::vector<std::array<Cell, 2>>& pairs) const {
  const std::size_t top = levels_.size() - 1;
  const Level& level = levels_[top];
  const int count = level.rows * level.cols;
  for (int i = 0; i < count; ++i) {
    const Cell a{i / level.cols, i % level.cols};
    own(top, a, margin, pairs);
    for (int j = i + 1; j < count; ++j) pair(top, a, {j / level.cols, j % level.cols}, margin, pairs);
  }
}

void PatchTree::own(std::size_t level, Cell patch, double margin,
                    std::vector<std::array<Cell, 2>>& pairs) const {
  if (pairs.size() == kMostPairs || !levels_[level].has_marked(patch) || one_to_one(levels_[level].at(patch)))
    return;
  if (level == 0) {
    pairs.push_back({patch, patch});
    return;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    own(level - 1, child(patch, i), margin, pairs);
    for (std::size_t j = i + 1; j < 4; ++j) {
      pair(level - 1, child(patch, i), child(patch, j), margin, pairs);
    }
  }
}

void PatchTree::pair(std::size_t level, Cell a, Cell b, double margin,
                     std::vector<std::array<Cell, 2>>& pairs) const {
  const Level& patches = levels_[level];
  if (pairs.size() == kMostPairs || !(patches.has_marked(a) || patches.has_marked(b))) return;
  if (!patches.at(a).place.near(patches.at(b).place, margin) || one_to_one(level, a, b)) return;
  if (level == 0) {
    pairs.push_back({a, b});
    return;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) pair(level - 1, child(a, i), child(b, j), margin, pairs);
  }
}

void PatchTree::find_pairs(const PatchTree& other, double margin,
                           std::vector<std::array<Cell, 2>>& pairs) const {
  const Level &mine = levels_.back(), &others = other.levels_.back();
  for (int i = 0; i < mine.rows * mine.cols; ++i) {
    for (int j = 0; j < others.rows * others.cols; ++j) {
      pair(levels_.size() - 1, {i / mine.cols, i % mine.cols}, other, other.levels_.size() - 1,
           {j / others.cols, j % others.cols}, margin, pairs);
    }
  }
}

void PatchTree::pair(std::size_t level, Cell a, const PatchTree& other, std::size_t other_level, Cell b,
                     double margin, std::vector<std::array<Cell, 2>>& pairs) const {
  const Level &patches = levels_[level], &others = other.levels_[other_level];
  if (pairs.size() == kMostPairs || !(patches.has_marked(a) || others.has_marked(b))) return;
  if (!patches.at(a).place.near(others.at(b).place, margin)) return;
  if (level == 0 && other_level == 0) {
    pairs.push_back({a, b});
    return;
  }
  // The deeper tree first, so that both come to their cells.
  const bool down = level >= other_level, other_down = other_level >= level;
  for (std::size_t i = 0; i < (down ? 4U : 1U); ++i) {
    for (std::size_t j = 0; j < (other_down ? 4U : 1U); ++j) {
      pair(down ? level - 1 : level, down ? child(a, i) : a, other,
           other_down ? other_level - 1 : other_level, other_down ? child(b, j) : b, margin, pairs);
    }
  }
}

}  // namespace weft
