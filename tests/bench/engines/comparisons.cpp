#include <array>
#include <cmath>
#include <span>

#include "engines/requirement.h"

namespace weft::bench {
namespace {

/// What was measured beside one another on another machine (one thread of a 2.5 GHz Xeon, November 2026), in
/// scene H with 64 x 64 nodes: median and least ms a frame, and what came of them.
struct Elsewhere {
  double ms, least_ms, max_strain, rms_speed;
};
/// NvCloth 1.1.6 with tethers, stiffness frequency 2000, more solver iterations from point to point.
constexpr std::array<Elsewhere, 3> kNvClothUndamped{
    {{2.57, 2.31, 0.10, 2.77}, {5.36, 4.82, 0.046, 2.93}, {10.1, 9.51, 0.031, 2.80}}};
constexpr std::array<Elsewhere, 5> kNvClothDamped{{{0.684, 0.598, 0.058, 0.0294},
                                                   {1.33, 1.20, 0.017, 0.0325},
                                                   {2.57, 2.34, 0.0055, 0.0351},
                                                   {5.32, 4.75, 0.0029, 0.0739},
                                                   {10.7, 9.65, 0.0018, 0.158}}};
/// Bullet with 1 x 40, and how much slower Debian's build of it is than the one measured.
constexpr Elsewhere kBulletUndamped{40.9, 32.2, 0.18, 2.8}, kBulletDamped{37.7, 33.7, 0.075, 0.0704};
constexpr double kDebianSlower = 1.11;
constexpr double kStrainLimit = 0.05;

/// The curve from 5 % down: its first point, a little above, is moved along to 5 % (straight in logarithms).
std::vector<Elsewhere> curve(std::span<const Elsewhere> points) {
  const Elsewhere &above = points[0], &below = points[1];
  const double part =
      std::log(kStrainLimit / above.max_strain) / std::log(below.max_strain / above.max_strain);
  std::vector<Elsewhere> curve(points.begin(), points.end());
  curve[0] = {above.ms * std::pow(below.ms / above.ms, part),
              above.least_ms * std::pow(below.least_ms / above.least_ms, part), kStrainLimit,
              above.rms_speed};
  return curve;
}

/// Another engine's time over that of Weft's fastest row that stretches no more than the other and moves at
/// least so fast, m/s.
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
  // This machine and load against that one, by what Bullet took on both.
  const Elsewhere& there = damping == 0 ? kBulletUndamped : kBulletDamped;
  const double slower = bullet->median_ms / (kDebianSlower * there.ms);
  const double least_slower = bullet->least_ms / (kDebianSlower * there.least_ms);
  for (const Elsewhere& point : damping == 0 ? curve(kNvClothUndamped) : curve(kNvClothDamped)) {
    Measurement nvcloth;
    nvcloth.median_ms = slower * point.ms;
    nvcloth.least_ms = least_slower * point.least_ms;
    nvcloth.max_strain = point.max_strain;
    nvcloth.rms_speed = point.rms_speed;
    add("NvCloth (" + time_text(nvcloth) + " here, by Bullet)", nvcloth, 5);
  }
  return all;
}

}  // namespace weft::bench
