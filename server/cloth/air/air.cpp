#include "cloth/air/air.h"

namespace weft {
namespace {

// Each draws from a sequence of its own, which is none of a cloth's: those have the seed's successors.
constexpr std::uint64_t kGustStream = 0x6775737473000000, kEddyStream = 0x6564646965730000;

}  // namespace

Air::Air(const Wind& wind, std::uint64_t seed) : wind_(wind), seed_(seed) { raise(); }

void Air::change(const Wind& wind, double time) {
  so_far_ = progress(time);
  since_ = time;
  wind_ = wind;
  raise();
}

void Air::raise() {
  gusts_.reset();
  eddies_.reset();
  if (wind_.gusts.intensity * wind_.speed > 0) gusts_.emplace(wind_.gusts, seed_ ^ kGustStream);
  if (turbulent_speed() > 0) eddies_.emplace(wind_.turbulence.length_scale, seed_ ^ kEddyStream);
}

Eddies::Progress Air::progress(double time) const {
  const double passed = time - since_;
  return {so_far_.carried + passed * wind_.velocity(), so_far_.turned + passed * turbulent_speed()};
}

Vec3 Air::velocity(double time) const {
  return (gusts_ ? wind_.speed * gusts_->factor(time) : wind_.speed) * wind_.direction;
}

void Air::add_eddies(double time, const Vec3& place, kernels::Components<const float> points,
                     std::size_t count, kernels::Components<float> velocity) const {
  if (eddies_) eddies_->add(progress(time), turbulent_speed(), place, points, count, velocity);
}

}  // namespace weft
