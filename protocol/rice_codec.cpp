#include "protocol/rice_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <limits>

#include "protocol/bit_stream.h"
#include "protocol/quantised_rows.h"

namespace weft::protocol {
namespace {

constexpr int kRiceAxes = 3;
constexpr int kMaxParameter = 18;
constexpr int kEscape = 20;        ///< quotient of a value that is written whole
constexpr int kEscapedWidth = 19;  ///< residuals lie within +-262140, so zig-zagged below 2^19
constexpr std::uint32_t kResidualEnd = 1U << kEscapedWidth;
constexpr std::int32_t kMostDifference = 131070;  ///< of 16-bit values: 2 * 65535
constexpr std::size_t kFirstParts = kRiceAxes + 1 + 4;

std::size_t place(int i) { return static_cast<std::size_t>(i); }

/// Zig-zagged residuals of one axis, with what the rows so far tell of the next.
class ResidualPlane {
 public:
  ResidualPlane(int rows, int cols) : cols_(cols), z_(place(rows) * place(cols)) {}

  std::uint32_t* row(int r) { return z_.data() + place(r) * place(cols_); }

  /// Rice parameters of row r > 0: the 16 weights of the values above give 16 times their mean; the
  /// parameter is the exponent of the power of two at or below it.
  void parameters(int r, std::vector<int>& k) {
    const std::uint32_t *one = row(r - 1), *two = row(std::max(r - 2, 0)), *three = row(std::max(r - 3, 0));
    const auto parameter = [&](int c, int far_left, int left, int right, int far_right) {
      const std::uint32_t sum = one[far_left] + 2 * one[left] + 3 * one[c] + 2 * one[right] + one[far_right] +
                                two[left] + 2 * two[c] + two[right] + 3 * three[c];
      k[place(c)] = static_cast<int>(std::bit_width(sum / 16 | 1U)) - 1;
    };
    const int last = cols_ - 1;
    const auto at_border = [&](int c) {
      parameter(c, std::max(c - 2, 0), std::max(c - 1, 0), std::min(c + 1, last), std::min(c + 2, last));
    };
    for (int c = 0; c < std::min(2, cols_); ++c) at_border(c);
    for (int c = 2; c < last - 1; ++c) parameter(c, c - 2, c - 1, c + 1, c + 2);
    for (int c = std::max(last - 1, 2); c < cols_; ++c) at_border(c);
  }

 private:
  int cols_;
  std::vector<std::uint32_t> z_;
};

/// What is expected of the difference at (r, c), from those of the row above; nothing near the border.
std::int32_t expected(const std::vector<std::int32_t>& above, int r, int c, int cols) {
  if (r < 2 || c < 2 || c > cols - 2) return 0;
  return (6 * above[place(c - 1)] + 5 * above[place(c)] + 5 * above[place(c + 1)] + 8) >> 4;
}

/// Differences of one axis: of the mixed second order, along row 0 and column 0 of the second.
class Differences {
 public:
  Differences(const GridView& grid, std::size_t axis, const Quantisation& quantisation)
      : rows_(grid, axis, quantisation),
        above_(place(grid.cols), 0),
        here_(place(grid.cols)),
        before_(place(grid.cols), 0),
        now_(place(grid.cols)) {}

  /// Residuals of row r, of which the rows before are known.
  void residuals(int r, std::uint32_t* z) {
    const int cols = static_cast<int>(here_.size());
    rows_.read(r, here_.data());
    // Of the step down; in row 0 of the step to the right, which is above_'s with zeros.
    std::int32_t last = r == 0 ? 0 : down_;
    for (int c = 0; c < cols; ++c) {
      std::int32_t step = 0;
      if (r > 0) step = here_[place(c)] - above_[place(c)];
      if (r == 0 && c > 0) step = here_[place(c)] - here_[place(c - 1)];
      now_[place(c)] = r == 0 && c == 0 ? here_[0] : step - last;
      last = step;
      if (r > 0 && c == 0) down_ = step;
      z[c] = zigzag(now_[place(c)] - expected(before_, r, c, cols));
    }
    std::swap(above_, here_);
    std::swap(before_, now_);
  }

 private:
  QuantisedRows rows_;
  std::vector<std::int32_t> above_, here_;  // values
  std::vector<std::int32_t> before_, now_;  // their differences
  std::int32_t down_ = 0;                   // the last step down column 0
};

/// The way back: values of one axis from residuals.
class Sums {
 public:
  explicit Sums(int cols, int bits)
      : top_((1 << bits) - 1), values_(place(cols), 0), before_(place(cols), 0), now_(place(cols)) {}

  enum class Fault { none, difference, value };
  /// Row r; the values of those before are in the lattice.
  Fault add(int r, const std::uint32_t* z) {
    const int cols = static_cast<int>(values_.size());
    std::int32_t step = r == 0 ? 0 : down_;
    for (int c = 0; c < cols; ++c) {
      const std::int32_t difference = unzigzag(z[c]) + expected(before_, r, c, cols);
      if (std::abs(difference) > kMostDifference) return Fault::difference;
      now_[place(c)] = difference;
      std::int32_t& value = values_[place(c)];
      if (r == 0 && c == 0) {
        value = difference;
      } else {
        step += difference;  // between values in the lattice, or the row ends below
        value = step + (r == 0 ? values_[place(c - 1)] : value);
      }
      if (value < 0 || value > top_) return Fault::value;
      if (r > 0 && c == 0) down_ = step;
    }
    std::swap(before_, now_);
    return Fault::none;
  }
  const std::vector<std::int32_t>& values() const { return values_; }

 private:
  std::int32_t top_;
  std::vector<std::int32_t> values_, before_, now_;
  std::int32_t down_ = 0;
};

/// The best parameter for all of row 0.
int first_parameter(const std::uint32_t* z, int cols) {
  int best = 0;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (int k = 0; k <= kMaxParameter; ++k) {
    std::size_t bits = 0;
    for (int c = 0; c < cols; ++c)
      bits += z[c] >> k < kEscape ? (z[c] >> k) + place(1 + k) : place(kEscape + 1 + kEscapedWidth);
    if (bits < least) {
      least = bits;
      best = k;
    }
  }
  return best;
}

}  // namespace

void encode_rice_grid(const GridView& grid, const Quantisation& quantisation,
                      std::vector<std::uint8_t>& out) {
  std::vector<Differences> differences;
  std::vector<ResidualPlane> planes(kRiceAxes, ResidualPlane(grid.rows, grid.cols));
  for (std::size_t axis = 0; axis < kRiceAxes; ++axis) differences.emplace_back(grid, axis, quantisation);
  std::vector<int> k(place(grid.cols));
  const std::size_t values = kRiceAxes * place(grid.rows) * place(grid.cols);
  BitWriter quotients(values * (kEscape + 1)), remainders(values * kEscapedWidth);
  for (int r = 0; r < grid.rows; ++r) {
    for (std::size_t axis = 0; axis < kRiceAxes; ++axis) {
      const std::uint32_t* z = planes[axis].row(r);
      differences[axis].residuals(r, planes[axis].row(r));
      if (r > 0) {
        planes[axis].parameters(r, k);
      } else {
        std::fill(k.begin(), k.end(), first_parameter(z, grid.cols));
        out.push_back(static_cast<std::uint8_t>(k[0]));
      }
      for (int c = 0; c < grid.cols; ++c) {
        const std::uint32_t quotient = std::min<std::uint32_t>(z[c] >> k[place(c)], kEscape);
        quotients.zeros(quotient);
        quotients.value(1, 1);
        const int width = quotient == kEscape ? kEscapedWidth : k[place(c)];
        remainders.value(z[c] & ((1U << width) - 1), width);
      }
    }
  }
  const std::size_t length = quotients.bytes().size();
  out.push_back(0);
  for (unsigned shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(length >> shift));
  out.insert(out.end(), quotients.bytes().begin(), quotients.bytes().end());
  out.insert(out.end(), remainders.bytes().begin(), remainders.bytes().end());
}

bool decode_rice_grid(std::span<const std::uint8_t> payload, int rows, int cols,
                      const Quantisation& quantisation, std::vector<float>& xyz, std::string& error) {
  const auto fail = [&](std::string reason) {
    error = std::move(reason);
    return false;
  };
  if (rows < kMinSide || rows > kMaxSide || cols < kMinSide || cols > kMaxSide)
    return fail("grid of " + std::to_string(rows) + " rows and " + std::to_string(cols) + " columns");
  const std::size_t nodes = place(rows) * place(cols);
  // A value is at least the bit that ends its quotient: a payload buys so much memory and no more.
  if (payload.size() < kFirstParts + (kRiceAxes * nodes + 7) / 8) return fail("grid payload too short");
  for (int axis = 0; axis < kRiceAxes; ++axis)
    if (payload[place(axis)] > kMaxParameter)
      return fail("first parameter " + std::to_string(payload[place(axis)]));
  std::size_t length = 0;
  for (unsigned i = 0; i < 4; ++i) length |= static_cast<std::size_t>(payload[kRiceAxes + 1 + i]) << (8 * i);
  const auto parts = payload.subspan(kFirstParts);
  if (length > parts.size()) return fail("grid payload too short");
  BitReader quotients(parts.first(length)), remainders(parts.subspan(length));

  xyz.resize(kRiceAxes * nodes);
  std::vector<ResidualPlane> planes(kRiceAxes, ResidualPlane(rows, cols));
  std::vector<Sums> sums(kRiceAxes, Sums(cols, quantisation.bits));
  std::vector<int> k(place(cols));
  for (int r = 0; r < rows; ++r) {
    for (int axis = 0; axis < kRiceAxes; ++axis) {
      std::uint32_t* z = planes[place(axis)].row(r);
      if (r > 0) {
        planes[place(axis)].parameters(r, k);
      } else {
        std::fill(k.begin(), k.end(), payload[place(axis)]);
      }
      for (int c = 0; c < cols; ++c) {
        const std::uint32_t quotient = quotients.zeros(kEscape);
        if (quotient > kEscape) return fail("quotients that are not as many as values, or too large");
        const int width = quotient == kEscape ? kEscapedWidth : k[place(c)];
        if (!remainders.has(width)) return fail("grid payload too short");
        z[c] = remainders.value(width);
        if (quotient < kEscape) z[c] |= quotient << width;
        if (z[c] >= kResidualEnd) return fail("residual beyond 19 bits");
      }
      switch (sums[place(axis)].add(r, z)) {
        case Sums::Fault::difference:
          return fail("difference beyond 131070");
        case Sums::Fault::value:
          return fail("value outside " + std::to_string(quantisation.bits) + " bits");
        case Sums::Fault::none:
          break;
      }
      float* to = xyz.data() + place(r) * place(cols) * kRiceAxes + axis;
      for (int c = 0; c < cols; ++c) {
        const auto q = static_cast<std::uint32_t>(sums[place(axis)].values()[place(c)]);
        to[place(c) * kRiceAxes] = static_cast<float>(quantisation.decode(axis, q));
      }
    }
  }
  if (quotients.unread() != 0 || !quotients.rest_is_zero())
    return fail("quotients that are not as many as values, or too large");
  if (remainders.unread() != 0)
    return fail(std::to_string(remainders.unread()) + " bytes after the grid payload");
  return true;
}

}  // namespace weft::protocol
