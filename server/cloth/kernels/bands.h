#pragma once
#include <algorithm>
#include <array>
#include <numeric>

#include "cloth/core/parallel.h"
#include "cloth/kernels/link_kernels.h"

namespace weft {

/// The rows of a grid in bands that are worked on at the same time. Where they lie follows from the grid
/// alone, and a sum is added up band by band, so the bits are the same on any number of threads. A grid too
/// small for help to pay is one band, which the caller does itself.
class Bands {
 public:
  explicit Bands(const Grid& grid)
      : rows_(grid.rows),
        stride_(static_cast<std::size_t>(grid.stride)),
        count_(grid.nodes() < kNodesWorthHelp ? 1 : std::clamp(grid.rows / kRows, 1, kMost)) {}

  int count() const { return count_; }

  /// Calls work(rows, band) for every band.
  template <class Work>
  void for_each(const Work& work) const {
    parallel_for(count_, [&](int band) { work(rows(band), band); });
  }
  /// Calls work(first, count) for the bands' scalars in the grid's arrays.
  template <class Work>
  void for_each_stretch(const Work& work) const {
    for_each([&](kernels::RowRange rows, int) {
      work(static_cast<std::size_t>(rows.begin) * stride_,
           static_cast<std::size_t>(rows.end - rows.begin) * stride_);
    });
  }
  /// The sum of all work(rows, band).
  template <class Work>
  double sum(const Work& work) const {
    std::array<double, kMost> parts{};
    for_each(
        [&](kernels::RowRange rows, int band) { parts[static_cast<std::size_t>(band)] = work(rows, band); });
    return std::accumulate(parts.begin(), parts.begin() + count_, 0.0);
  }

 private:
  /// Two threads do 257 x 257 nodes 1.6 times faster, 129 x 129 only 1.1 times (tests/bench/run --threads).
  static constexpr int kNodesWorthHelp = 129 * 129;
  /// A pass over links looks at up to two rows before its own as well; a band is many times that.
  static constexpr int kRows = 32;
  static constexpr int kMost = 64;

  kernels::RowRange rows(int band) const { return {band * rows_ / count_, (band + 1) * rows_ / count_}; }

  int rows_;
  std::size_t stride_;
  int count_;
};

}  // namespace weft
