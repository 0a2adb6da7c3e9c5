#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "cloth/contact/search/features.h"
#include "cloth/core/grid.h"

namespace weft {

/// The cloths that are stepped together, each a part, in order. Their nodes are numbered in three ways: in
/// their cloth's own arrays, in LayerNodes, and here, one part after the other.
class LayerParts {
 public:
  struct Part {
    Grid grid;
    std::uint32_t first = 0;   ///< its first node in LayerNodes
    double gap = 0;            ///< between layers of it, m
    std::uint32_t offset = 0;  ///< its first node here
    /// One behind its last node in LayerNodes.
    std::uint32_t end() const { return first + static_cast<std::uint32_t>(grid.size()); }
  };
  /// `offset` is computed.
  explicit LayerParts(std::vector<Part> parts) : parts_(std::move(parts)) {
    for (Part& part : parts_) {
      part.offset = nodes_;
      nodes_ += static_cast<std::uint32_t>(part.grid.size());
    }
  }

  std::size_t size() const { return parts_.size(); }
  const Part& operator[](std::size_t part) const { return parts_[part]; }
  std::vector<Part>::const_iterator begin() const { return parts_.begin(); }
  std::vector<Part>::const_iterator end() const { return parts_.end(); }
  /// Of all parts.
  std::uint32_t nodes() const { return nodes_; }
  /// The part that a node of LayerNodes belongs to, if any.
  std::optional<std::size_t> part_of(std::uint32_t node) const {
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      if (node >= parts_[part].first && node < parts_[part].end()) return part;
    }
    return std::nullopt;
  }
  /// Of a node as it is numbered here.
  std::size_t part_of_joined(std::uint32_t node) const {
    std::size_t part = parts_.size() - 1;
    while (node < parts_[part].offset) --part;
    return part;
  }
  /// To be kept between what belongs to two parts, m.
  double gap(std::size_t one, std::size_t other) const {
    return std::min(parts_[one].gap, parts_[other].gap);
  }

 private:
  std::vector<Part> parts_;
  std::uint32_t nodes_ = 0;
};

}  // namespace weft
