// Gusts, turbulence and zones against the formulas they claim, and how a cloth's nodes get them.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "busy_scene.h"
#include "cloth/air/eddies.h"
#include "cloth/air/gust_series.h"
#include "cloth/air/node_air.h"
#include "cloth/air/wind.h"

namespace weft {
namespace {

using test::each_node;
using test::get;
using test::set;

// --- Gusts ---

TEST(GustSeries, HasTheMeanAndTheDeviationAskedFor) {
  // Over 10,000 time scales: 3 periods of the slowest harmonic, so that each averages out to 10 %.
  for (const double intensity : {0.05, 0.3}) {
    const GustSeries gusts({intensity, 2.0}, 7);
    constexpr int kSamples = 200'000;
    double sum = 0, squares = 0;
    for (int i = 0; i < kSamples; ++i) {
      const double factor = gusts.factor(i * 0.1);
      sum += factor;
      squares += (factor - 1) * (factor - 1);
    }
    EXPECT_NEAR(sum / kSamples, 1, 0.01 * intensity);
    EXPECT_NEAR(std::sqrt(squares / kSamples), intensity, 0.01 * intensity);
  }
}

/// In place, of a power of two many.
void fourier(std::vector<std::complex<double>>& values) {
  const std::size_t count = values.size();
  if (count == 1) return;
  std::vector<std::complex<double>> even, odd;
  for (std::size_t i = 0; i < count; i += 2) {
    even.push_back(values[i]);
    odd.push_back(values[i + 1]);
  }
  fourier(even);
  fourier(odd);
  for (std::size_t k = 0; k < count / 2; ++k) {
    const auto turned = std::polar(1.0, -2 * std::numbers::pi * double(k) / double(count)) * odd[k];
    values[k] = even[k] + turned;
    values[k + count / 2] = even[k] - turned;
  }
}

TEST(GustSeriesSlow, HasKaimalsSpectrum) {
  // Mean of 32 periodograms, in bands of half a decade, against the integral of 4 T / (1 + 6 f T)^(5/3),
  // which is (1 + 6 f T)^(-2/3) between the band's ends. Over 262 time scales; a band holds four harmonics or
  // more of each series.
  constexpr int kSeries = 32, kSamples = 1 << 15;
  constexpr double kScale = 1.5, kStep = kScale / 125;
  std::vector<double> power(kSamples / 2, 0.0);
  for (int series = 0; series < kSeries; ++series) {
    const GustSeries gusts({1.0, kScale}, 100 + std::uint64_t(series));
    std::vector<std::complex<double>> values(kSamples);
    for (int i = 0; i < kSamples; ++i) values[std::size_t(i)] = gusts.factor(i * kStep) - 1;
    fourier(values);
    for (std::size_t k = 0; k < power.size(); ++k) {
      power[k] += 2 * std::norm(values[k]) / (double(kSamples) * kSamples) / kSeries;
    }
  }
  const double line = 1 / (kSamples * kStep);  // Hz, between two lines of the periodogram
  const auto between = [&](double low, double high) {
    double sum = 0;
    for (std::size_t k = 1; k < power.size(); ++k) {
      if (double(k) * line >= low && double(k) * line < high) sum += power[k];
    }
    return sum;
  };
  const auto above = [&](double f) { return std::pow(1 + 6 * f * kScale, -2.0 / 3); };
  std::vector<double> found;
  for (double low = 0.05 / kScale; low < 12 / kScale; low *= std::sqrt(10)) {
    const double high = low * std::sqrt(10);
    found.push_back(between(low, high));
    EXPECT_NEAR(found.back() / (above(low) - above(high)), 1, 0.1) << low * kScale;
  }
  // The variance of half a decade falls by 10^(-1/3) from one to the next where S ~ f^(-5/3).
  EXPECT_NEAR(found[4] / found[3], std::pow(10, -1.0 / 3), 0.06);
}

TEST(GustSeries, IsTheSeedsAndNoOther) {
  const Gusts gusts{0.2, 3.0};
  const GustSeries one(gusts, 1), same(gusts, 1), other(gusts, 2);
  double apart = 0;
  for (double time = 0; time < 100; time += 0.37) {
    EXPECT_EQ(one.factor(time), same.factor(time));
    apart = std::max(apart, std::abs(one.factor(time) - other.factor(time)));
  }
  EXPECT_GT(apart, 0.2);
}

// --- Turbulence ---

/// The eddies' velocity at one place.
Vec3 velocity_at(const Eddies& eddies, const Vec3& place, const Eddies::Progress& progress = {},
                 double rms = 1) {
  const float x = float(place.x()), y = float(place.y()), z = float(place.z());
  float vx = 0, vy = 0, vz = 0;
  eddies.add(progress, rms, Vec3::Zero(), {&x, &y, &z}, 1, {&vx, &vy, &vz});
  return {vx, vy, vz};
}

/// `count` places in a box of 40 m, the same every time.
std::vector<Vec3> places(int count) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> coordinate(-20, 20);
  std::vector<Vec3> made;
  for (int i = 0; i < count; ++i) {
    const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
    made.emplace_back(x, y, z);
  }
  return made;
}

/// Mean over the places of 100 fields of length scale 0.5 m.
double mean_over_fields(const std::function<double(const Eddies&, const Vec3&)>& value) {
  constexpr int kFields = 100;
  double sum = 0;
  const auto where = places(100);
  for (int seed = 0; seed < kFields; ++seed) {
    const Eddies eddies(0.5, std::uint64_t(seed));
    for (const Vec3& place : where) sum += value(eddies, place);
  }
  return sum / (kFields * double(where.size()));
}

constexpr double kK0 = 2.50662827463;  // 1/m, sqrt(pi / 2) / 0.5 m

TEST(Eddies, HaveNoDivergence) {
  const Eddies eddies(0.5, 3);
  constexpr double kStep = 0.02;  // central differences of fourth order are good to 3e-5 of a gradient
  double divergence = 0, gradient = 0;
  for (const Vec3& place : places(200)) {
    Eigen::Matrix3d slope;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = kStep * Vec3::Unit(axis);
      const auto difference = [&](double n) {
        return Vec3(velocity_at(eddies, place + n * step) - velocity_at(eddies, place - n * step));
      };
      slope.col(axis) = (8 * difference(1) - difference(2)) / (12 * kStep);
    }
    divergence += slope.trace() * slope.trace();
    gradient += slope.squaredNorm();
  }
  EXPECT_LT(std::sqrt(divergence / gradient), 1e-3);
}

TEST(Eddies, HaveTheMeanSquareAskedForInAllDirections) {
  // One field's energy, 3 u^2 = 12, is that of its modes; over so many places to 3 %. Of a component the mean
  // over fields.
  const Eddies eddies(0.5, 11);
  double energy = 0;
  for (const Vec3& place : places(5000)) energy += velocity_at(eddies, place, {}, 2.0).squaredNorm() / 5000;
  EXPECT_NEAR(energy, 12, 0.36);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mean_over_fields([&](const Eddies& field, const Vec3& place) {
                  const double u = velocity_at(field, place)[axis];
                  return u * u;
                }),
                1, 0.03)
        << axis;
  }
}

TEST(Eddies, HaveTheLengthScaleAskedFor) {
  // Along the separation f = exp(-z), across it g = (1 - z) exp(-z), z = (k0 r)^2 / 2. The mean of 10,000
  // pairs is good to 0.02.
  for (const double r : {0.2, 0.4, 0.8}) {
    const double z = kK0 * r * kK0 * r / 2;
    for (int axis = 0; axis < 3; ++axis) {
      const double correlation = mean_over_fields([&](const Eddies& field, const Vec3& place) {
        return velocity_at(field, place)[axis] * velocity_at(field, place + Vec3(0, r, 0))[axis];
      });
      EXPECT_NEAR(correlation, axis == 1 ? std::exp(-z) : (1 - z) * std::exp(-z), 0.04) << r << " " << axis;
    }
  }
}

TEST(Eddies, AreCarriedAlongAndTurnOver) {
  const Eddies eddies(0.5, 4);
  const Vec3 carried(10, -20, 30);
  for (const Vec3& place : places(50)) {
    const Vec3 there = velocity_at(eddies, place + carried, {carried, 0});
    EXPECT_LT((there - velocity_at(eddies, place)).norm(), 1e-3);  // coordinates are floats
  }
  // exp(-(u k0 t)^2 / 2), u t = 0.3 and 0.6 m; good to 0.02.
  for (const double turned : {0.3, 0.6}) {
    const double correlation = mean_over_fields([&](const Eddies& field, const Vec3& place) {
      return velocity_at(field, place).dot(velocity_at(field, place, {{0, 0, 0}, turned})) / 3;
    });
    EXPECT_NEAR(correlation, std::exp(-kK0 * turned * kK0 * turned / 2), 0.04) << turned;
  }
}

// --- The wind of a scene ---

TEST(Air, WithoutGustsAndEddiesIsTheMeanWind) {
  const Air air({{0, 0, -1}, 3.0}, 1);
  EXPECT_TRUE(air.steady());
  EXPECT_TRUE(air.uniform());
  EXPECT_EQ(air.gusts(), nullptr);
  EXPECT_EQ(air.velocity(12.3), Vec3(0, 0, -3));
}

TEST(Air, KnowsWhatItHas) {
  Wind wind{{1, 0, 0}, 3.0};
  wind.gusts.intensity = 0.2;
  EXPECT_FALSE(Air(wind, 1).steady());
  EXPECT_TRUE(Air(wind, 1).uniform());
  wind.turbulence.intensity = 0.2;
  EXPECT_FALSE(Air(wind, 1).uniform());
  wind.speed = 0;  // both are shares of it
  EXPECT_TRUE(Air(wind, 1).steady());
  EXPECT_TRUE(Air(wind, 1).uniform());
  wind.zones = {WindZone{}};
  EXPECT_TRUE(Air(wind, 1).steady());
  EXPECT_FALSE(Air(wind, 1).uniform());
}

TEST(Air, GoesOnWhereItWasWhenItChanges) {
  Wind wind{{1, 0, 0}, 4.0};
  wind.gusts = {0.2, 2.0};
  wind.turbulence = {0.25, 0.5};
  Air air(wind, 1);
  const auto eddy = [&air](double time) {
    const float x = 0.3F, y = 0.1F, z = 0.2F;
    float vx = 0, vy = 0, vz = 0;
    air.add_eddies(time, Vec3::Zero(), {&x, &y, &z}, 1, {&vx, &vy, &vz});
    return Vec3(vx, vy, vz);
  };
  const Vec3 before = eddy(1000), gust = air.velocity(1000);
  wind.speed = 6;
  air.change(wind, 1000);
  EXPECT_LT((eddy(1000) - 1.5 * before).norm(), 1e-5);  // intensities are shares of the speed
  EXPECT_LT((air.velocity(1000) - 1.5 * gust).norm(), 1e-12);
  EXPECT_GT((eddy(1000.5) - 1.5 * before).norm(), 0.1);
}

// --- At a cloth's nodes ---

/// The air at the nodes of a sheet of 2 m at rest, at time 1 s.
VectorField<float> air_on(const Particles<float>& sheet, const Wind& wind) {
  const Vec2 spacing(2.0 / (sheet.grid().cols - 1), 2.0 / (sheet.grid().rows - 1));
  return NodeAir().sample(Air(wind, 1), sheet, spacing, 1.0, 0.0);
}

TEST(NodeAir, InAZoneIsTheZonesAndFadesOverItsEdge) {
  // A box of 1 m x 0.5 m, turned by 90 degrees about z: 0.25 m to each side along x, 0.5 m along y. Half of
  // the edge out, at 3 s^2 - 2 s^3 = 1/2, it is half of either.
  const Particles<float> sheet = test::flat_sheet<float>(17, 17, {2, 2});  // nodes 0.125 m apart
  WindZone zone;
  zone.shape = BoxZone{{1, 0.5, 1}, Quaternion(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitZ()))};
  zone.velocity = {0, 4, 0};
  zone.edge = 0.25;
  Wind wind{{1, 0, 0}, 2.0};
  wind.zones = {zone};
  const VectorField<float> air = air_on(sheet, wind);
  const auto expect = [&](int r, int c, const Vec3& velocity) {
    EXPECT_LT((get(air, r, c) - velocity).norm(), 1e-5) << r << " " << c;
  };
  expect(8, 8, {0, 4, 0});   // the centre
  expect(8, 10, {0, 4, 0});  // x = 0.25: the side
  expect(8, 11, {1, 2, 0});
  expect(8, 12, {2, 0, 0});
  expect(4, 8, {0, 4, 0});  // y = 0.5
  expect(3, 8, {1, 2, 0});
  expect(2, 8, {2, 0, 0});
  // Off the corner by (0.125, 0.125): s = 1 / sqrt(2).
  const double weight = 1 - 0.5 * (3 - 2 / std::sqrt(2));
  expect(3, 11, {2 * (1 - weight), 4 * weight, 0});
}

TEST(NodeAir, ABallIsRoundAndLaterZonesLieOverEarlierOnes) {
  const Particles<float> sheet = test::flat_sheet<float>(17, 17, {2, 2});
  Wind wind{{1, 0, 0}, 2.0};
  wind.zones = {{SphereZone{0.5}, {0, 0, 0}, {0, 0, 3}, 0.125},
                {SphereZone{0.25}, {0, 0, 0}, {0, 0, 0}, 0.01}};
  const VectorField<float> air = air_on(sheet, wind);
  EXPECT_LT(get(air, 8, 8).norm(), 1e-6);  // a lee
  EXPECT_LT((get(air, 8, 12) - Vec3(0, 0, 3)).norm(), 1e-6);
  EXPECT_LT((get(air, 8, 13) - Vec3(2, 0, 0)).norm(), 1e-6);
  EXPECT_LT((get(air, 4, 12) - Vec3(2, 0, 0)).norm(), 1e-6) << "0.71 m off: in no box";
}

// A zone whose air is no number makes numbers of none of the air that it is blended with, however little:
// from far it is not blended.
TEST(NodeAir, ZonesFarFromAllNodesAreSkipped) {
  const Particles<float> sheet = test::flat_sheet<float>(17, 17, {2, 2});
  Wind wind{{1, 0, 0}, 2.0};
  const double none = std::numeric_limits<double>::quiet_NaN();
  wind.zones = {{SphereZone{0.5}, {3, 0, 0}, {none, 0, 0}, 0.1}};  // its edge ends 1.4 m from the sheet's
  each_node(sheet.grid(), [&, air = air_on(sheet, wind)](int r, int c) {
    EXPECT_EQ(get(air, r, c), Vec3(2, 0, 0)) << r << " " << c;
  });
  wind.zones[0].position = {1.5, 0, 0};
  EXPECT_TRUE(std::isnan(get(air_on(sheet, wind), 8, 16).x()));
}

TEST(NodeAir, SkippedZonesWouldHaveChangedNoBit) {
  // A zone on its way from the sheet's middle to 1 m beyond its rim, and the same sheet with a node that
  // stays in the zone, for which it is blended everywhere.
  const Particles<float> sheet = test::flat_sheet<float>(17, 17, {2, 2});
  Particles<float> reaching = sheet;
  WindZone zone;
  zone.shape = BoxZone{{0.3, 0.2, 0.4}, Quaternion(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()))};
  zone.velocity = {0.1, 3, 0.7};
  Wind wind{{1, 0, 0}, 2.0};
  for (int step = 0; step < 200; ++step) {
    zone.position = {0.01 * step, 0.1, 0.05};
    wind.zones = {zone};
    set(reaching.position, 0, 0, zone.position);
    const VectorField<float> air = air_on(sheet, wind), blended = air_on(reaching, wind);
    each_node(sheet.grid(), [&](int r, int c) {
      if (r + c == 0) return;
      EXPECT_EQ(get(air, r, c), get(blended, r, c)) << step << " " << r << " " << c;
    });
  }
}

TEST(NodeAir, IsEverywhereCloseToTheEddies) {
  // 65 x 65 nodes 1/32 m apart: eddies of 0.5 m are evaluated at every fourth node.
  const Particles<float> sheet = test::flat_sheet<float>(65, 65, {2, 2});
  Wind wind{{0, 0, -1}, 5.0};
  wind.turbulence = {0.2, 0.5};  // 1 m/s
  const VectorField<float> air = air_on(sheet, wind);
  const Air direct(wind, 1);
  double squares = 0, largest = 0;
  each_node(sheet.grid(), [&](int r, int c) {
    const Vec3 place = sheet.position_at(r, c);
    const float x = float(place.x()), y = float(place.y()), z = float(place.z());
    float vx = 0, vy = 0, vz = -5;
    direct.add_eddies(1.0, Vec3::Zero(), {&x, &y, &z}, 1, {&vx, &vy, &vz});
    const double off = (get(air, r, c) - Vec3(vx, vy, vz)).norm();
    if (r % 4 == 0 && c % 4 == 0) {
      EXPECT_LT(off, 1e-5) << r << " " << c;
    }
    squares += off * off;
    largest = std::max(largest, off);
  });
  const double rms = std::sqrt(squares / (3 * 65 * 65));  // of a component
  EXPECT_LT(rms, 0.035);
  EXPECT_GT(rms, 0.001) << "not a sample is interpolated";
  EXPECT_LT(largest, 0.35);
}

TEST(NodeAir, LooksAheadToWhereTheNodesGo) {
  Particles<float> sheet = test::flat_sheet<float>(9, 9, {2, 2}), moved = sheet;
  const Vec3 velocity(3, -1, 2);
  each_node(sheet.grid(), [&](int r, int c) {
    set(sheet.velocity, r, c, velocity);
    set(moved.position, r, c, sheet.position_at(r, c) + 0.25 * velocity);
  });
  Wind wind{{0, 0, -1}, 5.0};
  wind.turbulence = {0.2, 0.5};
  const Air air(wind, 1);
  NodeAir ahead, there;
  const VectorField<float>& one = ahead.sample(air, sheet, {0.25, 0.25}, 1.0, 0.25);
  const VectorField<float>& other = there.sample(air, moved, {0.25, 0.25}, 1.0, 0.0);
  each_node(sheet.grid(), [&](int r, int c) { EXPECT_EQ(get(one, r, c), get(other, r, c)); });
}

}  // namespace
}  // namespace weft
