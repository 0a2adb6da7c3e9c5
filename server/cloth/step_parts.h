#pragma once
#include <vector>

#include "cloth/cloth.h"
#include "cloth/layers/layers.h"

namespace weft {

/// So many parts, at least 1, the step of dt seconds from `time` on, s, is to be made in.
///
/// Where cloths touch, in `layers` if there are any, they learn only once a step what others do, what hands
/// turn is taken to go straight on, and what may fall onto what is foreseen, which is the more the longer a
/// step is: parts are at most 1/30 s long with the implicit steps of a single cloth, and 1/60 s with those of
/// several, each of which foresees the others by itself, and with explicit ones, which share nothing of a
/// force. At 15 Hz a strip wrung by a hand had 654 J where 30 are put in (S51b, backward Euler), and a heap
/// took a second a step (S51a, level 6, BDF2). At 30 Hz sheets that hit each other were foreseen so badly
/// that the net moved them by 6 mm, 0.5 J in their springs (S51c, level 5). Explicit methods, which give way
/// to each other in every substep, need to go on almost in turn: parts of 1/240 s with several cloths. In
/// those of 1/60 s XPBD's sheet on a sheet shook by 0.1 mm for ever at level 5 (S51c); in these it sleeps
/// after 5 s, and its first 3 s take 9 s of time, not 15.
///
/// Where one cloth goes past another a step holds the few pairs of features that it foresees, and the net has
/// to stop the others: in a part it goes on by at most 4 cells, up to 4 parts. A sheet of 5 g and 2e5 N/m,
/// which another one swept past by 12 cells a step, had 36 J in its springs where 2.5 are allowed (random
/// scene 2406).
///
/// Where there is anything `solid` an implicit step sees its nodes stopped on straight ways: pins go in a
/// part at most half as far as their cloth is wide, up to 8 parts. An edge yanked past a box by 3.3 m a step
/// had 1.1e6 J where 2.5e5 are put in (S54b, backward Euler). Pins fixed to an obstacle do not count.
template <class Real>
int step_parts(const std::vector<Cloth<Real>>& cloths, const Layers<Real>* layers, bool solid, double time,
               double dt);

}  // namespace weft
