#pragma once
/// A cloth's mesh from the bytes of a file as Weft writes it, a reader a format. Each throws
/// std::invalid_argument, saying what is wrong; none reads beyond the bytes, or keeps more than they have.
#include <filesystem>

#include "scene/start/start_mesh.h"

namespace weft::scene {

/// .obj: an object each mesh; one frame.
StartMesh read_obj_start(std::string_view text, const StartChoice& choice);
/// .usda: a prim each mesh, its points sampled by time codes.
StartMesh read_usda_start(std::string_view text, const StartChoice& choice);
/// .csv: a line each node of each frame, of one cloth.
StartMesh read_csv_start(std::string_view text, const StartChoice& choice);
/// .mdd and .pc2: points of one cloth, frame by frame.
StartMesh read_mdd_start(std::string_view bytes, const StartChoice& choice);
StartMesh read_pc2_start(std::string_view bytes, const StartChoice& choice);
/// .glb: a cloth's frames are morph targets of the nodes NAME, NAME.120, ...; or one mesh without targets, as
/// the page saves it. At most kMaxGltfBytes.
StartMesh read_glb_start(std::string_view bytes, const StartChoice& choice);

/// The mesh in a file of the folder, by the rules of read_beside, read as its extension says.
StartMesh read_start_file(const std::filesystem::path& folder, const std::string& file,
                          const StartChoice& choice);

}  // namespace weft::scene
