#include "cloth/integrators/softened_springs.h"

#include <algorithm>
#include <limits>

namespace weft {
namespace {

/// The stiffest mode's squared frequency times h^2 that is left, in inverse epsilons of the scalar. A hung
/// sheet of 1 mm comes to rest in the same number of iterations up to here; stiffer it takes the most there
/// are, and folds.
constexpr double kStiffest = 32;

}  // namespace

template <class Real>
std::optional<Springs<Real>> softened_springs(const Springs<Real>& springs, const ClothDescription& cloth,
                                              const Field<Real>& mass, double h) {
  const double most = kStiffest / double(std::numeric_limits<Real>::epsilon());
  const double stiffest = springs.max_squared_frequency(mass) * h * h;
  if (!(stiffest > most)) return {};
  Material soft = cloth.material;
  const double limit = most / stiffest * std::max({soft.structural.most(), soft.shear, soft.bending});
  for (double* constant : {&soft.structural.warp, &soft.structural.weft, &soft.shear, &soft.bending}) {
    *constant = std::min(*constant, limit);
  }
  Springs<Real> softened(soft, cloth.discretization, cloth.size, mass.grid(), springs.damping_time(),
                         springs.limited());
  softened.tear(springs.torn());
  return softened;
}

template std::optional<Springs<float>> softened_springs(const Springs<float>&, const ClothDescription&,
                                                        const Field<float>&, double);
template std::optional<Springs<double>> softened_springs(const Springs<double>&, const ClothDescription&,
                                                         const Field<double>&, double);

}  // namespace weft
