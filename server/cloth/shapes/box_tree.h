#pragma once
// Heavy: FCL's headers. For .cpp files only.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/collision_object.h>

#include <memory>
#include <vector>

#include "cloth/core/vec3.h"

namespace weft {

/// A box in FCL's tree, resized and moved in place.
class TreeBox {
 public:
  explicit TreeBox(int index) : index_(index), shape_(std::make_shared<fcl::Boxd>(1, 1, 1)), object_(shape_) {
    object_.setUserData(&index_);
  }
  TreeBox(const TreeBox&) = delete;  // FCL keeps pointers to the object and to its user data.
  TreeBox& operator=(const TreeBox&) = delete;

  void set(const Eigen::AlignedBox3d& box) {
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

/// A set of boxes under one of FCL's dynamic AABB trees. None may be without finite corners.
class BoxTree {
 public:
  /// Makes it hold `count` boxes; their extents are then to be set before update().
  void resize(std::size_t count) {
    if (boxes_.size() == count) return;
    manager_.clear();
    boxes_.clear();
    registered_ = false;
    for (std::size_t i = 0; i < count; ++i) boxes_.push_back(std::make_unique<TreeBox>(static_cast<int>(i)));
  }
  void set(std::size_t i, const Eigen::AlignedBox3d& box) { boxes_[i]->set(box); }
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
  /// Which of a tree's boxes the object is.
  static int index_of(const fcl::CollisionObjectd* object) {
    return *static_cast<const int*>(object->getUserData());
  }

 private:
  std::vector<std::unique_ptr<TreeBox>> boxes_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
  bool registered_ = false;
};

}  // namespace weft
