#include "protocol/rice_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "protocol/frame.h"

namespace weft::protocol {
namespace {

constexpr std::size_t kCodecAt = 10;

struct Nodes {
  int rows, cols;
  std::array<std::vector<float>, 3> axes;
  GridView view() const { return {{axes[0].data(), axes[1].data(), axes[2].data()}, rows, cols, cols, 1}; }
};

template <class Position>
Nodes nodes_at(int rows, int cols, Position&& position) {
  Nodes nodes{rows, cols, {}};
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      const std::array<double, 3> p = position(r, c);
      for (std::size_t axis = 0; axis < 3; ++axis) nodes.axes[axis].push_back(static_cast<float>(p[axis]));
    }
  }
  return nodes;
}

/// Of numbers from -`extent` to `extent`, each by itself.
Nodes noise(int rows, int cols, double extent, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> offset(-extent, extent);
  return nodes_at(rows, cols, [&](int, int) {
    return std::array{offset(random), offset(random), offset(random)};
  });
}

/// A sheet of 2 m x 2 m with waves a few cells long.
Nodes waving_sheet(int side) {
  return nodes_at(side, side, [&](int r, int c) {
    const double u = double(c) / (side - 1), v = double(r) / (side - 1);
    return std::array{2 * u + 0.02 * std::sin(9 * v), -2 * v,
                      0.2 * std::sin(7 * u + 3 * v) + 0.02 * std::sin(31 * u - 17 * v)};
  });
}

/// Both codecs hold the same lattice values, so what they decode to is the same to the bit.
void expect_as_codec_1(const Nodes& nodes, int bits) {
  const Quantisation lattice = choose_quantisation(nodes.view(), bits);
  std::vector<std::uint8_t> plain, rice;
  encode_grid(nodes.view(), lattice, plain);
  encode_rice_grid(nodes.view(), lattice, rice);
  std::vector<float> wanted, decoded;
  std::string error;
  ASSERT_TRUE(decode_grid(plain, nodes.rows, nodes.cols, lattice, wanted, error)) << error;
  ASSERT_TRUE(decode_rice_grid(rice, nodes.rows, nodes.cols, lattice, decoded, error)) << error;
  ASSERT_EQ(decoded, wanted);
}

TEST(RiceCodec, EverySmallShapeDecodesAsByCodec1) {
  for (int rows = 2; rows <= 12; ++rows) {
    for (int cols = 2; cols <= 12; ++cols) {
      for (const int bits : {8, 16}) {
        SCOPED_TRACE(testing::Message() << rows << " x " << cols << ", " << bits << " bits");
        expect_as_codec_1(noise(rows, cols, 1.5, 1), bits);
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST(RiceCodec, SheetsAndLongSidesDecodeAsByCodec1) {
  expect_as_codec_1(waving_sheet(65), 16);
  expect_as_codec_1(noise(2, kMaxSide, 3, 2), 16);
  expect_as_codec_1(noise(kMaxSide, 2, 3, 3), 16);
}

// Corners of the lattice by turns: differences of +-131070 and residuals beyond any quotient.
TEST(RiceCodec, LargestDifferencesDecodeAsByCodec1) {
  expect_as_codec_1(nodes_at(9, 9,
                             [](int r, int c) {
                               return std::array{(r + c) % 2 * 1.0, r % 2 * 1.0, c % 2 * 1.0};
                             }),
                    16);
  expect_as_codec_1(
      nodes_at(9, 9,
               [](int r, int c) {
                 return std::array{r == 4 && c == 4 ? 1.0 : 0.0, r / 3 % 2 * 1.0, c == 8 ? 1.0 : 0.0};
               }),
      16);
}

TEST(RiceCodec, ASheetTakesAFifthLessThanByCodec1) {
  const Nodes sheet = waving_sheet(65);
  const auto plain = encode_cloth_record({}, 0, 6, 6, 16, sheet.view());
  const auto rice = encode_cloth_record({}, 0, 6, 6, 16, sheet.view(), kMinQuantumExponent, GridCoding::rice);
  EXPECT_EQ(rice[kCodecAt], 4);
  EXPECT_LT(double(rice.size()), 0.8 * double(plain.size()));
}

// Every fifth row is noise and the others lie still: where one begins, parameters from the rows before are as
// wrong as can be, and they are for the rows after it.
TEST(RiceCodec, WhatCannotBeForeseenIsLeftToCodec1) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> offset(-1, 1);
  const Nodes sheet = nodes_at(33, 33, [&](int r, int) {
    const auto next = [&] { return r % 5 == 4 ? offset(random) : 0.0; };
    return std::array{next(), next(), next()};
  });
  const auto record =
      encode_cloth_record({}, 0, 5, 5, 16, sheet.view(), kMinQuantumExponent, GridCoding::rice);
  EXPECT_EQ(record, encode_cloth_record({}, 0, 5, 5, 16, sheet.view()));
}

TEST(RiceCodec, EachBeginningOfAPayloadIsRefused) {
  const Nodes sheet = waving_sheet(9);
  const Quantisation lattice = choose_quantisation(sheet.view(), 16);
  std::vector<std::uint8_t> payload;
  encode_rice_grid(sheet.view(), lattice, payload);
  std::vector<float> decoded;
  for (std::size_t size = 0; size < payload.size(); ++size) {
    std::string error;
    EXPECT_FALSE(decode_rice_grid(std::span(payload).first(size), 9, 9, lattice, decoded, error)) << size;
    EXPECT_EQ(error, "grid payload too short");
  }
}

}  // namespace
}  // namespace weft::protocol
