#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cloth/core/grid.h"
#include "cloth/core/vec3.h"

namespace weft::scene {

inline constexpr std::size_t kMaxStartBytes = 256u << 20;  ///< of a file that a cloth starts from

/// Which mesh of a file is meant.
struct StartChoice {
  std::string cloth;           ///< its name in files that have several meshes
  std::optional<int> frame;    ///< counted from 0; without it and `time` the last one
  std::optional<double> time;  ///< s, as the file counts it: the frame that is nearest
};

/// A cloth's nodes at one frame of a file.
struct StartMesh {
  int rows = 0, cols = 0;   ///< of the grid; 0 if the file tells no more than how many nodes there are
  std::vector<Vec3> nodes;  ///< in the world, row by row, m
};

/// The index of the chosen frame among those at `times`, s, at least one; without times only its number
/// counts. Throws std::invalid_argument if there is none.
std::size_t chosen_frame(const StartChoice& choice, std::span<const double> times);

/// Gives the mesh the grid whose nodes have these texture coordinates u, which ascend along each row. Throws
/// std::invalid_argument if they are none of a grid.
void set_grid(StartMesh& mesh, std::span<const double> u);

/// The mesh's nodes at another level of a cloth of these cells: coarser by taking the nodes that both have,
/// finer by Eq. 8's averages. Throws std::invalid_argument if the mesh is no level of such a cloth.
std::vector<Vec3> nodes_at_level(const StartMesh& mesh, const BaseCells& cells, int level);

/// What is wrong with a file that has meshes of these names, but not the chosen one.
[[noreturn]] void refuse_mesh_name(const StartChoice& choice, const std::vector<std::string_view>& names);

}  // namespace weft::scene
