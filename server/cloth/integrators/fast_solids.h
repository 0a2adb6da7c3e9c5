#pragma once
#include <vector>

#include "cloth/contact/recovery/contact.h"

namespace weft {

/// How many times as many substeps as usual an implicit step takes beside a solid: as many as it takes for
/// cloth and solid not to pass each other in one by more than the solid's inner radius R, for one that moves
/// by itself not to pass by more than a quarter of R or of a cell of the cloth, and for what the step itself
/// gives the cloth's velocity not to take it farther than a quarter of R; at most kMostPartsBeside. Powers of
/// two, so that they seldom change: BDF2 begins anew where they do.
///
/// Where the solid's surface faces changes within R. In a substep that is longer a node is held to one
/// tangent plane all along, and drawn as far as the solid goes, where it would have slid off; its links then
/// hold energy that nobody put in. And which nodes a solid strikes changes with each cell that it goes: of
/// those that it passes in a substep the iterations find a few, and leave their links stretched. Round a wall
/// nothing is drawn. Cloth that goes with the solid needs no more substeps: what counts is the solid's way
/// beside the mean of the nodes'. What a step begins with foresees what it strikes; what the air gives in it
/// strikes unforeseen, and what the iterations then find is held too late.
///
/// `h` is the substep, s, of a step of `dt`; `cell` the shorter side of a cell, m; `velocity` what the nodes
/// will have at the step's end as far as that is known (find_velocity_in_air), m/s. Solids that the cloth
/// neither touches nor meets in the step, going on with it, do not count.
template <class Real>
int parts_beside_fast_solids(const Particles<Real>& particles, const VectorField<Real>& velocity,
                             Contact<Real>& contact, const std::vector<Solid>& solids, double cell, double h,
                             double dt);
/// Some solid may count.
bool any_with_an_end(const std::vector<Solid>& solids);

extern template int parts_beside_fast_solids(const Particles<float>&, const VectorField<float>&,
                                             Contact<float>&, const std::vector<Solid>&, double, double,
                                             double);
extern template int parts_beside_fast_solids(const Particles<double>&, const VectorField<double>&,
                                             Contact<double>&, const std::vector<Solid>&, double, double,
                                             double);

}  // namespace weft
