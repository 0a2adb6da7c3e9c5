#include "cloth/core/multiversion.h"

#include <gtest/gtest.h>

#include <array>

namespace weft::kernels {

void add_twice_offset(double* sums, const double* values, int count);

/// A loop as kernels have them, through a lambda that is to become part of it.
WEFT_MULTIVERSION void add_twice_offset(double* sums, const double* values, int count) {
  const auto twice = [](double value) WEFT_INLINE_LAMBDA { return 2 * value; };
  WEFT_INDEPENDENT_ITERATIONS
  for (int i = 0; i < count; ++i) sums[i] += twice(values[i]);
}

namespace {

// Whatever version this machine's processor is given, it is the plain loop: whole vectors and what is left
// over, nothing beyond. All numbers are whole, so that no version may round.
TEST(Multiversion, TheChosenVersionIsThePlainLoop) {
  for (const int count : {0, 1, 7, 16, 37}) {
    std::array<double, 40> sums{}, values{};
    for (std::size_t i = 0; i < sums.size(); ++i) {
      sums[i] = static_cast<double>(i);
      values[i] = static_cast<double>(100 + i * i);
    }
    add_twice_offset(sums.data(), values.data(), count);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const auto index = static_cast<double>(i);
      EXPECT_EQ(sums[i], index + (static_cast<int>(i) < count ? 2 * (100 + index * index) : 0)) << count;
    }
  }
}

// Iterations that the compiler is told are independent may read and write one array, each its own place.
TEST(Multiversion, AnArrayMayBeReadAndWrittenInPlace) {
  std::array<double, 19> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i);
  add_twice_offset(numbers.data(), numbers.data(), 19);
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(numbers[i], 3 * static_cast<double>(i));
}

}  // namespace
}  // namespace weft::kernels
