#pragma once
/// Codec 1 of PROTOCOL.md section 4: a grid of positions quantised, predicted from its neighbours,
/// bit-packed.
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace weft::protocol {

inline constexpr int kMinSide = 2, kMaxSide = 1025;  ///< nodes along a side

/// Positions to encode, seen in place: component c of node (r, k) is at data[c][r * row_step + k * col_step].
/// A viewer's coarser level is the same storage with both steps doubled (levels are nested). Positions are
/// those plus `place`, in double.
struct GridView {
  std::array<const float*, 3> data{};  ///< x, y, z; m, finite, below 1e30
  int rows = 0, cols = 0;              ///< kMinSide..kMaxSide each
  std::ptrdiff_t row_step = 0, col_step = 1;
  std::array<double, 3> place{};  ///< m, below 1e30
};

/// p = origin + q * quantum.
struct Quantisation {
  int bits = 16;                  ///< 8..16
  std::array<float, 3> origin{};  ///< m, an exact multiple of quantum, though far away a float has no others
  float quantum = 1.0F;           ///< m, a power of two
  double decode(int axis, std::uint32_t q) const {
    return double(origin[static_cast<std::size_t>(axis)]) + double(q) * double(quantum);
  }
};

inline constexpr int kMinQuantumExponent = -24;  ///< 60 nm: finer says nothing about a cloth

/// The box that just holds the grid: its least and greatest coordinates, m.
struct GridBox {
  std::array<double, 3> low{}, high{};
};
GridBox box_of(const GridView& grid);

/// The finest lattice of `bits` that covers the grid and whose quantum is at least 2^`min_exponent` m. Where
/// two frames get the same quantum, a node that stands still decodes to the same position in both, whatever
/// the rest of the cloth does.
Quantisation choose_quantisation(const GridView& grid, int bits, int min_exponent = kMinQuantumExponent);

/// Appends the payload of codec 1 to `out`.
void encode_grid(const GridView& grid, const Quantisation& quantisation, std::vector<std::uint8_t>& out);

/// Decodes a payload into rows * cols * 3 floats (x, y, z interleaved, row by row). False, with a reason in
/// `error`, on a malformed payload; never reads outside it, never allocates more than rows * cols asks for.
bool decode_grid(std::span<const std::uint8_t> payload, int rows, int cols, const Quantisation& quantisation,
                 std::vector<float>& xyz, std::string& error);

}  // namespace weft::protocol
