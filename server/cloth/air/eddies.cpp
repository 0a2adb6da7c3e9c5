#include "cloth/air/eddies.h"

#include <cmath>
#include <numbers>

#include "cloth/core/random.h"

namespace weft {
namespace {

Vec3 normal_vector(Random& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

}  // namespace

Eddies::Eddies(double length_scale, std::uint64_t seed) {
  Random random(seed);
  const double k0 = std::sqrt(std::numbers::pi / 2) / length_scale;
  const double turns = k0 / (2 * std::numbers::pi);
  for (Mode& mode : modes_) {
    // |k| / k0 has the density k^4 exp(-k^2 / 2): that of a normal vector's length in five dimensions.
    const Vec3 three = normal_vector(random);
    const double fourth = random.normal(), fifth = random.normal();
    const double length = std::sqrt(three.squaredNorm() + fourth * fourth + fifth * fifth);
    const Vec3 along = normal_vector(random).normalized();
    mode.wave = turns * length * along;
    // As much energy in each mode; in all the three components have a mean square of 3.
    const double strength = std::sqrt(6.0 / static_cast<double>(modes_.size()));
    mode.amplitude = strength * along.cross(normal_vector(random)).normalized();
    mode.turning = turns * random.normal();
    mode.phase = random.between(0, 1);
  }
}

void Eddies::add(const Progress& progress, double rms, const Vec3& place,
                 kernels::Components<const float> points, std::size_t count,
                 kernels::Components<float> velocity) const {
  std::array<kernels::AirWave, std::tuple_size_v<decltype(modes_)>> waves;
  for (std::size_t n = 0; n < waves.size(); ++n) {
    const Mode& mode = modes_[n];
    const double turns =
        mode.phase + mode.turning * progress.turned - mode.wave.dot(progress.carried - place);
    const Eigen::Vector3f wave = mode.wave.cast<float>(), amplitude = (rms * mode.amplitude).cast<float>();
    waves[n] = {wave.x(),      wave.y(),      wave.z(),     static_cast<float>(turns - std::nearbyint(turns)),
                amplitude.x(), amplitude.y(), amplitude.z()};
  }
  kernels::add_waves(waves.data(), static_cast<int>(waves.size()), points, count, velocity);
}

}  // namespace weft
