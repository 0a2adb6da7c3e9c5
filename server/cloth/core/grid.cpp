#include "cloth/core/grid.h"

namespace weft {

Grid Grid::with_nodes(int rows, int cols) {
  return {rows, cols, (cols + kRowPadding + kRowAlign - 1) / kRowAlign * kRowAlign};
}

Grid BaseCells::at(int level) const {
  const int scale = 1 << level;
  return Grid::with_nodes(rows * scale + 1, cols * scale + 1);
}

}  // namespace weft
