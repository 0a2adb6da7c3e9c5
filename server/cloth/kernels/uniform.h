#pragma once

namespace weft::kernels {

/// A vector that is the same everywhere: the air's velocity, the wind's direction.
template <class Real>
struct Uniform {
  Real x, y, z;
};

}  // namespace weft::kernels
