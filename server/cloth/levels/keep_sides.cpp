#include "cloth/levels/keep_sides.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cloth/kernels/node_vector.h"
#include "cloth/levels/chord.h"

namespace weft {
namespace {

/// Times that all chords are moved out, one after the other, at most; until none goes farther than this share
/// of the farthest way of the first time.
constexpr int kSweeps = 300;
constexpr double kClose = 1e-3;
/// Inner radii of a solid: deeper in it, the nearest way out says little about where a chord was.
constexpr double kDeep = 0.5;
/// Of a fine cell's side, in inner radii, and at most.
constexpr double kParts = 1;
constexpr int kMostParts = 4;

/// m.
template <class Real>
Vec3 place_of(const Chord& chord, const Particles<Real>& particles) {
  Vec3 sum(0, 0, 0);
  for (std::size_t i = 0; i < 4; ++i) {
    if (chord.weight[i] != 0)
      sum += chord.weight[i] * at(kernels::components(particles.position), chord.node[i]);
  }
  return sum;
}

/// By the free nodes, as they weigh in it; not if none is free.
template <class Real>
void move(const Chord& chord, const Vec3& way, Particles<Real>& particles) {
  const auto& inverse_mass = particles.inverse_mass.values();
  std::array<double, 4> free{};
  double share = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (inverse_mass[chord.node[i]] > Real(0)) free[i] = chord.weight[i];
    share += free[i] * free[i];
  }
  if (share == 0) return;
  for (std::size_t i = 0; i < 4; ++i) {
    if (free[i] != 0)
      add(kernels::components(particles.position), chord.node[i], Vec3(free[i] / share * way));
  }
}

/// A chord beside a solid, which may have come to pass it on its other side.
struct Passing {
  Chord chord;
  const PlacedShape* shape;
  Vec3 was;           ///< where the finer sheet had it, m
  Surface surface{};  ///< next to it
  bool wrong = false;

  /// How far the chord is below the plane that touches the solid next to where it was, m.
  double below(const Vec3& chord_now) const {
    return -(surface.normal.dot(chord_now - was) + surface.distance);
  }
};

/// The chord passes the solid on its other side, or might.
bool is_wrong(const Passing& passing, double below, const Vec3& chord_now) {
  const PlacedShape& shape = *passing.shape;
  return below > kDeep * inner_radius(shape.shape) ||
         shape.surface(chord_now).normal.dot(passing.surface.normal) < 0;
}

/// The parts of a fine cell's sides between which the sheet is looked at: shorter than the solid is thin.
template <class Real>
int parts_of_cell(const Particles<Real>& fine, const Shape& shape) {
  const double cell = (fine.local_position_at(0, 1) - fine.local_position_at(0, 0)).norm();
  return static_cast<int>(
      std::clamp(std::ceil(kParts * cell / inner_radius(shape)), 1.0, double(kMostParts)));
}

template <class Real>
void add_chords_near(const PlacedShape& shape, const Particles<Real>& fine, const Particles<Real>& coarse,
                     std::vector<Passing>& near) {
  const int parts = parts_of_cell(fine, shape.shape),
            stride = parts * (fine.grid().rows - 1) / (coarse.grid().rows - 1);
  for (int row = 0; row <= parts * (fine.grid().rows - 1); ++row) {
    for (int col = 0; col <= parts * (fine.grid().cols - 1); ++col) {
      if (row % stride == 0 && col % stride == 0) continue;
      Passing passing{chord_of(row, col, stride, coarse.grid()), &shape,
                      place_of(chord_of(row, col, parts, fine.grid()), fine)};
      const double moved = (place_of(passing.chord, coarse) - passing.was).norm();
      if (!shape.may_touch(passing.was, moved)) continue;
      passing.surface = shape.surface(passing.was);
      if (passing.surface.distance < moved) near.push_back(passing);
    }
  }
}

}  // namespace

template <class Real>
bool keep_sides(const Particles<Real>& fine, const std::vector<Solid>& solids, Particles<Real>& coarse) {
  std::vector<PlacedShape> shapes;
  shapes.reserve(solids.size());
  for (const Solid& solid : solids) shapes.push_back(solid.placed(0));
  std::vector<Passing> near;
  for (const PlacedShape& shape : shapes) {
    if (std::isfinite(inner_radius(shape.shape))) add_chords_near(shape, fine, coarse, near);
  }
  double farthest = 0;  // in the first sweep, m
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double way = 0;
    for (Passing& passing : near) {
      const Vec3 now = place_of(passing.chord, coarse);
      const double below = passing.below(now);
      if (below <= 0) continue;
      passing.wrong = passing.wrong || is_wrong(passing, below, now);
      if (!passing.wrong) continue;
      move(passing.chord, below * passing.surface.normal, coarse);
      way = std::max(way, below);
    }
    if (sweep == 0) farthest = way;
    if (way <= kClose * farthest) break;
  }
  return farthest > 0;
}

template bool keep_sides(const Particles<float>&, const std::vector<Solid>&, Particles<float>&);
template bool keep_sides(const Particles<double>&, const std::vector<Solid>&, Particles<double>&);

}  // namespace weft
