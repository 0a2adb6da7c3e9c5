#pragma once
/// What every engine in the comparison offers: a frame, and a look at the sheet.
#include <vector>

#include "cloth/core/vec3.h"

namespace weft::bench {

/// A square sheet as any engine holds it, row by row, row 0 the top edge.
struct SheetState {
  int side = 0;  ///< nodes
  std::vector<Vec3> position, velocity;
};

class Engine {
 public:
  virtual ~Engine() = default;
  /// One frame of 1/60 s: what is timed.
  virtual void step() = 0;
  virtual void read(SheetState& sheet) const = 0;
};

}  // namespace weft::bench
