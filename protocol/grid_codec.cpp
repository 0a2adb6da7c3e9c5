#include "protocol/grid_codec.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "protocol/quantised_rows.h"

namespace weft::protocol {
namespace {

static_assert(std::endian::native == std::endian::little,
              "bits are packed with little-endian loads and stores");

constexpr int kGroup = 16;  ///< values that share a width
/// Residuals of 16-bit values lie within +-131070, so zig-zagged below 2^18.
constexpr int kMaxWidth = 18;
constexpr std::size_t kSlack = 8;  ///< whole words are loaded and stored, up to this far beyond the last bit

std::size_t index(int i) { return static_cast<std::size_t>(i); }
std::size_t group_bytes(int values, int width) { return static_cast<std::size_t>((values * width + 7) / 8); }

struct Interval {
  float low = std::numeric_limits<float>::infinity(), high = -std::numeric_limits<float>::infinity();
};

/// Eight running minima and maxima instead of one: one alone is a chain the compiler may not vectorise.
Interval interval_of(const GridView& grid, std::size_t axis) {
  constexpr int kLanes = 8;
  std::array<float, kLanes> low, high;
  low.fill(Interval{}.low);
  high.fill(Interval{}.high);
  std::vector<float> copy(grid.col_step == 1 ? 0 : index(grid.cols));
  for (int r = 0; r < grid.rows; ++r) {
    const float* row = row_of(grid, axis, r, copy);
    int c = 0;
    for (; c + kLanes <= grid.cols; c += kLanes) {
      for (int lane = 0; lane < kLanes; ++lane) {
        const float value = row[c + lane];
        low[index(lane)] = value < low[index(lane)] ? value : low[index(lane)];
        high[index(lane)] = value > high[index(lane)] ? value : high[index(lane)];
      }
    }
    for (; c < grid.cols; ++c) {
      low[0] = std::min(low[0], row[c]);
      high[0] = std::max(high[0], row[c]);
    }
  }
  return {*std::min_element(low.begin(), low.end()), *std::max_element(high.begin(), high.end())};
}

/// `values` packed at `out`, which has kSlack bytes more than they need. Pairs, since two fit any word.
void pack(const std::uint32_t* values, int count, int width, std::uint8_t* out) {
  std::uint64_t word = 0;
  int fill = 0;
  for (int i = 0; i < count; i += 2) {
    const std::uint64_t second = i + 1 < count ? values[i + 1] : 0;
    word |= (values[i] | second << width) << fill;
    fill += 2 * width;
    std::memcpy(out, &word, sizeof word);
    out += fill / 8;
    word >>= fill & ~7;
    fill &= 7;
  }
}

void unpack(const std::uint8_t* in, int count, int width, std::uint32_t* values) {
  const std::uint32_t mask = (1U << width) - 1;
  for (int i = 0, bit = 0; i < count; ++i, bit += width) {
    std::uint32_t word = 0;
    std::memcpy(&word, in + bit / 8, sizeof word);
    values[i] = word >> (bit & 7) & mask;
  }
}

/// The largest float that is at most `value`. Of a multiple of a power of two it is a multiple, too: its own
/// last digit is worth more, or it is the value itself.
float float_below(double value) {
  const float nearest = static_cast<float>(value);
  return double(nearest) > value ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest;
}

/// Zig-zagged residuals of one axis. With d = q - (q above), q - P is d - (d to the left).
void residuals(const GridView& grid, std::size_t axis, const Quantisation& quantisation,
               std::vector<std::uint32_t>& out) {
  QuantisedRows rows(grid, axis, quantisation);
  const int cols = grid.cols;
  std::vector<std::int32_t> above(index(cols), 0), here(index(cols)), difference(index(cols) + 1, 0);
  for (int r = 0; r < grid.rows; ++r) {
    rows.read(r, here.data());
    for (int c = 0; c < cols; ++c) difference[index(c) + 1] = here[index(c)] - above[index(c)];
    std::uint32_t* z = out.data() + index(r) * index(cols);
    for (int c = 0; c < cols; ++c) z[c] = zigzag(difference[index(c) + 1] - difference[index(c)]);
    std::swap(above, here);
  }
}

}  // namespace

GridBox box_of(const GridView& grid) {
  GridBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Interval interval = interval_of(grid, axis);
    box.low[axis] = grid.place[axis] + double(interval.low);
    box.high[axis] = grid.place[axis] + double(interval.high);
  }
  return box;
}

Quantisation choose_quantisation(const GridView& grid, int bits, int min_exponent) {
  const auto [low, high] = box_of(grid);
  double extent = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) extent = std::max(extent, high[axis] - low[axis]);
  const double top = double((1 << bits) - 1);
  int exponent = min_exponent;
  if (extent > 0) exponent = std::max(exponent, std::ilogb(extent / top));
  // A quantum of at least extent / top is needed, one more when the grid does not start on the lattice.
  for (;; ++exponent) {
    const double quantum = std::ldexp(1.0, exponent);
    Quantisation chosen{bits, {}, static_cast<float>(quantum)};
    bool covers = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      chosen.origin[axis] = float_below(std::floor(low[axis] / quantum) * quantum);
      covers = covers && std::floor((high[axis] - double(chosen.origin[axis])) / quantum + 0.5) <= top;
    }
    if (covers) return chosen;
  }
}

void encode_grid(const GridView& grid, const Quantisation& quantisation, std::vector<std::uint8_t>& out) {
  const std::size_t nodes = index(grid.rows) * index(grid.cols);
  const std::size_t groups = (nodes + kGroup - 1) / kGroup;
  const std::size_t start = out.size();
  out.resize(start + 3 * groups * (1 + group_bytes(kGroup, kMaxWidth)) + kSlack);
  std::uint8_t* to = out.data() + start;
  std::vector<std::uint32_t> z(nodes);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    residuals(grid, axis, quantisation, z);
    for (std::size_t first = 0; first < nodes; first += kGroup) {
      const int count = static_cast<int>(std::min<std::size_t>(kGroup, nodes - first));
      std::uint32_t any = 0;
      for (int i = 0; i < count; ++i) any |= z[first + index(i)];
      const int width = static_cast<int>(std::bit_width(any));
      *to++ = static_cast<std::uint8_t>(width);
      pack(z.data() + first, count, width, to);
      to += group_bytes(count, width);
    }
  }
  out.resize(static_cast<std::size_t>(to - out.data()));
}

bool decode_grid(std::span<const std::uint8_t> payload, int rows, int cols, const Quantisation& quantisation,
                 std::vector<float>& xyz, std::string& error) {
  const auto fail = [&](std::string reason) {
    error = std::move(reason);
    return false;
  };
  if (rows < kMinSide || rows > kMaxSide || cols < kMinSide || cols > kMaxSide)
    return fail("grid of " + std::to_string(rows) + " rows and " + std::to_string(cols) + " columns");
  const std::size_t nodes = index(rows) * index(cols);
  // A group is at least its width byte: no payload buys more memory than it is long.
  if (payload.size() < 3 * ((nodes + kGroup - 1) / kGroup)) return fail("grid payload too short");

  const auto top = static_cast<std::uint32_t>((1 << quantisation.bits) - 1);
  xyz.resize(nodes * 3);
  std::vector<std::uint32_t> z((nodes + kGroup - 1) / kGroup * kGroup);
  std::vector<std::int32_t> above(index(cols));
  std::size_t at = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t first = 0; first < nodes; first += kGroup) {
      if (at == payload.size()) return fail("grid payload too short");
      const int width = payload[at++];
      if (width > kMaxWidth) return fail("group width " + std::to_string(width));
      const int count = static_cast<int>(std::min<std::size_t>(kGroup, nodes - first));
      const std::size_t bytes = group_bytes(count, width);
      if (payload.size() - at < bytes) return fail("grid payload too short");
      std::array<std::uint8_t, kGroup * kMaxWidth / 8 + kSlack> group{};
      std::memcpy(group.data(), payload.data() + at, bytes);
      at += bytes;
      unpack(group.data(), count, width, z.data() + first);
    }
    std::fill(above.begin(), above.end(), 0);
    for (int r = 0; r < rows; ++r) {
      const std::uint32_t* residual = z.data() + index(r) * index(cols);
      std::int32_t difference = 0;
      bool outside = false;
      for (int c = 0; c < cols; ++c) {
        // A row drifts by less than 1025 * 2^17 before `outside` stops it: no overflow.
        difference += unzigzag(residual[c]);
        above[index(c)] += difference;
        outside |= static_cast<std::uint32_t>(above[index(c)]) > top;
      }
      if (outside) return fail("value outside " + std::to_string(quantisation.bits) + " bits");
      float* to = xyz.data() + index(r) * index(cols) * 3 + axis;
      for (int c = 0; c < cols; ++c) {
        const auto q = static_cast<std::uint32_t>(above[index(c)]);
        to[index(c) * 3] = static_cast<float>(quantisation.decode(static_cast<int>(axis), q));
      }
    }
  }
  if (at != payload.size())
    return fail(std::to_string(payload.size() - at) + " bytes after the grid payload");
  return true;
}

}  // namespace weft::protocol
