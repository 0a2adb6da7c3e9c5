#include <stdexcept>

#include "cloth/shapes/triangle_mesh.h"
#include "scene/convex_hull.h"
#include "scene/obj_file.h"
#include "targets.h"

namespace weft::fuzz {
namespace {

void as_solid(const TriangleList& list) try {
  const TriangleMesh solid(list);
  require(solid.nearest(solid.bounds().center()).normal.allFinite(), "a solid has normals");
} catch (const std::invalid_argument&) {
}

}  // namespace

// A surface, as it is and as its convex hull, is a solid or is refused.
void meshes(Input input) try {
  TriangleList list = scene::parse_obj(text_of(input));
  as_solid(list);
  // As the reader of scenes does: what is beyond is refused before.
  for (const Vec3& vertex : list.vertices) {
    if (!(vertex.array().abs() <= 1e4).all()) return;
  }
  as_solid(scene::convex_hull(list.vertices));
} catch (const std::invalid_argument&) {
}

}  // namespace weft::fuzz
