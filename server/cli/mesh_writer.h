#pragma once
/// Mesh sequences to files, by extension: .obj (numbered), .pc2, .csv, .glb.
#include <memory>
#include <string>
#include <vector>

namespace weft::cli {

/// One cloth's mesh at one frame.
struct MeshFrame {
  int frame = 0;
  double time = 0;  ///< s
  int rows = 0, cols = 0;
  std::vector<float> positions;   ///< x, y, z interleaved, row by row, m
  std::vector<float> velocities;  ///< the same, m/s; empty where unknown
};

/// Writes the frames of one cloth to one file (or numbered sequence). A frame of another size than the first is brought to
/// the first one's grid: fewer nodes by Eq. 8's averages, more by taking the shared nodes (levels are nested).
class MeshWriter {
 public:
  virtual ~MeshWriter() = default;
  virtual void write(const MeshFrame& frame) = 0;
  /// Completes the file. Throws std::runtime_error naming the file on a write error.
  virtual void finish() = 0;

  /// Throws std::runtime_error for an unknown extension (names the known ones) or a path that cannot be written.
  static std::unique_ptr<MeshWriter> open(const std::string& path);
  /// `path` for cloth `name` of several: "out.csv" -> "out-NAME.csv".
  static std::string path_for_cloth(const std::string& path, const std::string& name);
};

}  // namespace weft::cli
