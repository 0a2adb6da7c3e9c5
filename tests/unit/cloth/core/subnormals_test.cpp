#include "cloth/core/subnormals.h"

#include <gtest/gtest.h>

#include <limits>
#include <thread>

namespace weft {
namespace {

#if defined(__SSE__)
TEST(FlushSubnormals, OnThisThreadAlone) {
  const auto halve = [](auto smallest) {  // volatile: the processor halves, not the compiler
    const volatile auto number = smallest;
    return number / 2;
  };
  const auto add = [](float a) {
    const volatile float number = a;
    return number + 0.0F;
  };
  float single = -1, denormal = -1;
  double twofold = -1;
  std::thread flushes([&] {
    flush_subnormals();
    single = halve(std::numeric_limits<float>::min());
    twofold = halve(std::numeric_limits<double>::min());
    denormal = add(std::numeric_limits<float>::denorm_min());
  });
  flushes.join();
  EXPECT_EQ(single, 0);
  EXPECT_EQ(twofold, 0);
  EXPECT_EQ(denormal, 0) << "one that is read, too";
  EXPECT_GT(halve(std::numeric_limits<float>::min()), 0) << "another thread's are as they were";
}

TEST(FlushSubnormals, AsLongAsItIsAskedFor) {
  const auto halved = [] {
    const volatile float smallest = std::numeric_limits<float>::min();
    return smallest / 2;
  };
  {
    const FlushedSubnormals flushed;
    EXPECT_EQ(halved(), 0);
  }
  EXPECT_GT(halved(), 0);
}
#endif

}  // namespace
}  // namespace weft
