#include "cloth/solver/coarse_solver.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cassert>
#include <utility>

namespace weft {

template <class Real>
struct CoarseSolver<Real>::Impl {
  Grid grid;
  std::vector<Eigen::Triplet<double>> entries;  ///< of the lower triangle, which alone is read
  std::vector<std::ptrdiff_t> slots;            ///< by entry: its place among the matrix's numbers
  Eigen::SparseMatrix<double> matrix;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors;
  Eigen::VectorXd right_hand_side, solution;
  std::vector<char> free;
  std::vector<int> unknowns;  ///< by node: the row of its first component; two that are sewn share it
  std::vector<int> unused;    ///< of the right nodes of pairs

  Impl(const Grid& of, const Seam<Real>* seam) : grid(of), unknowns(of.size()) {
    for (int r = 0; r < grid.rows; ++r) {
      for (int c = 0; c < grid.cols; ++c) unknowns[grid.index(r, c)] = 3 * (r * grid.cols + c);
    }
    if (seam == nullptr) return;
    for (const auto& [left, right] : seam->pairs()) {
      unused.push_back(std::exchange(unknowns[right], unknowns[left]));
    }
  }

  int unknown(int r, int c) const { return unknowns[grid.index(r, c)]; }

  void add(int row, int col, const Eigen::Matrix3d& block) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        if (row + i >= col + j) entries.emplace_back(row + i, col + j, block(i, j));
      }
    }
  }

  /// The entries' sums. Which there are never changes: their places are found once.
  void assemble() {
    if (slots.empty()) {
      matrix.setFromTriplets(entries.begin(), entries.end());
      for (const auto& entry : entries) {
        slots.push_back(&matrix.coeffRef(entry.row(), entry.col()) - matrix.valuePtr());
      }
      factors.analyzePattern(matrix);
    }
    assert(slots.size() == entries.size());
    matrix.coeffs().setZero();
    for (std::size_t i = 0; i < entries.size(); ++i) matrix.valuePtr()[slots[i]] += entries[i].value();
  }

  /// A link between the node at (r, c) and the one `rows` below and `cols` to the right. Fixed ends keep
  /// their place in the pattern.
  void add_link(const kernels::Blocks<Real>& links, const Matrix& m, int r, int c, int rows, int cols) {
    if (r + rows >= grid.rows || c + cols >= grid.cols || c + cols < 0) return;
    const Eigen::Matrix3d block = block_at(links, grid.index(r, c));
    const double free_1 = m.free[grid.index(r, c)] > Real(0) ? 1 : 0;
    const double free_2 = m.free[grid.index(r + rows, c + cols)] > Real(0) ? 1 : 0;
    const int one = unknown(r, c), two = unknown(r + rows, c + cols);
    const Eigen::Matrix3d coupling = -free_1 * free_2 * block;
    add(one, one, free_1 * block);
    add(two, two, free_2 * block);
    add(std::max(one, two), std::min(one, two), coupling);
  }

  /// The plate's stencils; fixed nodes keep their place as above.
  void add_plate(const Plate<Real>& plate, const Matrix& m) {
    plate.for_each_stencil([&](double stiffness, const auto& nodes) {
      for (const auto& one : nodes) {
        for (const auto& two : nodes) {
          const bool both = m.free[grid.index(one.row, one.col)] > Real(0) &&
                            m.free[grid.index(two.row, two.col)] > Real(0);
          const double number = both ? stiffness * one.weight * two.weight : 0.0;
          const int row = unknown(one.row, one.col), col = unknown(two.row, two.col);
          if (row < col) continue;
          for (int i = 0; i < 3; ++i) entries.emplace_back(row + i, col + i, number);
        }
      }
    });
  }

  static Eigen::Matrix3d block_at(const kernels::Blocks<Real>& b, std::size_t i) {
    const auto xy = double(b.xy[i]), xz = double(b.xz[i]), yz = double(b.yz[i]);
    return Eigen::Matrix3d{{double(b.xx[i]), xy, xz}, {xy, double(b.yy[i]), yz}, {xz, yz, double(b.zz[i])}};
  }
};

template <class Real>
CoarseSolver<Real>::CoarseSolver(const Grid& grid, const Seam<Real>* seam)
    : impl_(std::make_unique<Impl>(grid, seam)) {
  impl_->matrix.resize(3 * grid.nodes(), 3 * grid.nodes());
  impl_->right_hand_side.setZero(3 * grid.nodes());
}
template <class Real>
CoarseSolver<Real>::~CoarseSolver() = default;
template <class Real>
CoarseSolver<Real>::CoarseSolver(CoarseSolver&&) noexcept = default;
template <class Real>
CoarseSolver<Real>& CoarseSolver<Real>::operator=(CoarseSolver&&) noexcept = default;

template <class Real>
void CoarseSolver<Real>::factorise(const Matrix& m, const Plate<Real>* plate) {
  Impl& s = *impl_;
  s.entries.clear();
  for (int r = 0; r < s.grid.rows; ++r) {
    for (int c = 0; c < s.grid.cols; ++c) {
      const std::size_t i = s.grid.index(r, c);
      const bool is_free = m.free[i] > Real(0);
      Eigen::Matrix3d diagonal = Eigen::Matrix3d::Identity() * (is_free ? double(m.diagonal[i]) : 1.0);
      if (is_free && m.has_blocks) diagonal += Impl::block_at(m.blocks, i);
      s.add(s.unknown(r, c), s.unknown(r, c), diagonal);
      s.add_link(m.links.along_u, m, r, c, 0, 1);
      s.add_link(m.links.along_v, m, r, c, 1, 0);
      s.add_link(m.links.falling, m, r, c, 1, 1);
      s.add_link(m.links.rising, m, r, c, 1, -1);
    }
  }
  for (const int row : s.unused) s.add(row, row, Eigen::Matrix3d::Identity());
  if (plate != nullptr) s.add_plate(*plate, m);
  s.assemble();
  s.factors.factorize(s.matrix);
  s.free.assign(s.grid.size(), 0);
  for (std::size_t i = 0; i < s.free.size(); ++i) s.free[i] = m.free[i] > Real(0);
}

template <class Real>
void CoarseSolver<Real>::solve(kernels::Components<const Real> b, kernels::Components<Real> x) {
  Impl& s = *impl_;
  const auto for_each_node = [&](auto visit) {
    for (int r = 0; r < s.grid.rows; ++r) {
      for (int c = 0; c < s.grid.cols; ++c) visit(s.unknown(r, c), s.grid.index(r, c));
    }
  };
  s.right_hand_side.setZero();
  for_each_node([&](int row, std::size_t i) {
    const double free = s.free[i];
    s.right_hand_side[row] += free * double(b.x[i]);
    s.right_hand_side[row + 1] += free * double(b.y[i]);
    s.right_hand_side[row + 2] += free * double(b.z[i]);
  });
  s.solution = s.factors.solve(s.right_hand_side);
  for_each_node([&](int row, std::size_t i) {
    x.x[i] = static_cast<Real>(s.solution[row]);
    x.y[i] = static_cast<Real>(s.solution[row + 1]);
    x.z[i] = static_cast<Real>(s.solution[row + 2]);
  });
}

template class CoarseSolver<float>;
template class CoarseSolver<double>;

}  // namespace weft
