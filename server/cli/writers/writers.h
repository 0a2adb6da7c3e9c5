#pragma once
/// One format a file; SceneWriter::open chooses. Each throws std::runtime_error if the path cannot be
/// written.
#include "cli/writers/scene_writer.h"

namespace weft::cli {

/// Wavefront OBJ, one file a frame: out.obj -> out_0000.obj, numbered by the frame. An object each cloth, of
/// quads with texture coordinates (u, 1 - v) and normals, then an object each body.
std::unique_ptr<SceneWriter> open_obj(const std::string& path, const ExportedScene& scene);
/// Binary glTF 2.0, animated: cloths by morph targets, bodies by their nodes.
std::unique_ptr<SceneWriter> open_glb(const std::string& path, const ExportedScene& scene);
/// USD as text: a mesh each cloth with points, normals and extent at each frame, and a mesh each body with
/// its way. Time codes are frame numbers.
std::unique_ptr<SceneWriter> open_usda(const std::string& path, const ExportedScene& scene);
/// PC2 point cache, as read by Blender's mesh cache: a 32-byte header, then x, y, z of all points for each
/// frame.
std::unique_ptr<MeshWriter> open_pc2(const std::string& path);
/// MDD point cache (LightWave), big endian: frames and points, each frame's time (s), then x, y, z of all
/// points for each frame.
std::unique_ptr<MeshWriter> open_mdd(const std::string& path);
/// Lines of frame, time, row, col, x, y, z, vx, vy, vz; numbers in their shortest form that reads back to the
/// same float.
std::unique_ptr<MeshWriter> open_csv(const std::string& path);

}  // namespace weft::cli
