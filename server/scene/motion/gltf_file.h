#pragma once
#include <filesystem>
#include <string>

#include "scene/motion/gltf_document.h"
#include "scene/motion/skeleton.h"

namespace weft::scene {

/// The document in a .gltf or .glb file of the folder, with its buffers, which are files beside it or in it:
/// by the rules of read_beside. Throws as GltfDocument.
GltfDocument open_gltf(const std::filesystem::path& folder, const std::string& file);

/// The document's nodes, in its order, and its animations of their translations and rotations. A node without
/// a name is "node 7". Scales stay as the nodes have them: path_of refuses what an animation scales.
/// Throws as GltfDocument.
Skeleton read_gltf(const GltfDocument& document);

}  // namespace weft::scene
