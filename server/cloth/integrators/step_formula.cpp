#include "cloth/integrators/step_formula.h"

#include <utility>

#include "cloth/kernels/node_vector.h"
#include "cloth/sheet/motion.h"

namespace weft {

template <class Real>
StepFormula<Real>::StepFormula(const Grid& grid, bool second_order)
    : second_order_(second_order), goes_on_(grid), last_move_(grid), last_velocity_(grid) {}

template <class Real>
void StepFormula<Real>::begin_step(const Particles<Real>& particles, double h) {
  if (start_.grid() != grid()) {
    start_ = start_velocity_ = VectorField<Real>(grid());
    rate_ = NodeArrays<Real>(grid(), 1);
    vectors_ = NodeArrays<Real>(grid(), 6);
    step_ = {rate_[0], vectors_.vector(0), vectors_.vector(3)};
  }
  lead_.reset();
  if (!second_order_ && !is_held(particles)) lead_.emplace(grid());
  if (h_ != h) goes_on_.fill(Real(0));  // BDF2's formula is for equal steps
  h_ = h;
}

template <class Real>
void StepFormula<Real>::begin_substep(const Particles<Real>& particles) {
  const std::size_t count = grid().size();
  if (lead_) lead_->fill(static_cast<Real>(h_ / 2));
  copy<Real>(kernels::components(particles.position), kernels::components(start_), count);
  copy<Real>(kernels::components(particles.velocity), kernels::components(start_velocity_), count);
}

template <class Real>
void StepFormula<Real>::break_motion(std::size_t node) {
  begin_anew(node);
  if (lead_) lead_->row(0)[node] = Real(0);
}

template <class Real>
void StepFormula<Real>::break_all() {
  smooth_ = false;
  goes_on_.fill(Real(0));
}

template <class Real>
void StepFormula<Real>::prepare() {
  kernels::begin_backward_step<Real>(
      std::as_const(goes_on_).row(0), kernels::components(std::as_const(start_velocity_)),
      kernels::components(std::as_const(last_move_)), kernels::components(std::as_const(last_velocity_)),
      static_cast<Real>(h_), step_, grid().size());
}

template <class Real>
void StepFormula<Real>::return_to_start(Particles<Real>& particles) const {
  const std::size_t count = grid().size();
  copy<Real>(kernels::components(start_), kernels::components(particles.position), count);
  copy<Real>(kernels::components(start_velocity_), kernels::components(particles.velocity), count);
}

template <class Real>
void StepFormula<Real>::end_substep(Particles<Real>& particles) {
  const std::size_t count = grid().size();
  kernels::scaled_difference<Real>(kernels::components(particles.velocity),
                                   kernels::components(start_velocity_), static_cast<Real>(1 / h_),
                                   kernels::components(particles.acceleration), count);
  if (!second_order_) return;
  kernels::scaled_difference<Real>(kernels::components(particles.position), kernels::components(start_),
                                   Real(1), kernels::components(last_move_), count);
  last_velocity_ = start_velocity_;
  goes_on_.fill(smooth_ ? Real(1) : Real(0));
  smooth_ = true;
}

template <class Real>
void StepFormula<Real>::scale(const Particles<Real>& particles, double factor, const Freedom& freedom) {
  if (second_order_) scale_motion(particles, factor, last_velocity_, freedom);
}

template class StepFormula<float>;
template class StepFormula<double>;

}  // namespace weft
