#pragma once
#include <cstddef>
#include <map>
#include <vector>

#include "cloth/core/vec3.h"
#include "scene/motion/gltf_document.h"

namespace weft::scene {

/// The vertices that each node moves the most of all, as seen from the node when nothing has moved, by the
/// node's index; in the node's own lengths.
using Skin = std::map<std::size_t, std::vector<Vec3>>;

/// That of all meshes that hang on joints (glTF 2.0, 3.7.3): empty without any. Throws as GltfDocument.
Skin read_skin(const GltfDocument& document);

}  // namespace weft::scene
