#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/writers/body_mesh.h"
#include "cloth/core/path.h"
#include "protocol/frame.h"

namespace weft::cli {

/// The balls and obstacles that a client sees, as bodies of its files: those that are there at the first
/// frame.
class SeenBodies {
 public:
  /// The server's answer for the mesh of an obstacle, by its place in `scene` (PROTOCOL.md 3, `scene`).
  using GetMesh = std::function<std::string(std::size_t obstacle)>;

  SeenBodies() = default;
  /// Of the server's `scene` message and the first frame. Shapes that are not known are left out. Throws
  /// std::runtime_error where a mesh is none, and what `get_mesh` throws.
  SeenBodies(const nlohmann::json& scene, const protocol::Frame& first, const GetMesh& get_mesh);

  const std::vector<BodyMesh>& meshes() const { return meshes_; }
  /// Where each of the meshes is at a frame. What the frame does not tell of stays where it was.
  const std::vector<Pose>& poses(const protocol::Frame& frame);

 private:
  void add_obstacle(const nlohmann::json& obstacle, std::size_t index, const GetMesh& get_mesh);

  std::vector<BodyMesh> meshes_;
  std::vector<Pose> poses_;
  std::vector<std::uint32_t> ids_;  ///< of each: a ball's, or an obstacle's place in the scene
  std::size_t balls_ = 0;           ///< how many of them are balls, which come first
};

}  // namespace weft::cli
