#pragma once
#include <memory>
#include <vector>

#include "cloth/core/particles.h"
#include "cloth/shapes/solid.h"

namespace weft {

/// A block of up to kTileCells x kTileCells cells; neighbours share their border nodes.
struct Tile {
  int row_begin = 0, row_end = 0;  ///< nodes [begin, end)
  int col_begin = 0, col_end = 0;
};
inline constexpr int kTileCells = 8;

/// Tile `tile` and solid `solid` (index into Colliders::solids) may touch: their boxes overlap.
struct TileSolidPair {
  int tile = 0;
  int solid = 0;
};

/// A part of a step, as fractions 0..1 of it, and how far nodes may come from beyond their tile's box in it,
/// m.
struct Sweep {
  double from = 0, to = 1;
  double reach = 0;
};

/// The paper's section 2.4, first half: a hierarchy of axis-aligned boxes over cloth tiles and solids (FCL's
/// dynamic AABB tree) removes the parts that cannot touch. One per cloth and level; FCL is seen only by its
/// .cpp.
template <class Real>
class BroadPhase {
 public:
  explicit BroadPhase(const Grid& grid);
  ~BroadPhase();
  BroadPhase(BroadPhase&&) noexcept;
  BroadPhase& operator=(BroadPhase&&) noexcept;

  const std::vector<Tile>& tiles() const;
  /// The pairs whose boxes overlap, solids swept over their ways, ordered by tile, then solid. Half-spaces,
  /// which no box holds, are compared with every tile. Valid until the next call.
  const std::vector<TileSolidPair>& find_pairs(const VectorField<Real>& position,
                                               const std::vector<Solid>& solids, const Sweep& sweep);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

extern template class BroadPhase<float>;
extern template class BroadPhase<double>;

}  // namespace weft
