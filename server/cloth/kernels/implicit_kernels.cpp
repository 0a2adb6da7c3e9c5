#include "cloth/kernels/implicit_kernels.h"

#include <cmath>

#include "cloth/kernels/linearise_rows.h"
#include "cloth/kernels/link_rows.h"

namespace weft::kernels {
namespace {

template <class Real>
[[gnu::always_inline]] inline void begin_component(const Real* second_order, const Real* v,
                                                   const Real* last_move, const Real* last_v,
                                                   const Real* rate, Real* offset, Real* free_move,
                                                   std::size_t count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (std::size_t i = 0; i < count; ++i) {
    const Real third = second_order[i] / 3;
    const Real from = third * last_move[i];
    offset[i] = from;
    free_move[i] = from + (v[i] + third * (v[i] - last_v[i])) / rate[i];
  }
}

template <class Real>
[[gnu::always_inline]] inline void begin_any(const Real* second_order, const Components<const Real>& v,
                                             const Components<const Real>& last_move,
                                             const Components<const Real>& last_v, Real h,
                                             const BackwardStep<Real>& step, std::size_t count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (std::size_t i = 0; i < count; ++i) step.rate[i] = (1 + second_order[i] / 2) / h;
  begin_component(second_order, v.x, last_move.x, last_v.x, step.rate, step.offset.x, step.free_move.x,
                  count);
  begin_component(second_order, v.y, last_move.y, last_v.y, step.rate, step.offset.y, step.free_move.y,
                  count);
  begin_component(second_order, v.z, last_move.z, last_v.z, step.rate, step.offset.z, step.free_move.z,
                  count);
}

template <class Real, bool kBlocks>
[[gnu::always_inline]] inline void assemble_any(const Real* mass, const Real* free,
                                                const BackwardStep<Real>& step, const Iterate<Real>& at,
                                                Real* diagonal, const Blocks<Real>& blocks,
                                                const Components<Real>& b, std::size_t count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (std::size_t i = 0; i < count; ++i) {
    const Real is_free = free[i], rate = step.rate[i];
    const Real inertia = mass[i] * rate * rate, damping = diagonal[i];
    const Real dvx = rate * (at.move.x[i] - step.offset.x[i]) - at.velocity.x[i];
    const Real dvy = rate * (at.move.y[i] - step.offset.y[i]) - at.velocity.y[i];
    const Real dvz = rate * (at.move.z[i] - step.offset.z[i]) - at.velocity.z[i];
    Triple<Real> rest{damping * dvx, damping * dvy, damping * dvz};
    if constexpr (kBlocks) {
      const Triple<Real> more = force_of(blocks, static_cast<std::ptrdiff_t>(i), dvx, dvy, dvz);
      rest = {rest.x + more.x, rest.y + more.y, rest.z + more.z};
      blocks.xx[i] *= rate;
      blocks.xy[i] *= rate;
      blocks.xz[i] *= rate;
      blocks.yy[i] *= rate;
      blocks.yz[i] *= rate;
      blocks.zz[i] *= rate;
    }
    b.x[i] = is_free * (inertia * (step.free_move.x[i] - at.move.x[i]) + at.force.x[i] - rest.x);
    b.y[i] = is_free * (inertia * (step.free_move.y[i] - at.move.y[i]) + at.force.y[i] - rest.y);
    b.z[i] = is_free * (inertia * (step.free_move.z[i] - at.move.z[i]) + at.force.z[i] - rest.z);
    diagonal[i] = inertia + rate * damping;
  }
}

template <class Real>
[[gnu::always_inline]] inline void move_component(const Real* free, const Real* rate, const Real* offset,
                                                  const Real* start, const Real* change, Real* move,
                                                  Real* position, Real* velocity, std::size_t count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (std::size_t i = 0; i < count; ++i) {
    const Real moved = free[i] * (move[i] + change[i]);
    move[i] = moved;
    position[i] = start[i] + moved;
    velocity[i] = free[i] * (rate[i] * (moved - offset[i]));
  }
}

template <class Real>
[[gnu::always_inline]] inline void move_any(const BackwardStep<Real>& step, const MovedNodes<Real>& n,
                                            std::size_t count) {
  move_component(n.free, step.rate, step.offset.x, n.start.x, n.change.x, n.move.x, n.position.x,
                 n.velocity.x, count);
  move_component(n.free, step.rate, step.offset.y, n.start.y, n.change.y, n.move.y, n.position.y,
                 n.velocity.y, count);
  move_component(n.free, step.rate, step.offset.z, n.start.z, n.change.z, n.move.z, n.position.z,
                 n.velocity.z, count);
}

template <class Real>
[[gnu::always_inline]] inline void difference_any(const Real* a, const Real* b, Real factor, Real* out,
                                                  std::size_t count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (std::size_t i = 0; i < count; ++i) out[i] = factor * (a[i] - b[i]);
}

template <class Real>
[[gnu::always_inline]] inline double dot_any(const Components<const Real>& a, const Components<const Real>& b,
                                             const Grid& grid) {
  double sum = 0;
  for (int r = 0; r < grid.rows; ++r) {
    DotProduct<Real> dot;
    dot.add_row(a, b, static_cast<std::ptrdiff_t>(grid.index(r, 0)), grouped(grid.cols));
    sum += dot.sum();
  }
  return sum;
}

template <class Real>
[[gnu::always_inline]] inline double weighted_any(const Real* weight, const Components<const Real>& v,
                                                  const Grid& grid) {
  double sum = 0;
  for (int r = 0; r < grid.rows; ++r) {
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(grid.index(r, 0));
    alignas(64) Real lanes[kLinkGroup]{};
    for (int c = 0; c < grouped(grid.cols); c += kLinkGroup) {
      for (int lane = 0; lane < kLinkGroup; ++lane) {
        const std::ptrdiff_t i = first + c + lane;
        lanes[lane] += weight[i] * (v.x[i] * v.x[i] + v.y[i] * v.y[i] + v.z[i] * v.z[i]);
      }
    }
    for (const Real lane : lanes) sum += static_cast<double>(lane);
  }
  return sum;
}

template <class Real>
[[gnu::always_inline]] inline void scale_component(Real* x, const Real* b, const Real* q, Real* r, Real scale,
                                                   std::size_t count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (std::size_t i = 0; i < count; ++i) {
    x[i] *= scale;
    r[i] = b[i] - scale * q[i];
  }
}

template <class Real>
[[gnu::always_inline]] inline void advance_any(Real* __restrict x, const Real* __restrict p,
                                               Real* __restrict r, const Real* __restrict q, Real step,
                                               std::size_t count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (std::size_t i = 0; i < count; ++i) {
    x[i] += step * p[i];
    r[i] -= step * q[i];
  }
}

template <class Real>
[[gnu::always_inline]] inline void turn_any(Real* __restrict p, const Real* __restrict z, Real factor,
                                            std::size_t count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (std::size_t i = 0; i < count; ++i) p[i] = z[i] + factor * p[i];
}

template <class Real>
[[gnu::always_inline]] inline void apply_any(const Blocks<Real>& blocks, const Components<const Real>& r,
                                             const Components<Real>& out, std::size_t count) {
  WEFT_INDEPENDENT_ITERATIONS
  for (std::size_t i = 0; i < count; ++i) {
    const Triple<Real> product = force_of(blocks, static_cast<std::ptrdiff_t>(i), r.x[i], r.y[i], r.z[i]);
    out.x[i] = product.x;
    out.y[i] = product.y;
    out.z[i] = product.z;
  }
}

}  // namespace

// target_clones needs each function written out. NOLINTBEGIN(bugprone-macro-parentheses): they are types
#define WEFT_IMPLICIT_KERNELS(Real)                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION void linearise_springs(const SpringLattice<Real>& springs, const Grid& grid,             \
                                           Components<const Real> position, Real axial,                      \
                                           const LinkFamilies<SpringLinks<Real>>& links, RowRange rows) {    \
    linearise_rows::linearise<Real, false, false>(springs, grid, position, axial, links, rows);              \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION void begin_backward_step(                                                                \
      const Real* second_order, Components<const Real> velocity, Components<const Real> last_move,           \
      Components<const Real> last_velocity, Real h, const BackwardStep<Real>& step, std::size_t count) {     \
    begin_any<Real>(second_order, velocity, last_move, last_velocity, h, step, count);                       \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION void assemble_system(const Real* mass, const Real* free, const BackwardStep<Real>& step, \
                                         const Iterate<Real>& iterate, Real* diagonal, Components<Real> b,   \
                                         std::size_t count) {                                                \
    assemble_any<Real, false>(mass, free, step, iterate, diagonal, {}, b, count);                            \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION void assemble_system(                                                                    \
      const Real* mass, const Real* free, const BackwardStep<Real>& step, const Iterate<Real>& iterate,      \
      Real* diagonal, const Blocks<Real>& blocks, Components<Real> b, std::size_t count) {                   \
    assemble_any<Real, true>(mass, free, step, iterate, diagonal, blocks, b, count);                         \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION void move_nodes(const BackwardStep<Real>& step, const MovedNodes<Real>& nodes,           \
                                    std::size_t count) {                                                     \
    move_any<Real>(step, nodes, count);                                                                      \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION void scaled_difference(Components<const Real> a, Components<const Real> b, Real factor,  \
                                           Components<Real> out, std::size_t count) {                        \
    difference_any(a.x, b.x, factor, out.x, count);                                                          \
    difference_any(a.y, b.y, factor, out.y, count);                                                          \
    difference_any(a.z, b.z, factor, out.z, count);                                                          \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION double weighted_square(const Real* weight, Components<const Real> v, const Grid& grid) { \
    return weighted_any<Real>(weight, v, grid);                                                              \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION double dot(Components<const Real> a, Components<const Real> b, const Grid& grid) {       \
    return dot_any<Real>(a, b, grid);                                                                        \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION void scale_guess(Components<Real> x, Components<const Real> b, Components<const Real> q, \
                                     Components<Real> r, Real scale, std::size_t count) {                    \
    scale_component(x.x, b.x, q.x, r.x, scale, count);                                                       \
    scale_component(x.y, b.y, q.y, r.y, scale, count);                                                       \
    scale_component(x.z, b.z, q.z, r.z, scale, count);                                                       \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION void advance_along(Components<Real> x, Components<const Real> p, Components<Real> r,     \
                                       Components<const Real> q, Real step, std::size_t count) {             \
    advance_any(x.x, p.x, r.x, q.x, step, count);                                                            \
    advance_any(x.y, p.y, r.y, q.y, step, count);                                                            \
    advance_any(x.z, p.z, r.z, q.z, step, count);                                                            \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION void turn_towards(Components<Real> p, Components<const Real> z, Real factor,             \
                                      std::size_t count) {                                                   \
    turn_any(p.x, z.x, factor, count);                                                                       \
    turn_any(p.y, z.y, factor, count);                                                                       \
    turn_any(p.z, z.z, factor, count);                                                                       \
  }                                                                                                          \
  template <>                                                                                                \
  WEFT_MULTIVERSION void apply_blocks(const Blocks<Real>& blocks, Components<const Real> r,                  \
                                      Components<Real> out, std::size_t count) {                             \
    apply_any<Real>(blocks, r, out, count);                                                                  \
  }

WEFT_IMPLICIT_KERNELS(float)
WEFT_IMPLICIT_KERNELS(double)
#undef WEFT_IMPLICIT_KERNELS
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace weft::kernels
