#pragma once
#include <array>
#include <cstdint>

#include "cloth/core/vec3.h"
#include "cloth/kernels/wind_kernels.h"

namespace weft {

/// Turbulence as a function of place and time: random Fourier modes (Kraichnan 1970, Phys. Fluids 13, 22),
/// each across its wave vector, so that the sum is free of divergence. Isotropic, with Kraichnan's spectrum
/// of eddies of one size,
///   E(k) ~ k^4 exp(-k^2 / (2 k0^2)),
/// whose longitudinal correlation is exp(-(k0 r)^2 / 2), its integral length scale L = sqrt(pi / 2) / k0. The
/// wind carries it along (Taylor's hypothesis); as seen from there each mode turns over at a rate drawn from
/// a normal distribution of deviation u k0, u the root mean square of a component, which leaves a correlation
/// of exp(-(u k0 t)^2 / 2) in time.
class Eddies {
 public:
  Eddies(double length_scale, std::uint64_t seed);

  /// How far they have got.
  struct Progress {
    Vec3 carried{0, 0, 0};  ///< by the wind, m
    double turned = 0;      ///< their own way, u times the time, m
    template <class Archive>
    void serialize(Archive& archive) {
      archive(carried, turned);
    }
  };
  /// Adds the eddies' velocity at each of `count` points as seen from `place`; `rms` is u, m/s.
  void add(const Progress& progress, double rms, const Vec3& place, kernels::Components<const float> points,
           std::size_t count, kernels::Components<float> velocity) const;

 private:
  struct Mode {
    Vec3 wave;       ///< turns/m
    Vec3 amplitude;  ///< for u = 1
    double turning;  ///< turns/m of their own way
    double phase;    ///< turns
  };
  std::array<Mode, 64> modes_;
};

}  // namespace weft
