#include "cloth/core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cloth/core/fnv1a.h"

namespace weft {
namespace {

// The C++ standard, [rand.predef]: the 10000th value of a default-seeded (5489) mt19937_64.
TEST(Random, IsTheStandardsGenerator) {
  Random random(std::mt19937_64::default_seed);
  for (int i = 0; i < 9999; ++i) random.symmetric();
  EXPECT_EQ(random.symmetric(), static_cast<double>(9981545732273789042ULL >> 11) * 0x1p-52 - 1.0);
}

// Uniform ones: mean 0 and variance 1/3; normal ones: mean 0, variance 1. Of n numbers the mean is off by
// sqrt(variance / n), here by at most five times that.
TEST(Random, HasItsMeansAndVariances) {
  constexpr int kNumbers = 20000;
  Random random(3);
  double uniform = 0, uniform_squares = 0, normal = 0, normal_squares = 0;
  for (int i = 0; i < kNumbers; ++i) {
    const double u = random.symmetric(), n = random.normal(), b = random.between(2, 5);
    EXPECT_TRUE(u >= -1 && u < 1);
    EXPECT_TRUE(b >= 2 && b < 5);
    uniform += u;
    uniform_squares += u * u;
    normal += n;
    normal_squares += n * n;
  }
  EXPECT_NEAR(uniform / kNumbers, 0, 5 * std::sqrt(1.0 / 3 / kNumbers));
  EXPECT_NEAR(uniform_squares / kNumbers, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / kNumbers));
  EXPECT_NEAR(normal / kNumbers, 0, 5 * std::sqrt(1.0 / kNumbers));
  EXPECT_NEAR(normal_squares / kNumbers, 1, 5 * std::sqrt(2.0 / kNumbers));
}

// Noll's published test vectors.
TEST(Fnv1a, GivesThePublishedHashes) {
  EXPECT_EQ(Fnv1a().value(), 0xcbf29ce484222325ULL);
  Fnv1a a, foobar;
  a.add("a", 1);
  EXPECT_EQ(a.value(), 0xaf63dc4c8601ec8cULL);
  foobar.add("foobar", 6);
  EXPECT_EQ(foobar.value(), 0x85944171f73967e8ULL);
}

}  // namespace
}  // namespace weft
