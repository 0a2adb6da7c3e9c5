/// States that are written and read; bytes may be anybody's.
#include "cloth/core/archive.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace weft {
namespace {

template <class... Values>
std::string written(const Values&... values) {
  std::string bytes;
  StateWriter writer(bytes);
  writer(values...);
  return bytes;
}

template <class Value>
Value read_as(const std::string& bytes) {
  Value value{};
  StateReader reader(bytes);
  reader(value);
  return value;
}

TEST(Archive, WhatIsWrittenIsRead) {
  EXPECT_EQ(read_as<bool>(written(true)), true);
  EXPECT_EQ(read_as<bool>(written(false)), false);
  EXPECT_EQ(read_as<std::optional<double>>(written(std::optional<double>(2.5))), 2.5);
  EXPECT_EQ(read_as<std::optional<double>>(written(std::optional<double>())), std::nullopt);
  const std::vector<bool> answers{true, false, true};
  EXPECT_EQ(read_as<std::vector<bool>>(written(answers)), answers);
}

// C++ has no bool of the value 4: it must not come to be one.
TEST(Archive, AByteThatIsNeitherYesNorNoIsRefused) {
  EXPECT_THROW(read_as<bool>("\4"), BadState);
  EXPECT_THROW(read_as<std::optional<int>>(std::string("\4\0\0\0\0", 5)), BadState);
}

TEST(Archive, BytesThatEndTooEarlyAreRefused) {
  EXPECT_THROW(read_as<bool>(""), BadState);
  EXPECT_THROW(read_as<double>("1234567"), BadState);
  const std::string list = written(std::vector<double>(3, 1.0));
  EXPECT_THROW(read_as<std::vector<double>>(list.substr(0, list.size() - 1)), BadState);
  EXPECT_THROW(read_as<std::vector<double>>(std::string(8, '\x7f')), BadState);  // as many elements as that
}

}  // namespace
}  // namespace weft
