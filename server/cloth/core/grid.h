#pragma once
#include <cstddef>
#include <memory>
#include <new>
#include <vector>

namespace weft {

/// Scalars a row is padded to: 16 floats fill one cache line and two AVX2 registers.
inline constexpr int kRowAlign = 16;
/// Padding that every row has at least: a row loop may read the second neighbour of the row's last node.
inline constexpr int kRowPadding = 2;

/// Lowest and highest level a cloth may have: 8 x 8 to 256 x 256 cells on a square cloth.
inline constexpr int kMinLevel = 3;
inline constexpr int kMaxLevel = 8;

/// The nodes of one level: rows x cols, stored row by row, each row padded to `stride` scalars so that
/// every row starts aligned and a neighbour is a fixed offset. Row 0 is the top edge (v = 0), column 0
/// the left edge (u = 0).
struct Grid {
  int rows = 0;    ///< nodes along v
  int cols = 0;    ///< nodes along u
  int stride = 0;  ///< scalars from one row to the next, a multiple of kRowAlign

  static Grid with_nodes(int rows, int cols);

  int nodes() const { return rows * cols; }
  int cells() const { return (rows - 1) * (cols - 1); }
  std::size_t size() const { return static_cast<std::size_t>(rows) * static_cast<std::size_t>(stride); }
  std::size_t index(int row, int col) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(col);
  }
  bool operator==(const Grid&) const = default;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(rows, cols, stride);
  }
};

/// Cell counts of a cloth at level 0; level L has base * 2^L cells on each side. {1, 1} is the paper's
/// square cloth (level 6 = 64 x 64 cells); {2, 1} a cloth twice as wide as high in cells.
struct BaseCells {
  int cols = 1;  ///< along u
  int rows = 1;  ///< along v

  /// The nodes at `level` (kMinLevel..kMaxLevel); every second node is also a node of level - 1.
  Grid at(int level) const;
  bool operator==(const BaseCells&) const = default;
};

/// Storage aligned to a cache line.
template <class T>
struct AlignedAllocator {
  using value_type = T;
  static constexpr std::align_val_t kAlignment{64};
  AlignedAllocator() = default;
  template <class U>
  AlignedAllocator(const AlignedAllocator<U>&) {}  // NOLINT(google-explicit-constructor): rebinding
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kAlignment)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, kAlignment); }
  bool operator==(const AlignedAllocator&) const { return true; }
};

/// One scalar per node of a grid. Padding is zero when made and is never read as a node.
template <class Real>
class Field {
 public:
  Field() = default;
  explicit Field(const Grid& grid) : grid_(grid), values_(grid.size(), Real(0)) {}

  const Grid& grid() const { return grid_; }
  Real* row(int r) { return values_.data() + grid_.index(r, 0); }
  const Real* row(int r) const { return values_.data() + grid_.index(r, 0); }
  Real& at(int r, int c) { return values_[grid_.index(r, c)]; }
  Real at(int r, int c) const { return values_[grid_.index(r, c)]; }
  void fill(Real value) { values_.assign(values_.size(), value); }
  /// The whole storage, padding included: for elementwise loops over rows * stride scalars.
  std::vector<Real, AlignedAllocator<Real>>& values() { return values_; }
  const std::vector<Real, AlignedAllocator<Real>>& values() const { return values_; }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(grid_, values_);
  }

 private:
  Grid grid_;
  std::vector<Real, AlignedAllocator<Real>> values_;
};

/// One vector per node, one array per component.
template <class Real>
struct VectorField {
  Field<Real> x, y, z;

  VectorField() = default;
  explicit VectorField(const Grid& grid) : x(grid), y(grid), z(grid) {}
  const Grid& grid() const { return x.grid(); }
  void fill(Real value) {
    x.fill(value);
    y.fill(value);
    z.fill(value);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(x, y, z);
  }
};

}  // namespace weft
