#pragma once
#include <vector>

#include "cloth/core/effect_description.h"
#include "cloth/sheet/springs.h"

namespace weft {

/// Times its strength that a link bears with no tear's end at it before it breaks together with others.
inline constexpr double kOverload = 2;

/// The tension that the sheet carries across the middle of each structural link, in the link's direction, per
/// metre of cloth, N/m, as a share of TearingEffect's strength there: the link's own force and half of those
/// of the diagonals of the cells beside it, whose other halves are their next links', over the width it
/// stands for. All links of a line added up give the whole force across it. Without what resists rates of
/// strain. Negative where it is pushed together, 0 where there is no link any more.
struct LinkLoads {
  Grid grid;
  std::vector<double> u, v;  ///< by node, row * cols + col, of its link to the next column, or row

  std::size_t index(int row, int col) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.cols) +
           static_cast<std::size_t>(col);
  }
};
template <class Real>
LinkLoads link_loads(const Springs<Real>& springs, const VectorField<Real>& position,
                     const TearingEffect& tearing);

/// True only if no link can be loaded beyond its strength, as no spring is long enough: a fraction of what
/// link_loads costs. Of whole sheets; false for torn ones.
template <class Real>
bool surely_holds(const Springs<Real>& springs, const VectorField<Real>& position,
                  const TearingEffect& tearing);

/// The links that break in a step which leaves these loads; `torn` is what is cut already, or nullptr. Only
/// such that bear more than their strength (Terzopoulos and Fleischer, Modeling Inelastic Deformation, 1988,
/// cut all of a net that do), and as few as the step can tell to, by rules of our own: a break unloads a
/// sheet as far as sound gets in a step, often all of it, while loads are known at its end alone.
///  - At each tear's end, a face that has lost one edge, the link of the face that is loaded most: tears run.
///  - Any link beyond kOverload, which needs no tear's end beside it, if none before or after it on its
///    thread bears more.
///  - If there are none of these, the one link that is loaded most: a tear begins.
std::vector<Link> links_to_break(const LinkLoads& loads, const TornLinks* torn);

extern template bool surely_holds(const Springs<float>&, const VectorField<float>&, const TearingEffect&);
extern template bool surely_holds(const Springs<double>&, const VectorField<double>&, const TearingEffect&);
extern template LinkLoads link_loads(const Springs<float>&, const VectorField<float>&, const TearingEffect&);
extern template LinkLoads link_loads(const Springs<double>&, const VectorField<double>&,
                                     const TearingEffect&);

}  // namespace weft
