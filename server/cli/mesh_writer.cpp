#include "cli/mesh_writer.h"

#include <filesystem>
#include <stdexcept>

#include "cli/writers/writers.h"

namespace weft::cli {
namespace {

/// Every second node of `values`, x, y, z interleaved.
std::vector<float> every_second(const std::vector<float>& values, int rows, int cols) {
  std::vector<float> kept;
  kept.reserve(values.size() / 4);
  for (int r = 0; r < rows; r += 2) {
    for (int c = 0; c < cols; c += 2) {
      const float* node = &values[static_cast<std::size_t>(r * cols + c) * 3];
      kept.insert(kept.end(), node, node + 3);
    }
  }
  return kept;
}

/// Eq. 8: nodes halfway on edges and in the middle of cells are the means of the 2 or 4 around them.
std::vector<float> halved_cells(const std::vector<float>& values, int rows, int cols) {
  const int fine_rows = 2 * rows - 1, fine_cols = 2 * cols - 1;
  std::vector<float> fine;
  fine.reserve(static_cast<std::size_t>(fine_rows * fine_cols) * 3);
  const auto at = [&](int r, int c, int axis) {
    return values[static_cast<std::size_t>(r * cols + c) * 3 + static_cast<std::size_t>(axis)];
  };
  for (int r = 0; r < fine_rows; ++r) {
    for (int c = 0; c < fine_cols; ++c) {
      const int r0 = r / 2, r1 = (r + 1) / 2, c0 = c / 2,
                c1 = (c + 1) / 2;  // the same where the node is shared
      for (int axis = 0; axis < 3; ++axis) {
        fine.push_back((at(r0, c0, axis) + at(r0, c1, axis) + at(r1, c0, axis) + at(r1, c1, axis)) / 4);
      }
    }
  }
  return fine;
}

}  // namespace

MeshFrame on_grid(const MeshFrame& frame, int rows, int cols) {
  MeshFrame result = frame;
  const bool finer = frame.rows < rows;
  while (result.rows != rows || result.cols != cols) {
    const bool possible =
        finer ? result.rows < rows && result.cols < cols
              : result.rows > rows && result.cols > cols && result.rows % 2 == 1 && result.cols % 2 == 1;
    if (!possible) {
      throw std::invalid_argument("a mesh of " + std::to_string(frame.rows) + " x " +
                                  std::to_string(frame.cols) +
                                  " nodes is no level of a cloth that has one of " + std::to_string(rows) +
                                  " x " + std::to_string(cols));
    }
    for (std::vector<float>* values : {&result.positions, &result.velocities}) {
      if (values->empty()) continue;
      *values = finer ? halved_cells(*values, result.rows, result.cols)
                      : every_second(*values, result.rows, result.cols);
    }
    result.rows = finer ? 2 * result.rows - 1 : (result.rows + 1) / 2;
    result.cols = finer ? 2 * result.cols - 1 : (result.cols + 1) / 2;
  }
  return result;
}

std::unique_ptr<MeshWriter> MeshWriter::open(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".obj") return open_obj(path);
  if (extension == ".pc2") return open_pc2(path);
  if (extension == ".csv") return open_csv(path);
  if (extension == ".glb") return open_glb(path);
  throw std::runtime_error(path + ": unknown extension; .obj, .pc2, .csv and .glb can be written");
}

std::string MeshWriter::path_for_cloth(const std::string& path, const std::string& name) {
  std::filesystem::path result = path;
  result.replace_filename(result.stem().string() + "-" + name + result.extension().string());
  return result.string();
}

}  // namespace weft::cli
