#include "protocol/bit_stream.h"

#include <gtest/gtest.h>

namespace weft::protocol {
namespace {

// 101 (5), two zeros and a one, 0x1ff in nine bits: from the lowest bit on 101 001 11 | 1111111 0.
TEST(BitStream, TheLowestBitOfEachByteIsFirst) {
  BitWriter writer(32);
  writer.value(5, 3);
  writer.zeros(2);
  writer.value(1, 1);
  writer.value(0x1ff, 9);
  ASSERT_EQ(writer.bytes().size(), 2U);
  EXPECT_EQ(writer.bytes()[0], 0b11100101);
  EXPECT_EQ(writer.bytes()[1], 0b01111111);
}

TEST(BitStream, ComesBackInEveryWidth) {
  BitWriter writer(std::size_t{32} * 33);
  for (int width = 1; width <= 25; ++width) {
    writer.zeros(static_cast<std::uint32_t>(width));
    writer.value(1, 1);
    writer.value(0x55555555U & ((1U << width) - 1), width);
  }
  BitReader reader(writer.bytes());
  for (int width = 1; width <= 25; ++width) {
    EXPECT_EQ(reader.zeros(40), static_cast<std::uint32_t>(width));
    ASSERT_TRUE(reader.has(width));
    EXPECT_EQ(reader.value(width), 0x55555555U & ((1U << width) - 1));
  }
  EXPECT_EQ(reader.unread(), 0U);
  EXPECT_TRUE(reader.rest_is_zero());
}

// Zeros that no one ends are more than any number of them.
TEST(BitStream, WhatEndsTooSoonIsToldSo) {
  const std::uint8_t bytes[] = {0, 0x80};
  BitReader whole{bytes};
  EXPECT_EQ(whole.zeros(20), 15U);
  BitReader few{bytes};
  EXPECT_EQ(few.zeros(14), 15U);  // more than asked for
  BitReader none{std::span(bytes).first(1)};
  EXPECT_EQ(none.zeros(20), 21U);
  EXPECT_FALSE(none.has(1));
}

TEST(BitStream, BitsLeftOverAreSeen) {
  const std::uint8_t bytes[] = {0b00010111, 1};
  BitReader reader{bytes};
  EXPECT_EQ(reader.value(3), 7U);
  EXPECT_FALSE(reader.rest_is_zero());
  EXPECT_EQ(reader.unread(), 1U);
}

}  // namespace
}  // namespace weft::protocol
