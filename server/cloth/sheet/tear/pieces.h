#pragma once
#include <vector>

#include "cloth/core/particles.h"
#include "cloth/sheet/tear/walls.h"

namespace weft {

/// Before a torn cloth goes from level - 1, of which `coarse` is what is cut, to `level`: cuts the links that
/// would join what has come apart. Walls made at different levels need not meet. On the coarse grid no link
/// leads through the gap between two, so that there they part pieces, which move away from each other; on the
/// finer one a link does. Afterwards two nodes that both grids have hang together on the one as they do on
/// the other.
void part_pieces(const TornLinks& coarse, int level, Walls& walls);

/// Of the piece that each node hangs together with, by index, kg; infinite where that is pinned.
template <class Real>
std::vector<double> piece_masses(const TornLinks& torn, const Particles<Real>& particles);

}  // namespace weft
