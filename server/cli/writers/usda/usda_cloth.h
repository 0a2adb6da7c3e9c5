#pragma once
#include <string>

#include "cli/writers/mesh_frame.h"
#include "cli/writers/spill_file.h"

namespace weft::cli {

/// A cloth of a .usda as its frames come. Each attribute has all its samples in one place, so they are put
/// aside until the end. Faces have samples where they tear.
class UsdaCloth {
 public:
  /// `path`: of the .usda.
  UsdaCloth(const std::string& path, std::string name);

  void write(const MeshFrame& frame);
  /// Writes the mesh into the file, as a prim named `prim`; nothing if there was no frame.
  void finish(OutputFile& file, const std::string& prim);
  const std::string& name() const { return name_; }

 private:
  void add_faces(const MeshFrame& frame);
  /// The sample of a frame: "        12: VALUE,\n".
  static std::string sample(int frame, const std::string& value);

  std::string name_;
  SpillFile points_, normals_, extents_, counts_, indices_;
  MeshFrame first_, last_;
  std::string first_counts_, first_indices_;
  bool tears_ = false;
};

}  // namespace weft::cli
