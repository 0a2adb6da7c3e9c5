#include "cli/writers/scene_writer.h"

#include <filesystem>
#include <stdexcept>
#include <utility>

#include "cli/writers/writers.h"

namespace weft::cli {
namespace {

using OpenMesh = std::unique_ptr<MeshWriter> (*)(const std::string& path);

/// A file a cloth, for formats that have one mesh.
class ClothFiles final : public SceneWriter {
 public:
  ClothFiles(const std::string& path, const ExportedScene& scene, OpenMesh open_mesh) {
    for (const std::string& cloth : scene.cloths) {
      paths_.push_back(scene.cloths.size() > 1 ? MeshWriter::path_for_cloth(path, cloth) : path);
      writers_.push_back(open_mesh(paths_.back()));
    }
  }
  void write(const SceneFrame& frame) override {
    for (std::size_t i = 0; i < writers_.size(); ++i) writers_[i]->write(frame.cloths[i]);
  }
  void finish() override {
    for (const auto& writer : writers_) writer->finish();
  }
  std::vector<std::string> files() const override { return paths_; }

 private:
  std::vector<std::string> paths_;
  std::vector<std::unique_ptr<MeshWriter>> writers_;
};

}  // namespace

std::unique_ptr<SceneWriter> SceneWriter::open(const std::string& path, const ExportedScene& scene) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".obj") return open_obj(path, scene);
  if (extension == ".glb") return open_glb(path, scene);
  if (extension == ".usda") return open_usda(path, scene);
  for (const auto& [known, open_mesh] : {std::pair<const char*, OpenMesh>(".pc2", open_pc2),
                                         std::pair<const char*, OpenMesh>(".mdd", open_mdd),
                                         std::pair<const char*, OpenMesh>(".csv", open_csv)}) {
    if (extension == known) return std::make_unique<ClothFiles>(path, scene, open_mesh);
  }
  throw std::runtime_error(path +
                           ": unknown extension; .obj, .glb, .usda, .pc2, .mdd and .csv can be written");
}

std::string MeshWriter::path_for_cloth(const std::string& path, const std::string& name) {
  std::filesystem::path result = path;
  result.replace_filename(result.stem().string() + "-" + name + result.extension().string());
  return result.string();
}

}  // namespace weft::cli
