#include "scene/start/start_mesh.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "cloth/levels/refine.h"
#include "scene/object.h"

namespace weft::scene {
namespace {

std::string grid_text(int rows, int cols) {
  return std::to_string(rows) + " x " + std::to_string(cols) + " nodes";
}

/// The level whose grid is the mesh's.
std::optional<int> level_of(const StartMesh& mesh, const BaseCells& cells) {
  for (int level = kMinLevel; level <= kMaxLevel; ++level) {
    const Grid grid = cells.at(level);
    const bool same = mesh.rows > 0 ? mesh.rows == grid.rows && mesh.cols == grid.cols
                                    : mesh.nodes.size() == static_cast<std::size_t>(grid.nodes());
    if (same) return level;
  }
  return {};
}

Particles<double> particles_at(const std::vector<Vec3>& nodes, const Grid& grid) {
  Particles<double> particles(grid);
  std::size_t next = 0;
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c, ++next) {
      particles.position.x.at(r, c) = nodes[next].x();
      particles.position.y.at(r, c) = nodes[next].y();
      particles.position.z.at(r, c) = nodes[next].z();
    }
  }
  return particles;
}

}  // namespace

std::size_t chosen_frame(const StartChoice& choice, std::span<const double> times) {
  if (times.empty()) throw std::invalid_argument("has no frames");
  if (choice.frame) {
    const auto frame = static_cast<std::size_t>(*choice.frame);
    if (frame >= times.size())
      throw std::invalid_argument("has " + std::to_string(times.size()) +
                                  " frames, counted from 0, and no frame " + std::to_string(frame));
    return frame;
  }
  if (!choice.time) return times.size() - 1;
  constexpr double kRounding = 1e-3;  // s, of times that are written as floats
  const auto [first, last] = std::minmax_element(times.begin(), times.end());
  if (!(*choice.time >= *first - kRounding && *choice.time <= *last + kRounding)) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << "has frames from " << *first << " to " << *last << " s, and none at " << *choice.time << " s";
    throw std::invalid_argument(text.str());
  }
  const auto nearest = std::min_element(times.begin(), times.end(), [&](double a, double b) {
    return std::abs(a - *choice.time) < std::abs(b - *choice.time);
  });
  return static_cast<std::size_t>(nearest - times.begin());
}

void set_grid(StartMesh& mesh, std::span<const double> u) {
  const auto end = std::adjacent_find(u.begin(), u.end(), std::greater_equal<>());
  const std::size_t cols = end == u.end() ? u.size() : static_cast<std::size_t>(end - u.begin()) + 1;
  if (u.size() != mesh.nodes.size() || cols < 2 || u.size() % cols != 0)
    throw std::invalid_argument("has a mesh of " + std::to_string(mesh.nodes.size()) +
                                " vertices that are no grid, row by row, by their texture coordinates");
  mesh.cols = static_cast<int>(cols);
  mesh.rows = static_cast<int>(u.size() / cols);
}

std::vector<Vec3> nodes_at_level(const StartMesh& mesh, const BaseCells& cells, int level) {
  const std::optional<int> own = level_of(mesh, cells);
  if (!own) {
    const Grid grid = cells.at(level);
    throw std::invalid_argument(
        "has a cloth of " +
        (mesh.rows > 0 ? grid_text(mesh.rows, mesh.cols) : std::to_string(mesh.nodes.size()) + " nodes") +
        ", while this one has " + grid_text(grid.rows, grid.cols) + " at level " + std::to_string(level) +
        "; they must be the same, or levels of one cloth");
  }
  if (*own == level) return mesh.nodes;
  Particles<double> particles = particles_at(mesh.nodes, cells.at(*own));
  for (int at = *own; at != level;) {
    const bool finer = at < level;
    at += finer ? 1 : -1;
    Particles<double> next(cells.at(at));
    finer ? split(particles, next) : merge(particles, next);
    particles = std::move(next);
  }
  std::vector<Vec3> nodes;
  for (int r = 0; r < particles.grid().rows; ++r) {
    for (int c = 0; c < particles.grid().cols; ++c) nodes.push_back(particles.local_position_at(r, c));
  }
  return nodes;
}

void refuse_mesh_name(const StartChoice& choice, const std::vector<std::string_view>& names) {
  constexpr std::size_t kTold = 20;
  const std::vector<std::string_view> told(
      names.begin(), names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), kTold)));
  throw std::invalid_argument(
      "has no cloth " + nlohmann::json(choice.cloth).dump() + "; " +
      (names.empty() ? "it has none" : "\"cloth\" may name one of its meshes: " + quoted_list(told)));
}

}  // namespace weft::scene
