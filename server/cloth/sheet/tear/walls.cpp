#include "cloth/sheet/tear/walls.h"

#include <algorithm>

namespace weft {

void Walls::add(int level, const Link& link) {
  const int cells = 1 << (finest_level_ - level);  // of the finest level along a link
  const Grid& grid = finest_.grid();
  const int along = (link.along_u ? link.col : link.row) * cells + (cells - 1) / 2;
  const int across = (link.along_u ? link.row : link.col) * cells;
  const int last = (link.along_u ? grid.rows : grid.cols) - 1;
  const int begin = std::max(0, across - cells / 2), end = std::min(last, across + (cells - 1) / 2);
  for (int i = begin; i <= end; ++i) {
    finest_.cut(link.along_u ? Link{i, along, true} : Link{along, i, false});
  }
}

TornLinks Walls::at(int level) const {
  if (level == finest_level_) return finest_;
  const int cells = 1 << (finest_level_ - level);
  TornLinks links(base_.at(level));
  const Grid& grid = links.grid();
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) {
      for (int i = 0; i < cells; ++i) {
        if (c + 1 < grid.cols && finest_.torn({r * cells, c * cells + i, true})) links.cut({r, c, true});
        if (r + 1 < grid.rows && finest_.torn({r * cells + i, c * cells, false})) links.cut({r, c, false});
      }
    }
  }
  return links;
}

}  // namespace weft
