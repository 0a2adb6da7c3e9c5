#include "cloth/kernels/extent_kernels.h"

#include <gtest/gtest.h>

#include <vector>

namespace weft::kernels {
namespace {

// values(r, c) = (r - 2)^2 - c over five rows: 4 - c at most, -c at least; what lies beyond the columns is
// not read.
TEST(ExtentKernels, AreFoundColumnByColumn) {
  constexpr int kRows = 5, kStride = 24, kCols = 19;
  std::vector<float> values(kRows * kStride, 1e9F);
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kCols; ++c)
      values[static_cast<std::size_t>(r * kStride + c)] = static_cast<float>((r - 2) * (r - 2) - c);
  std::vector<float> low(kStride, 7), high(kStride, 7);
  column_extents(values.data(), kRows, kStride, kCols, low.data(), high.data());
  for (int c = 0; c < kCols; ++c) {
    EXPECT_EQ(low[static_cast<std::size_t>(c)], static_cast<float>(-c));
    EXPECT_EQ(high[static_cast<std::size_t>(c)], static_cast<float>(4 - c));
  }
  EXPECT_EQ(high[kCols], 7);
}

}  // namespace
}  // namespace weft::kernels
