#pragma once
#include "cloth/kernels/link_kernels.h"
#include "cloth/kernels/spring_kernels.h"

/// Passes over the nodes that an implicit step needs beside link_kernels.h.
namespace weft::kernels {

/// Linearises every spring that begins in the rows at the given positions: K = a I + (k - a) n n^T with a = k
/// max(0, 1 - l0/l), the part of its stiffness that is never negative (a compressed spring's sideways push is
/// left out), and k n n^T taken `axial` times, at least 1. `position` has its rows of zeros (link_kernels.h).
template <class Real>
void linearise_springs(const SpringLattice<Real>& springs, const Grid& grid, Components<const Real> position,
                       Real axial, const LinkFamilies<SpringLinks<Real>>& links, RowRange rows);

/// A step of h seconds by a backward differentiation formula, node by node: with d the node's move in the
/// step, its new velocity is rate (d - offset), and without forces it would move by `free_move`.
template <class Real>
struct BackwardStep {
  Real* rate;                  ///< 1/s
  Components<Real> offset;     ///< m
  Components<Real> free_move;  ///< m
};

/// Sets up a step from the last one's move and start velocity where second_order = 1 (BDF2: rate 3/(2h)), and
/// from the present state alone where it is 0 (backward Euler: rate 1/h, offset 0).
template <class Real>
void begin_backward_step(const Real* second_order, Components<const Real> velocity,
                         Components<const Real> last_move, Components<const Real> last_velocity, Real h,
                         const BackwardStep<Real>& step, std::size_t count);

/// What assemble_system reads of the present iterate.
template <class Real>
struct Iterate {
  Components<const Real> move;      ///< since the step's start, m
  Components<const Real> velocity;  ///< the forces were taken at, m/s
  Components<const Real> force;     ///< N
};

/// The linear system of a Newton iteration (Baraff and Witkin 1998, in moves instead of velocities), with C
/// the effects' damping matrix, in `diagonal` and `blocks` before:
///   D = m rate^2 + rate C,   b = m rate^2 (free_move - move) + force - C (rate (move - offset) - velocity).
/// At fixed nodes D = 1 and b = 0.
template <class Real>
void assemble_system(const Real* mass, const Real* free, const BackwardStep<Real>& step,
                     const Iterate<Real>& iterate, Real* diagonal, Components<Real> b, std::size_t count);
/// The same with a matrix in C.
template <class Real>
void assemble_system(const Real* mass, const Real* free, const BackwardStep<Real>& step,
                     const Iterate<Real>& iterate, Real* diagonal, const Blocks<Real>& blocks,
                     Components<Real> b, std::size_t count);

/// What move_nodes reads and writes.
template <class Real>
struct MovedNodes {
  const Real* free;
  Components<const Real> start, change;
  Components<Real> move, position, velocity;
};

/// move += change, position = start + move, velocity = rate (move - offset); fixed nodes keep their position,
/// with velocity 0.
template <class Real>
void move_nodes(const BackwardStep<Real>& step, const MovedNodes<Real>& nodes, std::size_t count);

/// out = factor (a - b).
template <class Real>
void scaled_difference(Components<const Real> a, Components<const Real> b, Real factor, Components<Real> out,
                       std::size_t count);

/// Sum of weight |v|^2 over the nodes.
template <class Real>
double weighted_square(const Real* weight, Components<const Real> v, const Grid& grid);

/// a . b over the nodes.
template <class Real>
double dot(Components<const Real> a, Components<const Real> b, const Grid& grid);

/// x *= scale, r = b - scale q: the residual of the scaled guess, q being the matrix times the guess.
template <class Real>
void scale_guess(Components<Real> x, Components<const Real> b, Components<const Real> q, Components<Real> r,
                 Real scale, std::size_t count);

/// x += step p, r -= step q: conjugate gradients' progress, on `count` scalars a component.
template <class Real>
void advance_along(Components<Real> x, Components<const Real> p, Components<Real> r, Components<const Real> q,
                   Real step, std::size_t count);

/// p = z + factor p.
template <class Real>
void turn_towards(Components<Real> p, Components<const Real> z, Real factor, std::size_t count);

/// out = block r at every node: block Jacobi from zero.
template <class Real>
void apply_blocks(const Blocks<Real>& blocks, Components<const Real> r, Components<Real> out,
                  std::size_t count);

}  // namespace weft::kernels
