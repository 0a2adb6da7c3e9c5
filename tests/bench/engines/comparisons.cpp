#include <array>
#include <cmath>
#include <span>

#include "engines/requirement.h"

namespace weft::bench {
namespace {

/// NvCloth 1.1.6 with tethers, stiffness frequency 2000, its accuracy bought with solver iterations: scene H,
/// 64 x 64 nodes, one thread of a 2.5 GHz Xeon, November 2026. Bullet's 1 x 40 was measured beside it.
struct NvCloth {
  double ms, max_strain, rms_speed;
};
constexpr std::array<NvCloth, 3> kNvClothUndamped{
    {{2.57, 0.10, 2.77}, {5.36, 0.046, 2.93}, {10.1, 0.031, 2.80}}};
constexpr std::array<NvCloth, 5> kNvClothDamped{{{0.684, 0.058, 0.0294},
                                                 {1.33, 0.017, 0.0325},
                                                 {2.57, 0.0055, 0.0351},
                                                 {5.32, 0.0029, 0.0739},
                                                 {10.7, 0.0018, 0.158}}};
/// Bullet's frame on that machine, ms: built with optimisation for it, times what Debian's build is slower.
constexpr double kBulletThereUndamped = 40.9 * 1.11, kBulletThereDamped = 37.7 * 1.11;
constexpr double kStrainLimit = 0.05;

/// The curve from 5 % down: its first point, a little above, is moved along to 5 % (straight in logarithms).
std::vector<NvCloth> curve(std::span<const NvCloth> points) {
  const NvCloth &above = points[0], &below = points[1];
  const double part =
      std::log(kStrainLimit / above.max_strain) / std::log(below.max_strain / above.max_strain);
  std::vector<NvCloth> curve(points.begin(), points.end());
  curve[0] = {above.ms * std::pow(below.ms / above.ms, part), kStrainLimit, above.rms_speed};
  return curve;
}

/// `ms` (its minimum in `least_ms`) of another engine over Weft's fastest row that stretches no more than
/// that, and at least so fast.
Requirement against(const Rows& rows, const EngineScene& scene, const std::string& other,
                    const Measurement& measured, double least_speed, double target) {
  Requirement requirement{other + " over Weft at " + text(100 * measured.max_strain) + " %",
                          ">= " + text(target), "no such row of Weft's", false};
  if (least_speed > 0) requirement.what += ", moving no less than 0.8 times as fast";
  const Row* weft = rows.fastest_weft(scene, measured.max_strain, least_speed);
  if (weft == nullptr) return requirement;
  const Measurement& fast = weft->measured;
  requirement.measured = ratio_text(measured, fast) + ": " + weft->competitor.engine + ", " +
                         weft->competitor.setting + ", Y = " + text(weft->competitor.structural) + ", " +
                         time_text(fast) + ", " + text(100 * fast.max_strain) + " %, " +
                         text(fast.rms_speed) + " m/s (" + text(measured.rms_speed) + ")";
  requirement.holds = measured.median_ms / fast.median_ms >= target;
  return requirement;
}

}  // namespace

std::vector<Requirement> comparisons(const Rows& rows, double damping) {
  const EngineScene scene{'H', 6, damping};
  std::vector<Requirement> all;
  const auto add = [&](const std::string& other, const Measurement& measured, double target) {
    all.push_back(against(rows, scene, other, measured, 0, target));
    // Strain without motion is cheap; near rest there is none to keep.
    if (damping == 0) all.push_back(against(rows, scene, other, measured, 0.8 * measured.rms_speed, target));
  };

  Requirement baseline{"baseline over bdf2, same sheet", ">= 50", "", {}};
  const Measurement* paper = rows.find(scene, "baseline", "stable substeps", kStiff);
  const Measurement* bdf2 = rows.bdf2(scene);
  if (paper != nullptr && bdf2 != nullptr) {
    const double ratio = paper->median_ms / bdf2->median_ms;
    baseline.measured = ratio_text(*paper, *bdf2);
    baseline.holds = ratio >= 50;
  }
  all.push_back(baseline);
  if (paper != nullptr && paper->sound()) add("baseline", *paper, 50);

  const Measurement* bullet = rows.find(scene, "Bullet", "1 x 40", 0);
  if (bullet == nullptr || !bullet->sound()) {
    all.push_back({"Bullet 1 x 40 and NvCloth over Weft", ">= 30, >= 5", "", {}});
    return all;
  }
  add("Bullet 1 x 40", *bullet, 30);
  const double there = damping == 0 ? kBulletThereUndamped : kBulletThereDamped;
  const std::vector<NvCloth> points = damping == 0 ? curve(kNvClothUndamped) : curve(kNvClothDamped);
  for (const NvCloth& point : points) {
    Measurement scaled;
    scaled.median_ms = point.ms * bullet->median_ms / there;
    scaled.least_ms = point.ms * bullet->least_ms / there;
    scaled.max_strain = point.max_strain;
    scaled.rms_speed = point.rms_speed;
    add("NvCloth (" + text(point.ms) + " ms where Bullet takes " + text(there) + ")", scaled, 5);
  }
  return all;
}

}  // namespace weft::bench
