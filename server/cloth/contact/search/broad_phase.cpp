#include "cloth/contact/search/broad_phase.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "cloth/kernels/extent_kernels.h"
#include "cloth/kernels/node_kernels.h"
#include "cloth/shapes/box_tree.h"

namespace weft {
namespace {

using AlignedBox = Eigen::AlignedBox3d;

/// By how much the boxes in the trees are larger than what they hold, relative to the largest tile: a cloth
/// moving at 5 m/s in substeps of 0.1 ms is fitted anew every tenth of them, one at rest never.
constexpr double kTileMargin = 1.0 / 32;

/// Beyond the boxes at its two ends, m: points of a solid that turns go along arcs, not chords.
double bulge(const Solid& solid, const Sweep& sweep) {
  if (!solid.turns()) return 0;
  const double angle = (sweep.to - sweep.from) * solid.turn.norm();
  return outer_radius(solid.shape) * (angle < std::numbers::pi ? 1 - std::cos(angle / 2) : 2);
}

AlignedBox grown(const AlignedBox& box, double by) {
  return {box.min() - Vec3::Constant(by), box.max() + Vec3::Constant(by)};
}

/// FCL calls it for each tile and solid whose boxes overlap, in the order of its traversal.
bool add_pair(fcl::CollisionObjectd* tile, fcl::CollisionObjectd* solid, void* pairs) {
  static_cast<std::vector<TileSolidPair>*>(pairs)->push_back(
      {BoxTree::index_of(tile), BoxTree::index_of(solid)});
  return false;  // go on
}

std::vector<Tile> tiles_of(const Grid& grid) {
  std::vector<Tile> tiles;
  for (int r = 0; r + 1 < grid.rows; r += kTileCells) {
    for (int c = 0; c + 1 < grid.cols; c += kTileCells) {
      tiles.push_back(
          {r, std::min(r + kTileCells + 1, grid.rows), c, std::min(c + kTileCells + 1, grid.cols)});
    }
  }
  return tiles;
}

template <class Real>
AlignedBox box_of(const Tile& tile, const VectorField<Real>& position) {
  const int rows = tile.row_end - tile.row_begin, cols = tile.col_end - tile.col_begin;
  std::array<Real, kTileCells + 1> low{}, high{};  // of each column
  AlignedBox box;
  int axis = 0;
  for (const Field<Real>* field : {&position.x, &position.y, &position.z}) {
    kernels::column_extents(field->row(tile.row_begin) + tile.col_begin, rows, field->grid().stride, cols,
                            low.data(), high.data());
    box.min()[axis] = double(*std::min_element(low.begin(), low.begin() + cols));
    box.max()[axis] = double(*std::max_element(high.begin(), high.begin() + cols));
    ++axis;
  }
  return box;
}

}  // namespace

template <class Real>
struct BroadPhase<Real>::Impl {
  explicit Impl(const Grid& grid) : tiles(tiles_of(grid)) { tile_tree.resize(tiles.size()); }

  /// Brings the trees and what overlaps in them up to date. Boxes are larger than what they hold by a margin,
  /// and stay as long as they hold it: from one substep to the next little moves. False if something has no
  /// finite place.
  bool update(const VectorField<Real>& position, const std::vector<Solid>& solids, const Sweep& sweep) {
    const bool tiles_hold = tiles_still_hold(position);
    if (!tiles_hold && !fit_tiles(position)) return false;
    place_solids(solids, sweep);
    const bool solids_hold = solids_still_hold();
    if (!solids_hold && !fit_solids()) return false;
    if (tiles_hold && solids_hold) return true;
    candidates.clear();
    tile_tree.manager().collide(&solid_tree.manager(), &candidates, add_pair);
    for (TileSolidPair& pair : candidates) pair.solid = bounded[static_cast<std::size_t>(pair.solid)];
    for (int tile = 0; tile < static_cast<int>(tiles.size()); ++tile) {
      for (const HalfSpaceBelow& half_space : half_spaces) candidates.push_back({tile, half_space.solid});
    }
    // The tree's traversal depends on its history; the contacts must not.
    std::sort(candidates.begin(), candidates.end(), [](const TileSolidPair& a, const TileSolidPair& b) {
      return a.tile != b.tile ? a.tile < b.tile : a.solid < b.solid;
    });
    return true;
  }

  bool tiles_still_hold(const VectorField<Real>& position) const {
    return fitted_positions.grid() == position.grid() &&
           kernels::all_within(kernels::components(position), kernels::components(fitted_positions),
                               static_cast<Real>(margin), position.grid().size());
  }

  bool fit_tiles(const VectorField<Real>& position) {
    fitted_positions = VectorField<Real>();
    std::vector<AlignedBox> boxes;
    double largest = 0;
    for (const Tile& tile : tiles) {
      const AlignedBox box = box_of(tile, position);
      if (!box.min().allFinite() || !box.max().allFinite()) return false;
      largest = std::max(largest, box.sizes().maxCoeff());
      boxes.push_back(box);
    }
    margin = kTileMargin * largest;
    for (std::size_t i = 0; i < boxes.size(); ++i) tile_tree.set(i, grown(boxes[i], margin));
    tile_tree.update();
    fitted_positions = position;
    return true;
  }

  void place_solids(const std::vector<Solid>& solids, const Sweep& sweep) {
    const std::size_t bounded_before = bounded.size(), half_spaces_before = half_spaces.size();
    solid_boxes.assign(solids.size(), AlignedBox());
    bounded.clear();
    half_spaces.clear();
    for (std::size_t i = 0; i < solids.size(); ++i) {
      const PlacedShape from = solids[i].placed(sweep.from), to = solids[i].placed(sweep.to);
      if (std::holds_alternative<HalfSpace>(to.shape)) {
        const Vec3 normal = to.rotation.col(1);
        half_spaces.push_back({static_cast<int>(i), normal, normal.dot(to.centre)});
        continue;
      }
      solid_boxes[i] = grown(from.bounds().merged(to.bounds()), sweep.reach + bulge(solids[i], sweep));
      bounded.push_back(static_cast<int>(i));
    }
    if (bounded.size() != bounded_before || half_spaces.size() != half_spaces_before) fitted_solids.clear();
  }

  bool solids_still_hold() const {
    if (fitted_solids.size() != solid_boxes.size()) return false;
    return std::all_of(bounded.begin(), bounded.end(), [&](int i) {
      const auto solid = static_cast<std::size_t>(i);
      return fitted_solids[solid].contains(solid_boxes[solid]);
    });
  }

  bool fit_solids() {
    fitted_solids.clear();
    solid_tree.resize(bounded.size());
    std::vector<AlignedBox> fitted(solid_boxes.size());
    for (std::size_t i = 0; i < bounded.size(); ++i) {
      const auto solid = static_cast<std::size_t>(bounded[i]);
      if (!solid_boxes[solid].min().allFinite() || !solid_boxes[solid].max().allFinite()) return false;
      fitted[solid] = grown(solid_boxes[solid], margin);
      solid_tree.set(i, fitted[solid]);
    }
    solid_tree.update();
    fitted_solids = std::move(fitted);
    return true;
  }

  /// Those of the candidates that overlap without the margin.
  void select(const VectorField<Real>& position) {
    AlignedBox tile_box;
    int boxed = -1;
    for (const TileSolidPair& pair : candidates) {
      if (pair.tile != boxed) {
        tile_box = box_of(tiles[static_cast<std::size_t>(pair.tile)], position);
        boxed = pair.tile;
      }
      if (overlaps(tile_box, pair.solid)) pairs.push_back(pair);
    }
  }

  bool overlaps(const AlignedBox& tile, int solid) const {
    const auto half_space = std::find_if(half_spaces.begin(), half_spaces.end(),
                                         [&](const HalfSpaceBelow& h) { return h.solid == solid; });
    if (half_space == half_spaces.end()) return tile.intersects(solid_boxes[static_cast<std::size_t>(solid)]);
    const Vec3 half = tile.sizes() / 2;
    return half_space->normal.dot(tile.center()) - half_space->normal.cwiseAbs().dot(half) <
           half_space->offset;
  }

  /// All points whose product with the normal is less than the offset.
  struct HalfSpaceBelow {
    int solid;
    Vec3 normal;
    double offset;
  };

  std::vector<Tile> tiles;
  BoxTree tile_tree, solid_tree;
  VectorField<Real> fitted_positions;   ///< of the nodes, when the tiles' solid_boxes were fitted to them
  double margin = 0;                    ///< by which the trees' solid_boxes are larger on each side, m
  std::vector<AlignedBox> solid_boxes;  ///< of the solids on their ways, by solid
  std::vector<int> bounded;             ///< solids in the tree
  std::vector<HalfSpaceBelow> half_spaces;
  std::vector<AlignedBox> fitted_solids;  ///< the tree's solid_boxes, by solid
  std::vector<TileSolidPair> candidates;  ///< whose solid_boxes in the trees overlap
  std::vector<TileSolidPair> pairs;
};

template <class Real>
BroadPhase<Real>::BroadPhase(const Grid& grid) : impl_(std::make_unique<Impl>(grid)) {}
template <class Real>
BroadPhase<Real>::~BroadPhase() = default;
template <class Real>
BroadPhase<Real>::BroadPhase(BroadPhase&&) noexcept = default;
template <class Real>
BroadPhase<Real>& BroadPhase<Real>::operator=(BroadPhase&&) noexcept = default;

template <class Real>
const std::vector<Tile>& BroadPhase<Real>::tiles() const {
  return impl_->tiles;
}

template <class Real>
const std::vector<TileSolidPair>& BroadPhase<Real>::find_pairs(const VectorField<Real>& position,
                                                               const std::vector<Solid>& solids,
                                                               const Sweep& sweep) {
  impl_->pairs.clear();
  // A tree of solid_boxes that are not finite need not end; the step's own check reports such a state.
  if (!solids.empty() && impl_->update(position, solids, sweep)) impl_->select(position);
  return impl_->pairs;
}

template class BroadPhase<float>;
template class BroadPhase<double>;

}  // namespace weft
