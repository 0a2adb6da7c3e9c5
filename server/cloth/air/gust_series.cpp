#include "cloth/air/gust_series.h"

#include <cmath>

#include "cloth/core/random.h"
#include "cloth/kernels/cosine.h"

namespace weft {
namespace {

/// Edge k of the bands as the share of the variance that lies above it, y^-2 where 1 + 6 f T = y^3. y - 1
/// grows from 0.002 to 8.2, fourfold in eight bands: in high frequencies a band is 1.7 times the one below.
double variance_above(int k) {
  const double quarter_octave = std::sqrt(std::sqrt(2.0));  // roots round alike everywhere, powers do not
  double beyond = 0.002;
  for (int i = 0; i < k; ++i) beyond *= quarter_octave;
  return 1 / ((1 + beyond) * (1 + beyond));
}

}  // namespace

GustSeries::GustSeries(const Gusts& gusts, std::uint64_t seed) {
  Random random(seed);
  const int bands = static_cast<int>(harmonics_.size());
  const double resolved = variance_above(0) - variance_above(bands);
  int band = 0;
  for (Harmonic& harmonic : harmonics_) {
    const double low = variance_above(band + 1), high = variance_above(band);
    const double above = random.between(low, high);
    harmonic.frequency = (1 / (above * std::sqrt(above)) - 1) / (6 * gusts.time_scale);
    harmonic.amplitude = gusts.intensity * std::sqrt(2 * (high - low) / resolved);
    harmonic.phase = random.between(0, 1);
    ++band;
  }
}

double GustSeries::factor(double time) const {
  double sum = 1;
  for (const Harmonic& harmonic : harmonics_) {
    sum += harmonic.amplitude * kernels::cosine_of_turns(harmonic.frequency * time + harmonic.phase);
  }
  return sum;
}

}  // namespace weft
