#include "cloth/kernels/wind_kernels.h"

#include <algorithm>

#include "cloth/core/multiversion.h"
#include "cloth/kernels/cosine.h"

namespace weft::kernels {
namespace {

/// Points handled at a time, whose sums stay in the first-level cache from wave to wave.
constexpr std::size_t kBlock = 128;

[[gnu::always_inline]] inline void add_wave(const AirWave& wave, const float* __restrict x,
                                            const float* __restrict y, const float* __restrict z,
                                            std::size_t count, float* __restrict vx, float* __restrict vy,
                                            float* __restrict vz) {
  for (std::size_t i = 0; i < count; ++i) {
    const float turns = wave.kx * x[i] + wave.ky * y[i] + wave.kz * z[i] + wave.phase;
    const float cosine = cosine_of_turns(turns);
    vx[i] += wave.ax * cosine;
    vy[i] += wave.ay * cosine;
    vz[i] += wave.az * cosine;
  }
}

}  // namespace

WEFT_MULTIVERSION void add_waves(const AirWave* waves, int wave_count, Components<const float> points,
                                 std::size_t count, Components<float> velocity) {
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t block = std::min(kBlock, count - begin);
    const Components<const float> p = points + begin;
    const Components<float> v = velocity + begin;
    for (int n = 0; n < wave_count; ++n) add_wave(waves[n], p.x, p.y, p.z, block, v.x, v.y, v.z);
  }
}

WEFT_MULTIVERSION void add_between(int coarse_rows, int coarse_cols, Components<const float> coarse, int rows,
                                   int cols, const Grid& fine, Components<float> velocity) {
  const float* const from[3] = {coarse.x, coarse.y, coarse.z};
  float* const to[3] = {velocity.x, velocity.y, velocity.z};
  for (int component = 0; component < 3; ++component) {
    for (int r = 0; r < fine.rows; ++r) {
      const int above = r / rows, below = std::min(above + 1, coarse_rows - 1);
      const float down = static_cast<float>(r % rows) / static_cast<float>(rows);
      const float* upper = from[component] + static_cast<std::ptrdiff_t>(above) * coarse_cols;
      const float* lower = from[component] + static_cast<std::ptrdiff_t>(below) * coarse_cols;
      float* out = to[component] + fine.index(r, 0);
      for (int c = 0; c < coarse_cols; ++c) {
        const int next = std::min(c + 1, coarse_cols - 1);
        const float left = upper[c] + down * (lower[c] - upper[c]);
        const float right = upper[next] + down * (lower[next] - upper[next]);
        const float step = (right - left) / static_cast<float>(cols);
        const int count = std::min(cols, fine.cols - c * cols);
        for (int i = 0; i < count; ++i) out[c * cols + i] += left + static_cast<float>(i) * step;
      }
    }
  }
}

}  // namespace weft::kernels
