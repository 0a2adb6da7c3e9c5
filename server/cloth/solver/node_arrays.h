#pragma once
#include "cloth/kernels/link_kernels.h"

namespace weft {

/// Several scalars per node, one array each, as link_kernels.h wants them: rows of zeros before and after the
/// grid's own.
template <class Real>
class NodeArrays {
 public:
  NodeArrays() = default;
  NodeArrays(const Grid& grid, int arrays)
      : margin_(static_cast<std::size_t>(kernels::kMarginRows * grid.stride)),
        size_(grid.size() + 2 * margin_),
        values_(static_cast<std::size_t>(arrays) * size_, Real(0)) {}

  Real* operator[](int array) { return values_.data() + static_cast<std::size_t>(array) * size_ + margin_; }
  kernels::Components<Real> vector(int first = 0) {
    return {(*this)[first], (*this)[first + 1], (*this)[first + 2]};
  }
  kernels::Blocks<Real> blocks(int first = 0) {
    return {(*this)[first],     (*this)[first + 1], (*this)[first + 2],
            (*this)[first + 3], (*this)[first + 4], (*this)[first + 5]};
  }
  void clear() { values_.assign(values_.size(), Real(0)); }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(margin_, size_, values_);
  }

 private:
  std::size_t margin_ = 0, size_ = 0;
  std::vector<Real, AlignedAllocator<Real>> values_;
};

}  // namespace weft
