#pragma once
#include <cstddef>
#include <numeric>
#include <vector>

namespace weft {

/// Sets that are joined step by step (disjoint-set forest, path halving: Tarjan and van Leeuwen, 1984).
class DisjointSets {
 public:
  /// Each of one member.
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  /// The one that stands for all of its set.
  std::size_t of(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) { parent_[of(i)] = of(j); }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace weft
