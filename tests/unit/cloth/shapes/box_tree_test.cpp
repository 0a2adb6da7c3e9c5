#include "cloth/shapes/box_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>
#include <utility>

namespace weft {
namespace {

using IndexPairs = std::set<std::pair<int, int>>;

std::vector<Eigen::AlignedBox3d> random_boxes(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<double, 6> number{};
    for (double& each : number) each = uniform(random);
    const Vec3 low(number[0], number[1], number[2]), size(number[3], number[4], number[5]);
    boxes.emplace_back(low, low + size / 2);
  }
  return boxes;
}

void fill(BoxTree& tree, const std::vector<Eigen::AlignedBox3d>& boxes) {
  tree.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) tree.set(i, boxes[i]);
  tree.update();
}

IndexPairs found_pairs(BoxTree& a, BoxTree& b) {
  IndexPairs pairs;
  a.manager().collide(
      &b.manager(), &pairs, [](fcl::CollisionObjectd* first, fcl::CollisionObjectd* second, void* data) {
        static_cast<IndexPairs*>(data)->emplace(BoxTree::index_of(first), BoxTree::index_of(second));
        return false;
      });
  return pairs;
}

IndexPairs overlapping(const std::vector<Eigen::AlignedBox3d>& a, const std::vector<Eigen::AlignedBox3d>& b) {
  IndexPairs pairs;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (a[i].intersects(b[j])) pairs.emplace(static_cast<int>(i), static_cast<int>(j));
    }
  }
  return pairs;
}

// As they are put first, as they are moved, and as there are more or fewer.
TEST(BoxTree, FindsTheBoxesThatOverlap) {
  BoxTree a, b;
  for (const auto& [count, seed] : {std::pair{40, 1}, {40, 2}, {40, 3}, {25, 4}, {60, 5}}) {
    const auto boxes = random_boxes(static_cast<std::size_t>(count), static_cast<std::uint64_t>(seed)),
               others = random_boxes(30, static_cast<std::uint64_t>(100 + seed));
    fill(a, boxes);
    fill(b, others);
    const IndexPairs expected = overlapping(boxes, others);
    EXPECT_GT(expected.size(), 20U);
    EXPECT_EQ(found_pairs(a, b), expected) << seed;
  }
}

}  // namespace
}  // namespace weft
