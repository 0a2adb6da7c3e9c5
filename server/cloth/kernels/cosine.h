#pragma once
#include <cmath>

namespace weft::kernels {

/// cos(2 pi x) to 7e-9, or to what rounding leaves of x: sums and products only, so that loops with it are
/// vectorised and every instruction set gives the same bits, which std::cos does not promise.
template <class Real>
[[gnu::always_inline]] inline Real cosine_of_turns(Real x) {
  // cos(2 pi r) = sin(2 pi q), |q| <= 1/4; the polynomial is the sine's at five Chebyshev points in q^2.
  const Real r = x - std::nearbyint(x);
  const Real q = Real(0.25) - std::abs(r);
  const Real s = q * q;
  return q *
         (Real(6.283185280154406) +
          s * (Real(-41.34168061334665) +
               s * (Real(81.60247636893513) + s * (Real(-76.58117264451123) + s * Real(39.75982708706216)))));
}

}  // namespace weft::kernels
