#pragma once
#include <cstdint>
#include <vector>

#include "cloth/core/grid.h"

namespace weft {

/// A structural link: from node (row, col) to the next column, or to the next row.
struct Link {
  int row = 0, col = 0;
  bool along_u = true;
  bool operator==(const Link&) const = default;
};

/// Faces of one row of cells, [begin, end).
struct FaceRun {
  int row, begin, end;
};

/// What a cloth's walls (walls.h) cut at one level. The structural links tell all: a shear link is cut where
/// both ways round it along its cell's edges are, a bending link where one of the two links it lies along is,
/// and a face is torn that has lost two or more of its edges. With one it is a tear's end, and whole.
class TornLinks {
 public:
  explicit TornLinks(const Grid& grid)
      : grid_(grid), u_(static_cast<std::size_t>(grid.nodes())), v_(static_cast<std::size_t>(grid.nodes())) {}

  const Grid& grid() const { return grid_; }
  bool operator==(const TornLinks&) const = default;
  void cut(const Link& link) { (link.along_u ? u_ : v_)[at(link.row, link.col)] = 1; }
  bool torn(const Link& link) const { return (link.along_u ? u_ : v_)[at(link.row, link.col)] != 0; }
  /// Of the link from (r, c) to (r + rows, c + cols), one of SpringFamily's six.
  bool torn(int r, int c, int rows, int cols) const;
  /// Edges that the face right of and below node (r, c) has lost, 0 to 4.
  int lost_edges(int r, int c) const { return u(r, c) + u(r + 1, c) + v(r, c) + v(r, c + 1); }
  bool face_torn(int r, int c) const { return lost_edges(r, c) >= 2; }
  /// All faces that are not torn, row by row.
  std::vector<FaceRun> whole_faces() const;
  /// All that are, each as row * (columns of cells) + column, ascending.
  std::vector<std::uint32_t> torn_faces() const;

  /// What lasts from step to step (world/state.h); of the same grid.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(u_, v_);
  }

 private:
  std::size_t at(int r, int c) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(grid_.cols) + static_cast<std::size_t>(c);
  }
  int u(int r, int c) const { return u_[at(r, c)]; }
  int v(int r, int c) const { return v_[at(r, c)]; }

  Grid grid_;
  std::vector<std::uint8_t> u_, v_;  ///< 1 where the node's link to the next column, or row, is cut
};

}  // namespace weft
