#pragma once
#include "cloth/sheet/tear/torn_links.h"

namespace weft {

/// Where a cloth is torn, whatever its level: walls in (u, v). They run along the edges between the nodes of
/// its finest level, so that no node of any level lies on one, and are kept as the finest level's structural
/// links that they cross. A link of any level is cut that crosses one: as levels are nested, a change of
/// level carries tears over by asking again.
class Walls {
 public:
  /// `base` and the finest level the cloth may have.
  Walls(const BaseCells& base, int finest_level)
      : base_(base), finest_level_(finest_level), finest_(base.at(finest_level)) {}

  /// Cuts a link of `level`: puts a wall across its middle, from the centre of the face on one side to that
  /// on the other, moved by half a cell of the finest level towards (0, 0) where nodes lie in the middle. Of
  /// that level's structural links it cuts no other.
  void add(int level, const Link& link);
  /// What is cut at `level`, the finest or a coarser one.
  TornLinks at(int level) const;
  /// At the finest level.
  const TornLinks& finest() const { return finest_; }

  /// What lasts from step to step (world/state.h); of the same cells.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(finest_);
  }

 private:
  BaseCells base_;
  int finest_level_;
  TornLinks finest_;
};

}  // namespace weft
