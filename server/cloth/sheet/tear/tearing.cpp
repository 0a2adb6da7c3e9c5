#include "cloth/sheet/tear/tearing.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace weft {
namespace {

template <class Real>
Vec3 at(const VectorField<Real>& field, int r, int c) {
  return {double(field.x.at(r, c)), double(field.y.at(r, c)), double(field.z.at(r, c))};
}

/// A family of springs, or none: force() is then zero.
template <class Real>
struct Family {
  const Springs<Real>& springs;
  const SpringFamily* family = nullptr;

  Family(const Springs<Real>& all, int rows, int cols) : springs(all) {
    for (const SpringFamily& each : all.families()) {
      if (each.rows == rows && each.cols == cols) family = &each;
    }
  }
  /// With which end (r, c) is pulled towards the other one, N.
  Vec3 force(const VectorField<Real>& position, int r, int c) const {
    if (family == nullptr || springs.torn(*family, r, c)) return Vec3::Zero();
    const Grid& grid = position.grid();
    return spring_force(at(position, r, c) - at(position, r + family->rows, c + family->cols),
                        family->rest_length, family->stiffness_at(r, c, grid.rows, grid.cols), family->limit);
  }
};

/// The forces of a row of cells' diagonals, on their left ends.
struct CellRow {
  std::vector<Vec3> falling, rising;
};

}  // namespace

template <class Real>
LinkLoads link_loads(const Springs<Real>& springs, const VectorField<Real>& position,
                     const TearingEffect& tearing) {
  const Grid& grid = position.grid();
  LinkLoads loads{grid, std::vector<double>(static_cast<std::size_t>(grid.nodes())), {}};
  loads.v = loads.u;
  const Family<Real> along_u(springs, 0, 1), along_v(springs, 1, 0), falling(springs, 1, 1),
      rising(springs, 1, -1);
  if (along_u.family == nullptr || along_v.family == nullptr) return loads;
  const double hx = along_u.family->rest_length, hy = along_v.family->rest_length;
  const double border_share = along_u.family->border_share;
  const auto cells = static_cast<std::size_t>(grid.cols - 1);
  const CellRow none{std::vector<Vec3>(cells, Vec3::Zero()), std::vector<Vec3>(cells, Vec3::Zero())};
  CellRow above = none, below = none;
  for (int r = 0; r < grid.rows; ++r) {
    std::swap(above, below);
    const bool border_row = r == 0 || r + 1 == grid.rows;
    for (std::size_t c = 0; c < cells; ++c) {
      const int col = static_cast<int>(c);
      const bool inside = r + 1 < grid.rows && falling.family != nullptr;
      below.falling[c] = inside ? falling.force(position, r, col) : Vec3(Vec3::Zero());
      below.rising[c] = inside ? Vec3(-rising.force(position, r, col + 1)) : Vec3(Vec3::Zero());
    }
    for (int c = 0; c < grid.cols; ++c) {
      const std::size_t node = loads.index(r, c), cell = static_cast<std::size_t>(c);
      // What pulls the node's side of the link towards the other one.
      if (c + 1 < grid.cols && !springs.torn(*along_u.family, r, c)) {
        Vec3 pull = along_u.force(position, r, c);
        for (const CellRow* row : {&above, &below}) pull += 0.5 * (row->falling[cell] + row->rising[cell]);
        const Vec3 way = (at(position, r, c + 1) - at(position, r, c)).normalized();
        loads.u[node] = pull.dot(way) / (hy * (border_row ? border_share : 1.0) * tearing.warp);
      }
      if (r + 1 < grid.rows && !springs.torn(*along_v.family, r, c)) {
        Vec3 pull = along_v.force(position, r, c);
        if (c > 0) pull += 0.5 * (below.falling[cell - 1] - below.rising[cell - 1]);
        if (cell < cells) pull += 0.5 * (below.falling[cell] - below.rising[cell]);
        const bool border_col = c == 0 || c + 1 == grid.cols;
        const Vec3 way = (at(position, r + 1, c) - at(position, r, c)).normalized();
        loads.v[node] = pull.dot(way) / (hx * (border_col ? border_share : 1.0) * tearing.weft);
      }
    }
  }
  return loads;
}

template <class Real>
bool surely_holds(const Springs<Real>& springs, const VectorField<Real>& position,
                  const TearingEffect& tearing) {
  if (springs.torn() != nullptr) return false;
  const Family<Real> along_u(springs, 0, 1), along_v(springs, 1, 0), falling(springs, 1, 1);
  if (along_u.family == nullptr || along_v.family == nullptr) return true;
  // With all springs longer by the strain e a link bears at most e times this, a share of its strength: its
  // own force and, all in its direction, four halves of a diagonal's.
  const auto force = [](const SpringFamily* family) {
    return family == nullptr ? 0.0 : family->stiffness * family->limit.stiffening * family->rest_length;
  };
  const double hx = along_u.family->rest_length, hy = along_v.family->rest_length;
  const double slanting = 2 * force(falling.family);
  const double u = (force(along_u.family) + slanting) / (hy * tearing.warp);
  const double v = (force(along_v.family) + slanting) / (hx * tearing.weft);
  const double strain = 0.99 / std::max(u, v);  // the rest for rounding
  const Grid& grid = position.grid();
  Real most = 0;  // squared length over the rest length's
  for (const SpringFamily& family : springs.families()) {
    if (family.rows > 1 || family.cols > 1) continue;
    const auto scale = static_cast<Real>(1 / (family.rest_length * family.rest_length));
    const int begin = std::max(0, -family.cols), end = grid.cols - std::max(0, family.cols);
    for (int r = 0; r + family.rows < grid.rows; ++r) {
      const Real *x0 = position.x.row(r), *x1 = position.x.row(r + family.rows) + family.cols;
      const Real *y0 = position.y.row(r), *y1 = position.y.row(r + family.rows) + family.cols;
      const Real *z0 = position.z.row(r), *z1 = position.z.row(r + family.rows) + family.cols;
      for (int c = begin; c < end; ++c) {
        const Real dx = x1[c] - x0[c], dy = y1[c] - y0[c], dz = z1[c] - z0[c];
        const Real squared = scale * (dx * dx + dy * dy + dz * dz);
        most = squared > most ? squared : most;
      }
    }
  }
  return std::sqrt(double(most)) <= 1 + strain;
}

namespace {

/// Loads by link; one beyond the grid bears nothing.
class Loaded {
 public:
  explicit Loaded(const LinkLoads& loads) : loads_(loads) {}
  double of(const Link& link) const {
    const Grid& grid = loads_.grid;
    if (link.row < 0 || link.col < 0 || link.row >= grid.rows || link.col >= grid.cols) return 0;
    return (link.along_u ? loads_.u : loads_.v)[loads_.index(link.row, link.col)];
  }
  /// Calls visit(link, load) for every link that bears more than its strength.
  template <class Visit>
  void for_each_beyond(Visit visit) const {
    for (int r = 0; r < loads_.grid.rows; ++r) {
      for (int c = 0; c < loads_.grid.cols; ++c) {
        for (const bool along_u : {true, false}) {
          const Link link{r, c, along_u};
          if (of(link) > 1) visit(link, of(link));
        }
      }
    }
  }

 private:
  const LinkLoads& loads_;
};

}  // namespace

std::vector<Link> links_to_break(const LinkLoads& loads, const TornLinks* torn) {
  const Loaded loaded(loads);
  const Grid& grid = loads.grid;
  std::vector<Link> breaking;
  Link weakest;
  double most = 1;
  /// Whether the link is loaded most of its face, which is a tear's end.
  const auto runs_on = [&](const Link& link, double load, int r, int c) {
    if (r < 0 || c < 0 || r + 1 >= grid.rows || c + 1 >= grid.cols || torn->lost_edges(r, c) != 1)
      return false;
    const std::array<Link, 4> edges{{{r, c, true}, {r, c, false}, {r, c + 1, false}, {r + 1, c, true}}};
    const auto* const first = std::max_element(edges.begin(), edges.end(), [&](const Link& a, const Link& b) {
      return loaded.of(a) < loaded.of(b);
    });
    return load > 1 && *first == link;
  };
  loaded.for_each_beyond([&](const Link& link, double load) {
    if (load > most) {
      most = load;
      weakest = link;
    }
    const int dr = link.along_u ? 0 : 1, dc = 1 - dr;
    const bool at_end = torn != nullptr && (runs_on(link, load, link.row, link.col) ||
                                            runs_on(link, load, link.row - dc, link.col - dr));
    const bool overloaded = load > kOverload &&
                            load > loaded.of({link.row - dr, link.col - dc, link.along_u}) &&
                            load >= loaded.of({link.row + dr, link.col + dc, link.along_u});
    if (at_end || overloaded) breaking.push_back(link);
  });
  if (breaking.empty() && most > 1) breaking.push_back(weakest);
  return breaking;
}

template bool surely_holds(const Springs<float>&, const VectorField<float>&, const TearingEffect&);
template bool surely_holds(const Springs<double>&, const VectorField<double>&, const TearingEffect&);
template LinkLoads link_loads(const Springs<float>&, const VectorField<float>&, const TearingEffect&);
template LinkLoads link_loads(const Springs<double>&, const VectorField<double>&, const TearingEffect&);

}  // namespace weft
