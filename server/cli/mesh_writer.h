#pragma once
/// Mesh sequences to files, by extension: .obj (numbered), .pc2, .csv, .glb.
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
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

/// Writes the frames of one cloth to one file (or numbered sequence). The level may change between frames:
/// .obj and .csv keep each frame's own grid; .pc2 and .glb have one topology, so there every frame is brought
/// to the first one's grid (on_grid). Coordinates are the world's, in .obj and .csv as exact as simulated, in
/// .pc2 as a float has them there, in .glb from its node's translation. Torn faces are left out of .obj; .pc2
/// and .csv know no faces, a .glb keeps all of them.
class MeshWriter {
 public:
  virtual ~MeshWriter() = default;
  virtual void write(const MeshFrame& frame) = 0;
  /// Completes the file. Throws std::runtime_error naming the file on a write error.
  virtual void finish() = 0;
  /// Frames the format can hold; write throws std::runtime_error beyond it.
  virtual int max_frames() const { return std::numeric_limits<int>::max(); }

  /// Throws std::runtime_error for an unknown extension (names the known ones) or a path that cannot be
  /// written.
  static std::unique_ptr<MeshWriter> open(const std::string& path);
  /// `path` for cloth `name` of several: "out.csv" -> "out-NAME.csv".
  static std::string path_for_cloth(const std::string& path, const std::string& name);
};

/// `frame` with rows x cols nodes: more by Eq. 8's averages, fewer by taking the shared nodes (levels are
/// nested). Throws std::invalid_argument if the two are not levels of one cloth.
MeshFrame on_grid(const MeshFrame& frame, int rows, int cols);

}  // namespace weft::cli
