#include "cli/writers/mesh_frame.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>
#include <string>

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

/// Of a grid of `cols` columns of faces, on one with twice or half as many.
std::vector<std::uint32_t> torn_on(const std::vector<std::uint32_t>& torn, std::uint32_t cols, bool finer) {
  std::vector<std::uint32_t> result;
  for (const std::uint32_t face : torn) {
    const std::uint32_t r = face / cols, c = face % cols;
    if (finer) {
      const std::uint32_t first = 2 * r * 2 * cols + 2 * c;
      result.insert(result.end(), {first, first + 1, first + 2 * cols, first + 2 * cols + 1});
    } else {
      result.push_back(r / 2 * (cols / 2) + c / 2);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
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
    result.torn_faces = torn_on(result.torn_faces, static_cast<std::uint32_t>(result.cols - 1), finer);
    result.rows = finer ? 2 * result.rows - 1 : (result.rows + 1) / 2;
    result.cols = finer ? 2 * result.cols - 1 : (result.cols + 1) / 2;
  }
  return result;
}

std::array<std::uint32_t, 4> corners_of(const MeshFrame& frame, int r, int c) {
  const auto cols = static_cast<std::uint32_t>(frame.cols);
  const std::uint32_t corner = static_cast<std::uint32_t>(r) * cols + static_cast<std::uint32_t>(c);
  return {corner, corner + cols, corner + cols + 1, corner + 1};
}

std::vector<float> normals_of(const MeshFrame& frame) {
  using Column = Eigen::Map<Eigen::Vector3f>;
  using ConstColumn = Eigen::Map<const Eigen::Vector3f>;
  std::vector<float> normals(frame.positions.size(), 0.0f);
  for_each_face(frame, [&](int r, int c) {
    const auto corners = corners_of(frame, r, c);
    const auto at = [&](std::size_t i) { return ConstColumn(&frame.positions[std::size_t{3} * corners[i]]); };
    // Half of it is the face's area, whether it is flat or not.
    const Eigen::Vector3f area = (at(2) - at(0)).cross(at(3) - at(1));
    for (const std::uint32_t corner : corners) Column(&normals[std::size_t{3} * corner]) += area;
  });
  for (std::size_t i = 0; i < normals.size(); i += 3) {
    Column normal(&normals[i]);
    normal = normal.squaredNorm() > 0 ? normal.stableNormalized() : Eigen::Vector3f(0, 1, 0);
  }
  return normals;
}

}  // namespace weft::cli
