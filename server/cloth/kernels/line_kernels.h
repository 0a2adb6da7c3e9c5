#pragma once
#include "cloth/kernels/link_kernels.h"

/// Solves along the threads of the linearised sheet: warp threads down the columns, weft threads along the
/// rows. L is what its matrix A is with no other couplings than those that stretch the threads of one
/// direction, m m^T of a link (SpringLinks); all links keep their share of the diagonal, so that A <= 2 L.
///
/// With G a node's block of D and all links at it, and m the link to the next node, a thread is factorised
/// from its first node on (the block Thomas algorithm; Golub and Van Loan, Matrix Computations, 2013, 4.5.1)
/// by the inverse pivots
///     E_0 = G_0^-1,   E_{p+1} = (G_{p+1} - (m_p . E_p m_p) m_p m_p^T)^-1.
/// At fixed nodes E = 0, and where a link is torn m = 0: there a thread falls apart by itself.
///
/// Warp threads are worked on side by side as they lie; so are weft threads, kWeftLines rows of them turned
/// over.
namespace weft::kernels {

/// Columns [begin, end) of a grid, both multiples of kRowAlign.
struct ColumnRange {
  int begin, end;
};

inline constexpr int kWeftLines = 16;

/// E and E m of the warp threads, by node.
template <class Real>
struct LineFactors {
  Blocks<Real> inverse;
  Components<Real> along;
};

/// Scalars of work space that each of these needs.
std::size_t line_work_size(const Grid& grid);
/// Scalars of the factors of one group of weft threads.
std::size_t weft_factors_size(const Grid& grid);

/// Writes G and the factors of the warp threads.
template <class Real>
void factorise_warp(const LinkMatrix<Real, SpringLinks<Real>>& matrix, const Blocks<Real>& nodes,
                    const LineFactors<Real>& factors, ColumnRange columns, Real* work);

/// What solve_warp reads and writes; x may be null.
template <class Real>
struct WarpSolve {
  Components<const Real> r;
  Components<Real> change, x;
};

/// change = damping L^-1 r on the warp threads, x += change.
template <class Real>
void solve_warp(const LinkMatrix<Real, SpringLinks<Real>>& matrix, const LineFactors<Real>& factors,
                Real damping, const WarpSolve<Real>& fields, ColumnRange columns, Real* work);

/// Writes the factors of the weft threads from row `first` on, of which G is given.
template <class Real>
void factorise_weft(const LinkMatrix<Real, SpringLinks<Real>>& matrix, const Blocks<Real>& nodes,
                    Real* factors, int first, Real* work);

/// What solve_weft reads and writes; z may be x.
template <class Real>
struct WeftSolve {
  Components<const Real> r, x, b;
  Components<Real> z;
};

/// z = x + damping L^-1 r on the weft threads from row `first` on; returns their part of b . z.
template <class Real>
double solve_weft(const Grid& grid, const Real* factors, Real damping, const WeftSolve<Real>& fields,
                  int first, Real* work);

}  // namespace weft::kernels
