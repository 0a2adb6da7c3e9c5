#include "cloth/sheet/tear/pieces.h"

#include <deque>
#include <limits>

#include "cloth/core/disjoint_sets.h"

namespace weft {
namespace {

/// Calls visit(link, node, node next to it) for all links that are not cut; nodes as in Grid::index.
template <class Visit>
void for_each_link(const TornLinks& torn, Visit visit) {
  const Grid& grid = torn.grid();
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      const std::size_t node = grid.index(r, c);
      if (c + 1 < grid.cols && !torn.torn({r, c, true})) visit(Link{r, c, true}, node, grid.index(r, c + 1));
      if (r + 1 < grid.rows && !torn.torn({r, c, false}))
        visit(Link{r, c, false}, node, grid.index(r + 1, c));
    }
  }
}

/// By node.
DisjointSets pieces_of(const TornLinks& torn) {
  DisjointSets pieces(torn.grid().size());
  for_each_link(torn, [&](const Link&, std::size_t a, std::size_t b) { pieces.join(a, b); });
  return pieces;
}

}  // namespace

template <class Real>
std::vector<double> piece_masses(const TornLinks& torn, const Particles<Real>& particles) {
  DisjointSets pieces = pieces_of(torn);
  const Grid& grid = torn.grid();
  std::vector<double> masses(grid.size(), 0.0);
  const auto for_each_node = [&](const auto& visit) {
    for (int r = 0; r < grid.rows; ++r) {
      for (std::size_t i = grid.index(r, 0), end = grid.index(r, grid.cols); i < end; ++i) visit(i);
    }
  };
  const Real *mass = particles.mass.row(0), *inverse = particles.inverse_mass.row(0);
  for_each_node([&](std::size_t i) {
    masses[pieces.of(i)] += inverse[i] > Real(0) ? double(mass[i]) : std::numeric_limits<double>::infinity();
  });
  for_each_node([&](std::size_t i) { masses[i] = masses[pieces.of(i)]; });
  return masses;
}

void part_pieces(const TornLinks& coarse, int level, Walls& walls) {
  const Grid& grid = coarse.grid();
  DisjointSets pieces = pieces_of(coarse);

  const TornLinks fine = walls.at(level);
  std::vector<std::vector<std::size_t>> neighbours(fine.grid().size());
  for_each_link(fine, [&](const Link&, std::size_t a, std::size_t b) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  });
  // A new node belongs to the piece that is nearest along links.
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> piece(fine.grid().size(), kNone);
  std::deque<std::size_t> reached;
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      const std::size_t node = fine.grid().index(2 * r, 2 * c);
      piece[node] = pieces.of(grid.index(r, c));
      reached.push_back(node);
    }
  }
  for (; !reached.empty(); reached.pop_front()) {
    for (const std::size_t next : neighbours[reached.front()]) {
      if (piece[next] != kNone) continue;
      piece[next] = piece[reached.front()];
      reached.push_back(next);
    }
  }
  for_each_link(fine, [&](const Link& link, std::size_t a, std::size_t b) {
    if (piece[a] != piece[b]) walls.add(level, link);
  });
}

template std::vector<double> piece_masses(const TornLinks&, const Particles<float>&);
template std::vector<double> piece_masses(const TornLinks&, const Particles<double>&);

}  // namespace weft
