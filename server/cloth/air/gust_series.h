#pragma once
#include <array>
#include <cstdint>

#include "cloth/air/wind.h"

namespace weft {

/// Gusts as a function of time: a sum of harmonics (Shinozuka's spectral representation; Shinozuka and
/// Deodatis 1991) of the Kaimal spectrum in IEC 61400-1's form, one-sided and of variance I^2,
///   S(f) = 4 I^2 T / (1 + 6 f T)^(5/3),
/// I the intensity, T the time scale, a length over the wind's speed there. Each harmonic has the variance of
/// a band of its own, and a frequency drawn from that band as the spectrum weighs it, so that the series does
/// not repeat. Bands reach from 3e-4 / T to 130 / T; the 1.6 % of the variance beyond are shared out.
class GustSeries {
 public:
  GustSeries(const Gusts& gusts, std::uint64_t seed);

  /// The wind's speed at `time`, s, over its mean.
  double factor(double time) const;

 private:
  struct Harmonic {
    double frequency;  ///< Hz
    double amplitude;
    double phase;  ///< turns
  };
  std::array<Harmonic, 48> harmonics_;
};

}  // namespace weft
