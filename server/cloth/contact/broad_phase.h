#pragma once
#include <memory>
#include <vector>

#include "cloth/colliders.h"
#include "cloth/particles.h"

namespace weft {

/// A block of up to kTileCells x kTileCells cells; neighbours share their border nodes.
struct Tile {
  int row_begin = 0, row_end = 0;  ///< nodes [begin, end)
  int col_begin = 0, col_end = 0;
};
inline constexpr int kTileCells = 8;

/// Tile `tile` and ball `ball` (index into Colliders::balls) may touch: their boxes overlap.
struct TileBallPair {
  int tile = 0;
  int ball = 0;
};

/// The paper's section 2.4, first half: a hierarchy of axis-aligned boxes over cloth tiles and balls (FCL's
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
  /// The pairs whose boxes overlap, with balls swept over `from`..`to` of the step (fractions 0..1), ordered
  /// by tile, then ball. Valid until the next call.
  const std::vector<TileBallPair>& find_pairs(const VectorField<Real>& position,
                                              const std::vector<Ball>& balls, double from, double to);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

extern template class BroadPhase<float>;
extern template class BroadPhase<double>;

}  // namespace weft
