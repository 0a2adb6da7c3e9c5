#include "cloth/integrators/motion_scale.h"

#include <algorithm>
#include <limits>

#include "cloth/kernels/implicit_kernels.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/motion.h"

namespace weft {
namespace {

/// Sizes of the cloth a second. Of a slower motion the error allowed grows no smaller: with the default
/// tolerance it is then 0.02 mm/s on 2 m. A looser one keeps free corners swinging at what puts to sleep.
constexpr double kSlow = 5e-4;
/// The same where rounding is what is left of such an error: where the stiffest mode's squared frequency
/// times h^2 has no digit less than the scalar.
constexpr double kSlowStiff = 5e-3;
/// Sizes of the cloth a second. A slower cloth is near rest.
constexpr double kNearRest = 5e-3;
/// The most that a solve may leave of the speed that gravity gives in a substep, which a cloth that hangs or
/// swings does not have.
constexpr double kOfGravity = 0.02;
/// Share of what gravity gives: free fall finds half of that, springs and solids that hold a sheet at rest a
/// thousandth.
constexpr double kFalls = 0.1;

/// The cloth's longer side, m.
double extent(const std::vector<SpringFamily>& springs, const Grid& grid) {
  double longest = 0;
  for (const SpringFamily& family : springs) {
    if (family.rows == 0) longest = std::max(longest, family.rest_length / family.cols * (grid.cols - 1));
    if (family.cols == 0) longest = std::max(longest, family.rest_length / family.rows * (grid.rows - 1));
  }
  return longest;
}

/// Twice the energy of the mean velocity, J. 0 where a node is pinned.
template <class Real>
double common_energy(const Particles<Real>& particles) {
  if (is_held(particles)) return 0;
  return linear_momentum(particles).squaredNorm() / total_mass(particles);
}

}  // namespace

template <class Real>
MotionScale<Real>::MotionScale(const Springs<Real>& springs, const Field<Real>& mass, double h) : h_(h) {
  const double stiffest = springs.max_squared_frequency(mass) * h * h;
  const double size = extent(springs.families(), mass.grid());
  const bool digits = stiffest * double(std::numeric_limits<Real>::epsilon()) <= 1;
  slow_ = (digits ? kSlow : kSlowStiff) * size;
  near_rest_ = kNearRest * size;
}

template <class Real>
void MotionScale<Real>::measure(const Particles<Real>& particles) {
  mass_ = total_mass(particles);
  falls_ = false;
  kinetic_ = kernels::weighted_square<Real>(particles.mass.row(0), kernels::components(particles.velocity),
                                            particles.grid());
  inner_ = std::max(0.0, kinetic_ - common_energy(particles));
}

template <class Real>
double MotionScale<Real>::given() const {
  const double speed = standard_gravity().norm() * h_;
  return mass_ * speed * speed;
}

template <class Real>
void MotionScale<Real>::found(double decrease) {
  falls_ = falls_ || decrease > kFalls * given();
}

template <class Real>
double MotionScale<Real>::still() const {
  return fine() ? mass_ * slow_ * slow_ : given();
}

template <class Real>
double MotionScale<Real>::energy() const {
  return inner_ + still();
}

template <class Real>
SolveTarget MotionScale<Real>::target(double tolerance, bool contact) const {
  const double share = tolerance * tolerance;
  const double of_gravity = std::min(share, kOfGravity * kOfGravity);
  const double least = share * inner_ + of_gravity * mass_ * slow_ * slow_;
  // Of what there is to find in contact most is how far the weight presses the springs that hold the nodes to
  // the solids: a share of that would shake a drape near rest for ever.
  return {least, near_rest() && contact ? 0 : share, std::max(least, share * inner_ + of_gravity * still())};
}

template class MotionScale<float>;
template class MotionScale<double>;

}  // namespace weft
