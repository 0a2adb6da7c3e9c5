#pragma once
#include <optional>

#include "cloth/air/eddies.h"
#include "cloth/air/gust_series.h"
#include "cloth/air/wind.h"

namespace weft {

/// The wind as it blows in a scene: a function of place and time, the same bits for the same seed and the
/// same changes at the same times.
class Air {
 public:
  /// Blows from time 0 on. `seed` is the scene's.
  Air(const Wind& wind, std::uint64_t seed);
  Air() : Air(Wind{}, 1) {}

  const Wind& wind() const { return wind_; }
  /// Blows as `wind` from `time` on, s; eddies go on from where they have got.
  void change(const Wind& wind, double time);

  /// Stays as it is until somebody changes it.
  bool steady() const { return !gusts_ && !eddies_; }
  /// Has the same velocity everywhere.
  bool uniform() const { return !eddies_ && wind_.zones.empty(); }
  bool turbulent() const { return eddies_.has_value(); }
  /// Null if there are none.
  const GustSeries* gusts() const { return gusts_ ? &*gusts_ : nullptr; }

  /// Mean and gusts, m/s, outside of zones.
  Vec3 velocity(double time) const;
  /// Adds the eddies' velocity at each of `count` points as seen from `place`, m; nothing without turbulence.
  void add_eddies(double time, const Vec3& place, kernels::Components<const float> points, std::size_t count,
                  kernels::Components<float> velocity) const;

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(wind_, seed_, since_, so_far_);
    if (Archive::is_loading::value) raise();
  }

 private:
  void raise();
  Eddies::Progress progress(double time) const;
  double turbulent_speed() const { return wind_.turbulence.intensity * wind_.speed; }

  Wind wind_;
  std::uint64_t seed_;
  std::optional<GustSeries> gusts_;
  std::optional<Eddies> eddies_;
  double since_ = 0;         ///< s: when wind_ began to blow
  Eddies::Progress so_far_;  ///< until then
};

}  // namespace weft
