#pragma once
/// A cloth's mesh at one frame of a sequence.
#include <array>
#include <cstdint>
#include <vector>

namespace weft::cli {

/// One cloth's mesh at one frame.
struct MeshFrame {
  int frame = 0;
  double time = 0;  ///< s
  int rows = 0, cols = 0;
  std::vector<float> positions;   ///< x, y, z interleaved, row by row, from `place`, m
  std::vector<float> velocities;  ///< the same, m/s; empty where unknown
  /// Faces that are torn, ascending; face r * (cols - 1) + c lies right of and below node (r, c).
  std::vector<std::uint32_t> torn_faces = {};
  std::array<double, 3> place{};  ///< of the positions' origin in the world, m

  /// In the world, m: component i of `positions`, whose axis is i % 3.
  double coordinate(std::size_t i) const { return place[i % 3] + double(positions[i]); }
};

/// `frame` with rows x cols nodes: more by Eq. 8's averages, fewer by taking the shared nodes (levels are
/// nested). A face is torn that lies in a torn one or has one in it. Throws std::invalid_argument if the two
/// are not levels of one cloth.
MeshFrame on_grid(const MeshFrame& frame, int rows, int cols);

/// Unit normals of the nodes, x, y, z interleaved: the mean of the faces around each, by area, without torn
/// ones. Where that is nothing, upwards.
std::vector<float> normals_of(const MeshFrame& frame);

/// Corners of the face right of and below node (r, c), counterclockwise as seen from where its normal points.
std::array<std::uint32_t, 4> corners_of(const MeshFrame& frame, int r, int c);

/// Calls visit(r, c) for each face that is not torn, row by row.
template <class Visit>
void for_each_face(const MeshFrame& frame, Visit visit) {
  auto torn = frame.torn_faces.begin();
  std::uint32_t face = 0;
  for (int r = 0; r + 1 < frame.rows; ++r) {
    for (int c = 0; c + 1 < frame.cols; ++c, ++face) {
      if (torn != frame.torn_faces.end() && *torn == face) {
        ++torn;
      } else {
        visit(r, c);
      }
    }
  }
}

}  // namespace weft::cli
