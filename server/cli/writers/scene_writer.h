#pragma once
/// Sequences of a scene's meshes to files, by extension: .obj (numbered), .glb and .usda with all that is in
/// the scene; .pc2, .mdd and .csv, one for each cloth.
#include <memory>
#include <string>
#include <vector>

#include "cli/writers/body_mesh.h"
#include "cli/writers/mesh_frame.h"
#include "cloth/world/description.h"

namespace weft::cli {

/// What a file is told before its frames.
struct ExportedScene {
  std::string name;
  std::vector<std::string> cloths;  ///< their names, at least one
  std::vector<BodyMesh> bodies;
  double time_step = 1.0 / 60;  ///< from a frame's number to the next, s
  int frames = 0;               ///< that will be written; 0: that is not known
};

/// One of each cloth, with the same number and time, and a pose of each body.
struct SceneFrame {
  std::vector<MeshFrame> cloths;
  std::vector<Pose> bodies;
};

/// Writes frames to one file (or numbered sequence), or to one a cloth. The level may change between frames:
/// .obj and .csv keep each frame's own grid; the others have one topology, so there every frame is brought to
/// the first one's grid (on_grid). Coordinates are the world's, in .obj and .csv as exact as simulated, in
/// .pc2 and .mdd as a float has them there, in .glb and .usda from a node's translation. Torn faces are left
/// out; .pc2, .mdd and .csv know no faces.
class SceneWriter {
 public:
  virtual ~SceneWriter() = default;
  virtual void write(const SceneFrame& frame) = 0;
  /// Completes the file. Throws std::runtime_error naming the file on a write error.
  virtual void finish() = 0;
  /// That are written; a numbered sequence as NAME_%04d.obj.
  virtual std::vector<std::string> files() const = 0;

  /// Throws std::runtime_error for an unknown extension (names the known ones) or a path that cannot be
  /// written.
  static std::unique_ptr<SceneWriter> open(const std::string& path, const ExportedScene& scene);
};

/// Writes one cloth's frames to one file.
class MeshWriter {
 public:
  virtual ~MeshWriter() = default;
  virtual void write(const MeshFrame& frame) = 0;
  virtual void finish() = 0;
  /// `path` for cloth `name` of several: "out.csv" -> "out-NAME.csv".
  static std::string path_for_cloth(const std::string& path, const std::string& name);
};

}  // namespace weft::cli
