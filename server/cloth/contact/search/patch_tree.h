#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "cloth/core/grid.h"
#include "cloth/core/vec3.h"

namespace weft {

/// A box along the axes that grows around what it is given.
struct Bounds {
  std::array<double, 3> low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};

  void extend(const Vec3& p) {
    for (int i = 0; i < 3; ++i) {
      low[static_cast<std::size_t>(i)] = std::min(low[static_cast<std::size_t>(i)], p[i]);
      high[static_cast<std::size_t>(i)] = std::max(high[static_cast<std::size_t>(i)], p[i]);
    }
  }
  void extend(const Bounds& other) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], other.low[i]);
      high[i] = std::max(high[i], other.high[i]);
    }
  }
  /// No farther apart than `margin` along any axis.
  bool near(const Bounds& other, double margin) const {
    return low[0] <= other.high[0] + margin && other.low[0] <= high[0] + margin &&
           low[1] <= other.high[1] + margin && other.low[1] <= high[1] + margin &&
           low[2] <= other.high[2] + margin && other.low[2] <= high[2] + margin;
  }
};

/// A cell of a sheet, by its top left node.
struct Cell {
  int row = 0, col = 0;
};

/// The cells of one sheet on their ways, patch within patch: the grid is its own hierarchy, halved as long as
/// both sides are even. Finds pairs of cells that come near each other, and leaves out at once what cannot: a
/// patch is one-to-one, and stays so on straight ways, if all its edges along u lie in one cone of directions
/// and all along v in another, apart from it and its opposite. For the vector between two of its points is
/// du U + dv V, with U and V means of edges on the line between the points, and each of a cell's triangles
/// has one edge of either kind. (In the spirit of the normal cones of Volino and Magnenat-Thalmann 1994 and
/// Provot 1997, but without their condition on the border, and for the whole way.) The cones are asked to lie
/// 30 degrees apart, so that points more than a cell from each other are at least half a cell apart.
class PatchTree {
 public:
  /// No more pairs of cells are found than this.
  static constexpr std::size_t kMostPairs = std::size_t{1} << 22;

  explicit PatchTree(const Grid& grid);

  const Grid& grid() const { return grid_; }
  std::size_t cells() const { return levels_.front().patches.size(); }
  /// Cells, each as row * (columns of cells) + column, across which nothing is one-to-one: torn ones.
  void set_torn(std::vector<std::uint32_t> cells) { torn_ = std::move(cells); }
  /// The nodes' ways, straight from `start` to `end`; both as many as grid.size().
  void refit(const Vec3* start, const Vec3* end);
  /// Until the next refit pairs are found only where one of the two cells has a marked corner: `nodes` is of
  /// each of grid.size() nodes. To be called for both sheets of find_pairs or for neither.
  void mark(const char* nodes);
  /// Of the whole sheet.
  const Bounds& bounds() const { return bounds_; }

  /// Adds the pairs of cells of this sheet whose boxes come as near as `margin`; a cell that may meet itself
  /// with itself. Up to kMostPairs.
  void find_own_pairs(double margin, std::vector<std::array<Cell, 2>>& pairs) const;
  /// Those of a cell of this and one of another sheet.
  void find_pairs(const PatchTree& other, double margin, std::vector<std::array<Cell, 2>>& pairs) const;

 private:
  struct Patch {
    Bounds place, along_u, along_v;
  };
  struct Level {
    int rows = 0, cols = 0;
    std::vector<Patch> patches;
    std::vector<char> marked;  ///< empty if all are
    bool has_marked(Cell c) const { return marked.empty() || marked[index(c.row, c.col)] != 0; }
    const Patch& at(Cell c) const { return patches[index(c.row, c.col)]; }
    std::size_t index(int row, int col) const {
      return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(col);
    }
  };
  static bool one_to_one(const Patch& patch);
  /// All patches from a to b, if they are few, are together one to one.
  bool one_to_one(std::size_t level, Cell a, Cell b) const;
  void own(std::size_t level, Cell patch, double margin, std::vector<std::array<Cell, 2>>& pairs) const;
  void pair(std::size_t level, Cell a, Cell b, double margin, std::vector<std::array<Cell, 2>>& pairs) const;
  void pair(std::size_t level, Cell a, const PatchTree& other, std::size_t other_level, Cell b, double margin,
            std::vector<std::array<Cell, 2>>& pairs) const;

  Grid grid_;
  std::vector<Level> levels_;  ///< cells first
  std::vector<std::uint32_t> torn_;
  Bounds bounds_;
};

}  // namespace weft
