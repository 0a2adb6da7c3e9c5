#include "cloth/air/air.h"

#include <gtest/gtest.h>

#include <array>

namespace weft {
namespace {

Wind blowing(double speed, double gusts = 0, double turbulence = 0) {
  Wind wind;
  wind.direction = {0.6, 0, -0.8};
  wind.speed = speed;
  wind.gusts.intensity = gusts;
  wind.turbulence.intensity = turbulence;
  return wind;
}

/// The eddies' velocity at one point.
Vec3 eddy_at(const Air& air, double time, const Vec3& point) {
  const auto x = static_cast<float>(point.x()), y = static_cast<float>(point.y()),
             z = static_cast<float>(point.z());
  std::array<float, 3> velocity{0, 0, 0};
  air.add_eddies(time, {0, 0, 0}, {&x, &y, &z}, 1, {&velocity[0], &velocity[1], &velocity[2]});
  return {double(velocity[0]), double(velocity[1]), double(velocity[2])};
}

TEST(Air, WithoutAWindIsStill) {
  const Air air;
  EXPECT_TRUE(air.steady());
  EXPECT_TRUE(air.uniform());
  EXPECT_EQ(air.velocity(3), Vec3(0, 0, 0));
}

TEST(Air, ASteadyWindIsItsMean) {
  const Air air(blowing(5), 1);
  EXPECT_TRUE(air.steady());
  EXPECT_TRUE(air.uniform());
  EXPECT_EQ(air.gusts(), nullptr);
  for (const double time : {0.0, 7.5}) EXPECT_LT((air.velocity(time) - Vec3(3, 0, -4)).norm(), 1e-15);
  EXPECT_TRUE(eddy_at(air, 1, {1, 2, 3}).isZero(0));
}

// Intensities are shares of the speed: of no wind there are neither gusts nor eddies.
TEST(Air, CalmHasNoGustsNorEddies) {
  const Air air(blowing(0, 0.3, 0.3), 1);
  EXPECT_TRUE(air.steady());
  EXPECT_FALSE(air.turbulent());
}

// They change its speed by their factor, not its direction.
TEST(Air, GustsComeAndGoAlongTheWind) {
  const Air air(blowing(5, 0.2), 1);
  EXPECT_FALSE(air.steady());
  EXPECT_TRUE(air.uniform());
  ASSERT_NE(air.gusts(), nullptr);
  double least = 1e9, most = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec3 velocity = air.velocity(0.3 * i);
    const double speed = velocity.dot(Vec3(0.6, 0, -0.8));
    EXPECT_LT((velocity - speed * Vec3(0.6, 0, -0.8)).norm(), 1e-12);
    EXPECT_NEAR(speed, 5 * air.gusts()->factor(0.3 * i), 1e-12);
    least = std::min(least, speed);
    most = std::max(most, speed);
  }
  EXPECT_LT(least, 4.8);
  EXPECT_GT(most, 5.2);
}

TEST(Air, ZonesMakeItDifferentFromPlaceToPlaceButSteady) {
  Wind wind = blowing(5);
  wind.zones.push_back({SphereZone{1}, {0, 0, 0}, {0, 0, 0}, 0.1});
  const Air air(wind, 1);
  EXPECT_TRUE(air.steady());
  EXPECT_FALSE(air.uniform());
  EXPECT_LT((air.velocity(1) - Vec3(3, 0, -4)).norm(), 1e-15);  // outside of them
}

TEST(Air, OfEqualSeedsIsEqualToTheBit) {
  const Air a(blowing(5, 0.2, 0.1), 7), same(blowing(5, 0.2, 0.1), 7), other(blowing(5, 0.2, 0.1), 8);
  EXPECT_EQ(a.velocity(2.5), same.velocity(2.5));
  EXPECT_NE(a.velocity(2.5), other.velocity(2.5));
  EXPECT_EQ(eddy_at(a, 2.5, {1, 2, 3}), eddy_at(same, 2.5, {1, 2, 3}));
  EXPECT_NE(eddy_at(a, 2.5, {1, 2, 3}), eddy_at(other, 2.5, {1, 2, 3}));
}

// Taylor's hypothesis: what turns over slowly is met later as far down the wind.
TEST(Air, TheWindCarriesItsEddiesAlong) {
  Wind wind = blowing(5, 0, 0.001);
  const Air air(wind, 3);
  EXPECT_TRUE(air.turbulent());
  const Vec3 first = eddy_at(air, 0, {0.5, 0.5, 0.5});
  const Vec3 later = eddy_at(air, 0.4, Vec3(0.5, 0.5, 0.5) + 0.4 * wind.velocity());
  EXPECT_GT(first.norm(), 1e-4);
  EXPECT_LT((later - first).norm(), 0.02 * first.norm());
}

// They are where the wind so far has carried them, at the strength of the wind that is: no jump but that.
TEST(Air, AfterAChangeEddiesGoOnFromWhereTheyHaveGot) {
  Air air(blowing(5, 0, 0.1), 3);
  const Vec3 point(0.3, -0.2, 0.9), before = eddy_at(air, 2, point);
  EXPECT_GT(before.norm(), 1e-3);
  Wind twice = blowing(10, 0, 0.1);
  air.change(twice, 2);
  EXPECT_LT((eddy_at(air, 2, point) - 2 * before).norm(), 1e-5 * before.norm());
  EXPECT_EQ(air.wind().speed, 10);
  // Both together carry them: 2 s at 5 m/s and 1 s at 10 m/s as far as 4 s at 5 m/s, and turned over as much.
  const Air unchanged(blowing(5, 0, 0.1), 3);
  EXPECT_LT((eddy_at(air, 3, point) - 2 * eddy_at(unchanged, 4, point)).norm(), 1e-4);
}

TEST(Air, AChangeEndsGustsAndEddiesThatItHasNot) {
  Air air(blowing(5, 0.2, 0.1), 3);
  air.change(blowing(5), 1);
  EXPECT_TRUE(air.steady());
  EXPECT_FALSE(air.turbulent());
  EXPECT_LT((air.velocity(1) - Vec3(3, 0, -4)).norm(), 1e-15);
}

}  // namespace
}  // namespace weft
