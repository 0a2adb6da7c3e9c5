#include "cloth/contact/broad_phase.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/collision_object.h>

#include <algorithm>
#include <array>
#include <vector>

#include "cloth/kernels/contact_kernels.h"
#include "cloth/kernels/node_kernels.h"

namespace weft {
namespace {

using Box = Eigen::AlignedBox3d;

/// By how much the boxes in the trees are larger than what they hold, relative to the largest tile: a cloth
/// moving at 5 m/s in substeps of 0.1 ms is fitted anew every tenth of them, one at rest never.
constexpr double kMargin = 1.0 / 32;

Box grown(const Box& box, double by) {
  return {box.min() - Vec3::Constant(by), box.max() + Vec3::Constant(by)};
}

/// A box in FCL's tree, resized and moved in place.
class TreeBox {
 public:
  explicit TreeBox(int index) : index_(index), shape_(std::make_shared<fcl::Boxd>(1, 1, 1)), object_(shape_) {
    object_.setUserData(&index_);
  }
  TreeBox(const TreeBox&) = delete;  // FCL keeps pointers to the object and to its user data.
  TreeBox& operator=(const TreeBox&) = delete;

  void set(const Box& box) {
    shape_->side = box.sizes();
    shape_->computeLocalAABB();
    object_.setTranslation(box.center());
    object_.computeAABB();
  }
  fcl::CollisionObjectd* object() { return &object_; }

 private:
  int index_;
  std::shared_ptr<fcl::Boxd> shape_;
  fcl::CollisionObjectd object_;
};

/// A set of boxes under one tree.
class Tree {
 public:
  /// Makes it hold `count` boxes; their extents are then to be set before update().
  void resize(std::size_t count) {
    if (boxes_.size() == count) return;
    manager_.clear();
    boxes_.clear();
    registered_ = false;
    for (std::size_t i = 0; i < count; ++i) boxes_.push_back(std::make_unique<TreeBox>(static_cast<int>(i)));
  }
  void set(std::size_t i, const Box& box) { boxes_[i]->set(box); }
  /// Fits the tree to the boxes; it is built when they first have their places, which makes it a good one.
  void update() {
    if (registered_) {
      manager_.update();
      return;
    }
    std::vector<fcl::CollisionObjectd*> objects;
    for (const auto& box : boxes_) objects.push_back(box->object());
    manager_.registerObjects(objects);
    manager_.setup();
    registered_ = true;
  }
  fcl::DynamicAABBTreeCollisionManagerd& manager() { return manager_; }

 private:
  std::vector<std::unique_ptr<TreeBox>> boxes_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
  bool registered_ = false;
};

int index_of(const fcl::CollisionObjectd* object) { return *static_cast<const int*>(object->getUserData()); }

/// FCL calls it for each tile and ball whose boxes overlap, in the order of its traversal.
bool collect(fcl::CollisionObjectd* tile, fcl::CollisionObjectd* ball, void* pairs) {
  static_cast<std::vector<TileBallPair>*>(pairs)->push_back({index_of(tile), index_of(ball)});
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
Box box_of(const Tile& tile, const VectorField<Real>& position) {
  const int rows = tile.row_end - tile.row_begin, cols = tile.col_end - tile.col_begin;
  std::array<Real, kTileCells + 1> low{}, high{};  // of each column
  Box box;
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
  bool update(const VectorField<Real>& position, const std::vector<Ball>& balls, double from, double to) {
    const bool tiles_hold = tiles_still_hold(position);
    if (!tiles_hold && !fit_tiles(position)) return false;
    place_balls(balls, from, to);
    const bool balls_hold = balls_still_hold();
    if (!balls_hold && !fit_balls()) return false;
    if (tiles_hold && balls_hold) return true;
    candidates.clear();
    tile_tree.manager().collide(&ball_tree.manager(), &candidates, collect);
    // The tree's traversal depends on its history; the contacts must not.
    std::sort(candidates.begin(), candidates.end(), [](const TileBallPair& a, const TileBallPair& b) {
      return a.tile != b.tile ? a.tile < b.tile : a.ball < b.ball;
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
    std::vector<Box> boxes;
    double largest = 0;
    for (const Tile& tile : tiles) {
      const Box box = box_of(tile, position);
      if (!box.min().allFinite() || !box.max().allFinite()) return false;
      largest = std::max(largest, box.sizes().maxCoeff());
      boxes.push_back(box);
    }
    margin = kMargin * largest;
    for (std::size_t i = 0; i < boxes.size(); ++i) tile_tree.set(i, grown(boxes[i], margin));
    tile_tree.update();
    fitted_positions = position;
    return true;
  }

  void place_balls(const std::vector<Ball>& balls, double from, double to) {
    ball_boxes.clear();
    for (const Ball& ball : balls) {
      const Vec3 a = ball.at(from), b = ball.at(to);
      ball_boxes.push_back(grown(Box(a.cwiseMin(b), a.cwiseMax(b)), ball.radius));
    }
  }

  bool balls_still_hold() const {
    return std::equal(fitted_balls.begin(), fitted_balls.end(), ball_boxes.begin(), ball_boxes.end(),
                      [](const Box& fitted, const Box& now) { return fitted.contains(now); });
  }

  bool fit_balls() {
    fitted_balls.clear();
    ball_tree.resize(ball_boxes.size());
    for (std::size_t i = 0; i < ball_boxes.size(); ++i) {
      const Box& box = ball_boxes[i];
      if (!box.min().allFinite() || !box.max().allFinite()) {
        fitted_balls.clear();
        return false;
      }
      fitted_balls.push_back(grown(box, margin));
      ball_tree.set(i, fitted_balls.back());
    }
    ball_tree.update();
    return true;
  }

  /// Those of the candidates whose boxes overlap without the margin.
  void select(const VectorField<Real>& position) {
    Box tile_box;
    int boxed = -1;
    for (const TileBallPair& pair : candidates) {
      if (pair.tile != boxed) {
        tile_box = box_of(tiles[static_cast<std::size_t>(pair.tile)], position);
        boxed = pair.tile;
      }
      if (tile_box.intersects(ball_boxes[static_cast<std::size_t>(pair.ball)])) pairs.push_back(pair);
    }
  }

  std::vector<Tile> tiles;
  Tree tile_tree, ball_tree;
  VectorField<Real> fitted_positions;    ///< of the nodes, when the tiles' boxes were fitted to them
  double margin = 0;                     ///< by which the trees' boxes are larger on each side, m
  std::vector<Box> ball_boxes;           ///< of the balls on their way
  std::vector<Box> fitted_balls;         ///< the tree's
  std::vector<TileBallPair> candidates;  ///< whose boxes in the trees overlap
  std::vector<TileBallPair> pairs;
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
const std::vector<TileBallPair>& BroadPhase<Real>::find_pairs(const VectorField<Real>& position,
                                                              const std::vector<Ball>& balls, double from,
                                                              double to) {
  impl_->pairs.clear();
  // A tree of boxes that are not finite need not end; the step's own check reports such a state.
  if (!balls.empty() && impl_->update(position, balls, from, to)) impl_->select(position);
  return impl_->pairs;
}

template class BroadPhase<float>;
template class BroadPhase<double>;

}  // namespace weft
