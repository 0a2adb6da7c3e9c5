#pragma once
/// One format a file; MeshWriter::open chooses. Each throws std::runtime_error if the path cannot be written.
#include "cli/mesh_writer.h"

namespace weft::cli {

/// Wavefront OBJ, one file a frame: out.obj -> out_0000.obj, numbered by the frame. Quads, texture
/// coordinates (u, 1 - v).
std::unique_ptr<MeshWriter> open_obj(const std::string& path);
/// PC2 point cache, as read by Blender's mesh cache: a 32-byte header, then x, y, z of all points for each
/// frame.
std::unique_ptr<MeshWriter> open_pc2(const std::string& path);
/// Lines of frame, time, row, col, x, y, z, vx, vy, vz; numbers in their shortest form that reads back to the
/// same float.
std::unique_ptr<MeshWriter> open_csv(const std::string& path);
/// Binary glTF 2.0: frame 0 is the mesh, every later frame a morph target; an animation fades from one to the
/// next.
std::unique_ptr<MeshWriter> open_glb(const std::string& path);

}  // namespace weft::cli
