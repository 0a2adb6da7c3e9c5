#include "cloth/contact/broad_phase.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/collision_object.h>

#include <algorithm>
#include <cmath>

#include "cloth/kernels/contact_kernels.h"

namespace weft {
namespace {

/// A box in FCL's tree, resized and moved in place.
class TreeBox {
 public:
  explicit TreeBox(int index) : index_(index), shape_(std::make_shared<fcl::Boxd>(1, 1, 1)), object_(shape_) {
    object_.setUserData(&index_);
  }
  TreeBox(const TreeBox&) = delete;  // FCL keeps pointers to the object and to its user data.
  TreeBox& operator=(const TreeBox&) = delete;

  void set(const Vec3& low, const Vec3& high) {
    shape_->side = high - low;
    shape_->computeLocalAABB();
    object_.setTranslation(0.5 * (low + high));
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
  void set(std::size_t i, const Vec3& low, const Vec3& high) { boxes_[i]->set(low, high); }
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

/// Extent of one component over each column of a row of tiles.
template <class Real>
struct ColumnExtents {
  std::vector<Real, AlignedAllocator<Real>> low, high;

  explicit ColumnExtents(int cols)
      : low(static_cast<std::size_t>(cols)), high(static_cast<std::size_t>(cols)) {}
  void of_rows(const Field<Real>& field, int row_begin, int row_end) {
    kernels::column_extents(field.row(row_begin), row_end - row_begin, field.grid().stride, field.grid().cols,
                            low.data(), high.data());
  }
  double lowest(const Tile& tile) const {
    Real least = low[static_cast<std::size_t>(tile.col_begin)];
    for (int c = tile.col_begin + 1; c < tile.col_end; ++c)
      least = std::min(least, low[static_cast<std::size_t>(c)]);
    return double(least);
  }
  double highest(const Tile& tile) const {
    Real most = high[static_cast<std::size_t>(tile.col_begin)];
    for (int c = tile.col_begin + 1; c < tile.col_end; ++c)
      most = std::max(most, high[static_cast<std::size_t>(c)]);
    return double(most);
  }
};

}  // namespace

template <class Real>
struct BroadPhase<Real>::Impl {
  explicit Impl(const Grid& grid) : tiles(tiles_of(grid)), x(grid.cols), y(grid.cols), z(grid.cols) {
    tile_tree.resize(tiles.size());
  }

  /// False if a tile has no finite extent.
  bool fit_tiles(const VectorField<Real>& position) {
    int row = -1;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      const Tile& tile = tiles[i];
      if (tile.row_begin != row) {
        row = tile.row_begin;
        x.of_rows(position.x, tile.row_begin, tile.row_end);
        y.of_rows(position.y, tile.row_begin, tile.row_end);
        z.of_rows(position.z, tile.row_begin, tile.row_end);
      }
      const Vec3 low(x.lowest(tile), y.lowest(tile), z.lowest(tile));
      const Vec3 high(x.highest(tile), y.highest(tile), z.highest(tile));
      if (!low.allFinite() || !high.allFinite()) return false;
      tile_tree.set(i, low, high);
    }
    tile_tree.update();
    return true;
  }

  /// False if a ball has no finite place.
  bool fit_balls(const std::vector<Ball>& balls, double from, double to) {
    ball_tree.resize(balls.size());
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const Vec3 a = balls[i].at(from), b = balls[i].at(to);
      if (!a.allFinite() || !b.allFinite()) return false;
      const Vec3 reach = Vec3::Constant(balls[i].radius);
      ball_tree.set(i, a.cwiseMin(b) - reach, a.cwiseMax(b) + reach);
    }
    ball_tree.update();
    return true;
  }

  std::vector<Tile> tiles;
  ColumnExtents<Real> x, y, z;
  Tree tile_tree, ball_tree;
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
  if (balls.empty() || !impl_->fit_tiles(position) || !impl_->fit_balls(balls, from, to)) return impl_->pairs;
  impl_->tile_tree.manager().collide(&impl_->ball_tree.manager(), &impl_->pairs, collect);
  // The tree's traversal depends on its history; the contacts must not.
  std::sort(impl_->pairs.begin(), impl_->pairs.end(), [](const TileBallPair& a, const TileBallPair& b) {
    return a.tile != b.tile ? a.tile < b.tile : a.ball < b.ball;
  });
  return impl_->pairs;
}

template class BroadPhase<float>;
template class BroadPhase<double>;

}  // namespace weft
