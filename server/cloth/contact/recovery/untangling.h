#pragma once
#include "cloth/contact/search/feature_search.h"

namespace weft {

/// How to move nodes so that cloth which passes through cloth comes free: for each a move, m, at most
/// `longest`, zero for fixed nodes and those at no crossing. Knows no inside nor outside and no past: it
/// shortens the line along which the surfaces cross, edge by edge, by the move of the edge against the
/// triangle that shortens it most (Volino and Magnenat-Thalmann, Resolving Surface Collisions through
/// Intersection Contour Minimization, 2006). What cannot be left by shortening, as two sheets that cross from
/// rim to rim, may stay.
std::vector<Vec3> untangling_moves(const std::vector<Crossing>& crossings, const LayerNodes& nodes,
                                   double longest);

}  // namespace weft
