#pragma once
#include <string>
#include <vector>

#include "cli/writers/body_mesh.h"
#include "cli/writers/glb/glb_document.h"
#include "cloth/world/description.h"

namespace weft::cli {

/// A body of a .glb: a mesh, and a node that goes as the body went.
class GlbBody {
 public:
  void write(const Pose& pose);
  /// `times`: an accessor of all frames' times.
  void describe(GlbDocument& document, const BodyMesh& mesh, int times, int material) const;

 private:
  /// x, y, z interleaved, m; x, y, z, w interleaved.
  std::vector<float> positions_, quaternions_;
};

}  // namespace weft::cli
