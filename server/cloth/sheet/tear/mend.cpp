#include "cloth/sheet/tear/mend.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "cloth/core/disjoint_sets.h"

namespace weft {
namespace {

struct Place {
  int row, col;
};
constexpr std::array<Place, 4> kWays{{{0, 1}, {1, 0}, {0, -1}, {-1, 0}}};

bool inside(const Grid& grid, const Place& p) {
  return p.row >= 0 && p.col >= 0 && p.row < grid.rows && p.col < grid.cols;
}

/// The node next to `p` in that way, if there is one and their link is not cut.
bool linked(const TornLinks& torn, const Place& p, const Place& way) {
  const Place q{p.row + way.row, p.col + way.col};
  if (!inside(torn.grid(), q)) return false;
  return !torn.torn(Link{std::min(p.row, q.row), std::min(p.col, q.col), way.row == 0});
}

/// No link of the coarse cell's three by three fine nodes around `centre` is cut.
bool whole_cell(const TornLinks& torn, const Place& centre) {
  for (int i = -1; i <= 1; ++i) {
    for (int j = -1; j <= 0; ++j) {
      if (torn.torn(Link{centre.row + i, centre.col + j, true})) return false;
      if (torn.torn(Link{centre.row + j, centre.col + i, false})) return false;
    }
  }
  return true;
}

/// The mean that split() took of what lies around the node was of one side of the walls.
bool is_sound(const TornLinks& torn, const Place& p) {
  const bool odd_row = p.row % 2 == 1, odd_col = p.col % 2 == 1;
  if (odd_row && odd_col) return whole_cell(torn, p);
  if (odd_col) return linked(torn, p, {0, -1}) && linked(torn, p, {0, 1});
  if (odd_row) return linked(torn, p, {-1, 0}) && linked(torn, p, {1, 0});
  return true;
}

template <class Real>
void set(VectorField<Real>& field, const Place& p, const Vec3& value) {
  field.x.at(p.row, p.col) = static_cast<Real>(value.x());
  field.y.at(p.row, p.col) = static_cast<Real>(value.y());
  field.z.at(p.row, p.col) = static_cast<Real>(value.z());
}

template <class Real>
Vec3 acceleration_at(const Particles<Real>& particles, const Place& p) {
  const VectorField<Real>& field = particles.acceleration;
  return {double(field.x.at(p.row, p.col)), double(field.y.at(p.row, p.col)),
          double(field.z.at(p.row, p.col))};
}

/// Means over the neighbours that tell where a node belongs.
struct Found {
  Vec3 position{0, 0, 0}, velocity{0, 0, 0}, acceleration{0, 0, 0};
  int count = 0;
};

/// From neighbours that are sound, with `straight` from those alone that go straight on from another.
template <class Real>
Found look_around(const TornLinks& torn, const Particles<Real>& fine, const Field<char>& sound,
                  const Vec2& spacing, const Place& p, bool straight) {
  Found found;
  for (const Place& way : kWays) {
    const Place q{p.row + way.row, p.col + way.col}, before{q.row + way.row, q.col + way.col};
    if (!linked(torn, p, way) || sound.at(q.row, q.col) == 0) continue;
    const Vec3 at = fine.local_position_at(q.row, q.col);
    if (straight) {
      if (!linked(torn, q, way) || sound.at(before.row, before.col) == 0) continue;
      found.position += 2 * at - fine.local_position_at(before.row, before.col);
    } else {
      const Vec3 apart = fine.local_position_at(p.row, p.col) - at;
      const double longest = way.row == 0 ? spacing.x() : spacing.y(), length = apart.norm();
      found.position += at + (length > longest ? longest / length : 1.0) * apart;
    }
    found.velocity += fine.velocity_at(q.row, q.col);
    found.acceleration += acceleration_at(fine, q);
    ++found.count;
  }
  return found;
}

/// Of those that are `left` and hang together the first is sound; it is left no more.
void begin_flakes(const TornLinks& torn, std::vector<Place>& left, Field<char>& sound) {
  const Grid& grid = torn.grid();
  const auto index = [&](const Place& p) { return grid.index(p.row, p.col); };
  DisjointSets flakes(grid.size());
  for (const Place& p : left) {
    for (const Place& way : {kWays[0], kWays[1]}) {
      if (linked(torn, p, way)) flakes.join(index(p), index({p.row + way.row, p.col + way.col}));
    }
  }
  std::vector<char> begun(grid.size(), 0);
  std::erase_if(left, [&](const Place& p) {
    const bool first = std::exchange(begun[flakes.of(index(p))], 1) == 0;
    if (first) sound.at(p.row, p.col) = 1;
    return first;
  });
}

/// The coarse nodes around a fine one, by how much of its momentum they get.
struct Parents {
  std::array<Place, 4> place{};
  std::array<double, 4> share{};
};

Parents parents_of(const TornLinks& torn, const Place& p) {
  Parents parents;
  double whole = 0;
  std::size_t next = 0;
  for (const int down : {0, 1}) {
    for (const int right : {0, 1}) {
      // The nearest even row and column on either side; the same twice where its own is even.
      const Place q{(p.row + down) / 2 * 2, (p.col + right) / 2 * 2};
      const int r = std::min(p.row, q.row), rows = std::abs(p.row - q.row), cols = q.col - p.col;
      const bool slants_left = (q.row > p.row) != (cols > 0);
      bool held = true;
      if (rows == 1 && cols != 0) {
        held = slants_left ? !torn.torn(r, std::max(p.col, q.col), 1, -1)
                           : !torn.torn(r, std::min(p.col, q.col), 1, 1);
      } else if (rows == 1 || cols != 0) {
        held = linked(torn, p, {q.row - p.row, cols});
      }
      parents.place[next] = {q.row / 2, q.col / 2};
      parents.share[next++] = held ? 1.0 : 0.0;
      whole += held ? 1.0 : 0.0;
    }
  }
  for (double& share : parents.share) share = whole > 0 ? share / whole : 0.25;
  return parents;
}

}  // namespace

template <class Real>
void mend_split(const TornLinks& torn, const Vec2& spacing, Particles<Real>& fine) {
  const Grid& grid = fine.grid();
  Field<char> sound(grid);
  std::vector<Place> left;
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      sound.at(r, c) = is_sound(torn, {r, c}) ? 1 : 0;
      if (sound.at(r, c) == 0) left.push_back({r, c});
    }
  }
  bool straight = true;
  while (!left.empty()) {
    std::vector<Place> placed, waiting;
    for (const Place& p : left) {
      const Found found = look_around(torn, fine, sound, spacing, p, straight);
      (found.count > 0 ? placed : waiting).push_back(p);
      if (found.count == 0) continue;
      set(fine.position, p, found.position / found.count);
      set(fine.velocity, p, found.velocity / found.count);
      set(fine.acceleration, p, found.acceleration / found.count);
    }
    // Not before all of a pass are placed, so that their order does not matter.
    for (const Place& p : placed) sound.at(p.row, p.col) = 1;
    if (placed.empty() && !straight) begin_flakes(torn, waiting, sound);
    straight = !placed.empty();
    left = std::move(waiting);
  }
}

template <class Real>
void merge_torn_momentum(const Particles<Real>& fine, const TornLinks& torn, Particles<Real>& coarse) {
  const Grid& grid = fine.grid();
  std::vector<Vec3> momentum(coarse.grid().size(), Vec3::Zero());
  std::vector<double> mass(coarse.grid().size(), 0.0);
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      const Parents parents = parents_of(torn, {r, c});
      for (std::size_t i = 0; i < parents.place.size(); ++i) {
        const Place& to = parents.place[i];
        const std::size_t node = coarse.grid().index(to.row, to.col);
        const double share = parents.share[i] * double(fine.mass.at(r, c));
        momentum[node] += share * fine.velocity_at(r, c);
        mass[node] += share;
      }
    }
  }
  for (int r = 0; r < coarse.grid().rows; ++r) {
    for (int c = 0; c < coarse.grid().cols; ++c) {
      const std::size_t node = coarse.grid().index(r, c);
      set(coarse.velocity, {r, c}, momentum[node] / mass[node]);
    }
  }
}

template void mend_split(const TornLinks&, const Vec2&, Particles<float>&);
template void mend_split(const TornLinks&, const Vec2&, Particles<double>&);
template void merge_torn_momentum(const Particles<float>&, const TornLinks&, Particles<float>&);
template void merge_torn_momentum(const Particles<double>&, const TornLinks&, Particles<double>&);

}  // namespace weft
