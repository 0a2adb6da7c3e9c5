// Properties of the lattice and of the codec, on grids nobody chose by hand.
#include "protocol/grid_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace weft::protocol {
namespace {

/// A grid with its storage: rows padded, steps as asked.
struct Sheet {
  int rows, cols;
  std::ptrdiff_t stride;
  std::array<std::vector<float>, 3> axes;

  Sheet(int row_count, int col_count) : rows(row_count), cols(col_count), stride((col_count + 15) / 16 * 16) {
    for (auto& axis : axes) axis.resize(static_cast<std::size_t>(rows * stride));
  }
  float& at(int axis, int r, int c) {
    return axes[static_cast<std::size_t>(axis)][static_cast<std::size_t>(r * stride + c)];
  }
  GridView view() const { return {{axes[0].data(), axes[1].data(), axes[2].data()}, rows, cols, stride, 1}; }
  /// Every second node: level L - 1 of the same storage.
  GridView coarse() const {
    return {{axes[0].data(), axes[1].data(), axes[2].data()}, (rows + 1) / 2, (cols + 1) / 2, 2 * stride, 2};
  }
};

Sheet random_sheet(int rows, int cols, std::mt19937& random, double centre, double extent) {
  std::uniform_real_distribution<double> offset(-extent / 2, extent / 2);
  Sheet sheet(rows, cols);
  for (int axis = 0; axis < 3; ++axis) {
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < cols; ++c) sheet.at(axis, r, c) = static_cast<float>(centre + offset(random));
    }
  }
  return sheet;
}

bool is_power_of_two(float value) {
  int exponent = 0;
  return std::frexp(value, &exponent) == 0.5F;
}

/// The finest quantum that can cover the sheet is at most this factor from the one without a lattice:
/// rounding the origin down can cost one more power of two.
constexpr double kFinestFactor = 4;

void expect_fits(Sheet& sheet, int bits) {
  const Quantisation lattice = choose_quantisation(sheet.view(), bits);
  ASSERT_EQ(lattice.bits, bits);
  ASSERT_TRUE(is_power_of_two(lattice.quantum)) << lattice.quantum;
  double extent = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& values = sheet.axes[static_cast<std::size_t>(axis)];
    double low = values[0], high = values[0];
    for (int r = 0; r < sheet.rows; ++r) {
      for (int c = 0; c < sheet.cols; ++c) {
        low = std::min(low, double(sheet.at(axis, r, c)));
        high = std::max(high, double(sheet.at(axis, r, c)));
      }
    }
    extent = std::max(extent, high - low);
    const double multiple = double(lattice.origin[static_cast<std::size_t>(axis)]) / double(lattice.quantum);
    ASSERT_EQ(multiple, std::floor(multiple)) << "origin is not on the lattice";
  }
  EXPECT_LE(double(lattice.quantum),
            std::max(std::ldexp(1.0, -24), kFinestFactor * extent / double((1 << bits) - 1)));

  std::vector<std::uint8_t> payload;
  encode_grid(sheet.view(), lattice, payload);
  std::vector<float> decoded;
  std::string error;
  ASSERT_TRUE(decode_grid(payload, sheet.rows, sheet.cols, lattice, decoded, error)) << error;

  for (int axis = 0; axis < 3; ++axis) {
    for (int r = 0; r < sheet.rows; ++r) {
      for (int c = 0; c < sheet.cols; ++c) {
        const double p = double(sheet.at(axis, r, c));
        const double q = std::floor(
            (p - double(lattice.origin[static_cast<std::size_t>(axis)])) / double(lattice.quantum) + 0.5);
        const double exact = lattice.decode(axis, static_cast<std::uint32_t>(q));
        ASSERT_LE(std::abs(exact - p), double(lattice.quantum) / 2);
        ASSERT_EQ(decoded[static_cast<std::size_t>(3 * (r * sheet.cols + c) + axis)],
                  static_cast<float>(exact));
      }
    }
  }
}

TEST(GridCodec, DecodesWithinHalfAQuantum) {
  std::mt19937 random(1);
  for (const double centre : {0.0, 0.3, -7.7, 1000.1, -1e6, 1e9}) {
    for (const double extent : {0.0, 1e-9, 1e-6, 0.01, 0.999, 2.0, 37.0, 1e5}) {
      for (const int bits : {8, 11, 16}) {
        SCOPED_TRACE(testing::Message() << "centre " << centre << ", extent " << extent << ", bits " << bits);
        Sheet sheet = random_sheet(5, 7, random, centre, extent);
        expect_fits(sheet, bits);
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST(GridCodec, EverySmallShapeRoundTrips) {
  std::mt19937 random(2);
  for (int rows = 2; rows <= 20; ++rows) {
    for (int cols = 2; cols <= 20; ++cols) {
      SCOPED_TRACE(testing::Message() << rows << " x " << cols);
      Sheet sheet = random_sheet(rows, cols, random, 0.1, 3.0);
      expect_fits(sheet, 16);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(GridCodec, LongestSidesRoundTrip) {
  std::mt19937 random(3);
  for (const auto& [rows, cols] : {std::pair{2, 1025}, std::pair{1025, 2}}) {
    Sheet sheet = random_sheet(rows, cols, random, -2.0, 5.0);
    expect_fits(sheet, 16);
  }
}

TEST(GridCodec, OnlyOneAxisHasExtent) {
  Sheet sheet(3, 3);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      sheet.at(0, r, c) = 0.1F * static_cast<float>(c);
      sheet.at(1, r, c) = 123.456F;
      sheet.at(2, r, c) = 0.0F;
    }
  }
  expect_fits(sheet, 16);
}

// 65535 quanta cover an extent of 65535/32768 m exactly; the least bit more needs the next power of two.
TEST(GridCodec, ChoosesTheFinestQuantumThatCovers) {
  Sheet sheet(2, 2);
  sheet.at(0, 1, 1) = 65535.0F / 32768.0F;
  EXPECT_EQ(choose_quantisation(sheet.view(), 16).quantum, 1.0F / 32768.0F);
  // A half quantum more still rounds down to 65535 or up to 65536: up, so it is not covered.
  sheet.at(0, 1, 1) = 65535.5F / 32768.0F;
  EXPECT_EQ(choose_quantisation(sheet.view(), 16).quantum, 1.0F / 16384.0F);
  sheet.at(0, 1, 1) = 65535.4375F / 32768.0F;
  EXPECT_EQ(choose_quantisation(sheet.view(), 16).quantum, 1.0F / 32768.0F);
}

// A page would shimmer if a node at rest moved because another one did.
TEST(GridCodec, NodesAtRestStayWhereTheyAreDecoded) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> nudge(-0.02F, 0.02F);
  int compared = 0;
  Sheet sheet = random_sheet(9, 9, random, 3.3, 1.5);
  for (int trial = 0; trial < 50; ++trial) {
    Sheet next = sheet;
    for (int axis = 0; axis < 3; ++axis) {
      for (int c = 0; c < 9; ++c)
        next.at(axis, trial % 9, c) += nudge(random);  // one row moves, and the box with it
    }
    const Quantisation before = choose_quantisation(sheet.view(), 16),
                       after = choose_quantisation(next.view(), 16);
    if (before.quantum != after.quantum) continue;
    std::vector<std::uint8_t> first, second;
    encode_grid(sheet.view(), before, first);
    encode_grid(next.view(), after, second);
    std::vector<float> was, is;
    std::string error;
    ASSERT_TRUE(decode_grid(first, 9, 9, before, was, error)) << error;
    ASSERT_TRUE(decode_grid(second, 9, 9, after, is, error)) << error;
    for (int r = 0; r < 9; ++r) {
      if (r == trial % 9) continue;
      for (int i = 0; i < 27; ++i) {
        const auto at = static_cast<std::size_t>(r * 27 + i);
        ASSERT_EQ(was[at], is[at]);
      }
    }
    compared += before.origin != after.origin;
  }
  EXPECT_GT(compared, 5) << "the box hardly ever moved: nothing was tested";
}

// A float has 1 mm at 10 km, the lattice 31 um: its origin is a float all the same, a multiple of the
// quantum.
TEST(GridCodec, IsAsFineFarFromTheOrigin) {
  std::mt19937 random(8);
  for (const double far : {200.0, 10000.0, -10000.0, 1e6}) {
    const Sheet sheet = random_sheet(9, 9, random, 0.0, 1.9);
    GridView view = sheet.view();
    const float quantum = choose_quantisation(view, 16).quantum;
    view.place = {far, -2 * far, 4};
    const Quantisation lattice = choose_quantisation(view, 16);
    EXPECT_LE(lattice.quantum, 2 * quantum);
    std::vector<std::uint8_t> payload;
    encode_grid(view, lattice, payload);
    Quantisation from_origin = lattice;
    from_origin.origin = {};
    std::vector<float> offsets;
    std::string error;
    ASSERT_TRUE(decode_grid(payload, 9, 9, from_origin, offsets, error)) << error;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double origin = double(lattice.origin[a]);
      EXPECT_EQ(std::remainder(origin, double(lattice.quantum)), 0);
      for (int r = 0; r < 9; ++r) {
        for (int c = 0; c < 9; ++c) {
          const double offset = double(offsets[static_cast<std::size_t>(3 * (9 * r + c) + axis)]);
          EXPECT_NEAR(origin + offset, view.place[a] + double(view.data[a][r * view.row_step + c]),
                      double(lattice.quantum) / 2);
        }
      }
    }
  }
}

// Levels are nested: every second node of the storage is the coarser level.
TEST(GridCodec, StepsOfTwoEncodeTheCoarserLevel) {
  std::mt19937 random(5);
  Sheet fine = random_sheet(9, 17, random, 0.0, 2.0);
  Sheet coarse(5, 9);
  for (int axis = 0; axis < 3; ++axis) {
    for (int r = 0; r < 5; ++r) {
      for (int c = 0; c < 9; ++c) coarse.at(axis, r, c) = fine.at(axis, 2 * r, 2 * c);
    }
  }
  const Quantisation lattice = choose_quantisation(coarse.view(), 14);
  const Quantisation same = choose_quantisation(fine.coarse(), 14);
  EXPECT_EQ(lattice.quantum, same.quantum);
  EXPECT_EQ(lattice.origin, same.origin);
  std::vector<std::uint8_t> of_copy, of_view;
  encode_grid(coarse.view(), lattice, of_copy);
  encode_grid(fine.coarse(), same, of_view);
  EXPECT_EQ(of_view, of_copy);
}

// The payload is appended: what stands before it is a record's header.
TEST(GridCodec, AppendsToWhatIsThere) {
  std::mt19937 random(6);
  const Sheet sheet = random_sheet(4, 4, random, 0.0, 1.0);
  const Quantisation lattice = choose_quantisation(sheet.view(), 12);
  std::vector<std::uint8_t> alone, after{1, 2, 3};
  encode_grid(sheet.view(), lattice, alone);
  encode_grid(sheet.view(), lattice, after);
  alone.insert(alone.begin(), {1, 2, 3});
  EXPECT_EQ(after, alone);
}

// A wavy 65 x 65 sheet takes 2.7 bytes a node at most at 16 bits (streaming.md measured 2.6 on windy cloth,
// raw is 6).
TEST(GridCodec, SmoothClothIsSmall) {
  Sheet sheet(65, 65);
  for (int r = 0; r < 65; ++r) {
    for (int c = 0; c < 65; ++c) {
      const double u = c / 64.0, v = r / 64.0;
      sheet.at(0, r, c) = static_cast<float>(2 * u - 1 + 0.01 * std::sin(7 * v));
      sheet.at(1, r, c) = static_cast<float>(1 - 2 * v + 0.003 * std::sin(40 * u));
      sheet.at(2, r, c) = static_cast<float>(0.2 * std::sin(12 * u + 6 * v) + 0.05 * std::sin(34 * v));
    }
  }
  std::vector<std::uint8_t> payload;
  encode_grid(sheet.view(), choose_quantisation(sheet.view(), 16), payload);
  EXPECT_LT(double(payload.size()) / (65 * 65), 2.7);
}

}  // namespace
}  // namespace weft::protocol
