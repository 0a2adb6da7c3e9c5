#include "scene/start/start_files.h"

#include <stdexcept>
#include <utility>

#include "scene/beside_file.h"

namespace weft::scene {
namespace {

using ReadStart = StartMesh (*)(std::string_view bytes, const StartChoice& choice);

}  // namespace

StartMesh read_start_file(const std::filesystem::path& folder, const std::string& file,
                          const StartChoice& choice) {
  const std::string extension = std::filesystem::path(file).extension().string();
  for (const auto& [known, read] : {std::pair<const char*, ReadStart>(".obj", read_obj_start),
                                    {".usda", read_usda_start},
                                    {".csv", read_csv_start},
                                    {".mdd", read_mdd_start},
                                    {".pc2", read_pc2_start},
                                    {".glb", read_glb_start}}) {
    if (extension == known) return read(read_beside(folder, file, kMaxStartBytes), choice);
  }
  throw std::invalid_argument("must be a .obj, .glb, .usda, .pc2, .mdd or .csv file");
}

}  // namespace weft::scene
