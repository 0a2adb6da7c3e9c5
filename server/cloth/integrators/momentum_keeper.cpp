#include "cloth/integrators/momentum_keeper.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

#include "cloth/integrators/body_energy.h"
#include "cloth/kernels/node_vector.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/motion.h"

namespace weft {
namespace {

/// Calls visit(index, row, column) for every node.
template <class Visit>
void for_each_node(const Grid& grid, Visit visit) {
  for (int r = 0; r < grid.rows; ++r) {
    for (int c = 0; c < grid.cols; ++c) visit(grid.index(r, c), r, c);
  }
}

/// Of a body that moves like this, about a point in the world, seen from `place`.
Vec3 angular_momentum(const Solid& solid, const Vec3& velocity, const Vec3& spin, const Vec3& place,
                      const Vec3& point) {
  Vec3 sum = (place + solid.position - point).cross(velocity / solid.inverse_mass);
  if (solid.yields_turning()) sum += solid.inverse_inertia.inverse() * spin;
  return sum;
}

/// The largest share of a change, up to 1, that adds no more than `most` to an energy which it changes by
/// linear * share + square * share^2.
double share_within(double most, double linear, double square) {
  if (linear + square <= most) return 1;
  return (std::sqrt(linear * linear + 4 * square * std::max(0.0, most)) - linear) / (2 * square);
}

}  // namespace

template <class Real>
auto MomentumKeeper<Real>::motion_of(const Particles<Real>& particles) -> Motion {
  Motion motion;
  motion.known = true;
  motion.mass = total_mass(particles);
  motion.momentum = linear_momentum(particles);
  const Grid& grid = particles.grid();
  for_each_node(grid, [&](std::size_t, int r, int c) {
    motion.centre += double(particles.mass.at(r, c)) * particles.local_position_at(r, c);
  });
  motion.centre /= motion.mass;
  const Vec3 mean = motion.momentum / motion.mass;
  for_each_node(grid, [&](std::size_t, int r, int c) {
    const auto m = double(particles.mass.at(r, c));
    const Vec3 velocity = particles.velocity_at(r, c) - mean;
    motion.spin += m * (particles.local_position_at(r, c) - motion.centre).cross(velocity);
    motion.kinetic += m * velocity.squaredNorm() / 2;
  });
  motion.centre += particles.place;
  return motion;
}

template <class Real>
bool MomentumKeeper<Real>::applies(const Particles<Real>& particles, const Forces<Real>& forces) {
  return forces.layers == nullptr && !forces.holds_gas() && forces.sheet->torn() == nullptr &&
         !is_held(particles);
}

template <class Real>
void MomentumKeeper<Real>::begin_substep(const Particles<Real>& particles, const Forces<Real>& forces,
                                         const std::vector<Solid>& solids, bool hung) {
  hung_ = hung;
  before_ = forces.disturbed ? Motion{} : now_;
  now_ = applies(particles, forces) ? motion_of(particles) : Motion{};
  if (now_.known) solids_ = solids;
}

template <class Real>
bool MomentumKeeper<Real>::touched_by_body(const std::vector<Solid>& solids, const Contact<Real>* contact) {
  if (contact == nullptr) return false;
  return std::any_of(contact->touches().begin(), contact->touches().end(),
                     [&](const Touch& touch) { return solid_of(touch, solids).yields(); });
}

template <class Real>
auto MomentumKeeper<Real>::input(const Particles<Real>& particles, const Forces<Real>& forces,
                                 const std::vector<Solid>& solids, const VectorField<Real>& start) -> Input {
  const Grid& grid = particles.grid();
  if (force_.grid() != grid) force_ = VectorField<Real>(grid);
  forces.sum_effects(particles, force_, hung_ ? forces.soft_pins : nullptr);
  Input input;
  Vec3 moved(0, 0, 0);
  const auto each_force = kernels::components(std::as_const(force_));
  const auto from = kernels::components(start), to = kernels::components(particles.position);
  for_each_node(grid, [&](std::size_t i, int r, int c) {
    const Vec3 f = at(each_force, i), way = at<Real>(to, i) - at(from, i);
    input.force += f;
    input.torque += (particles.position_at(r, c) - now_.centre).cross(f);
    input.work += f.dot(way);
    moved += double(particles.mass.at(r, c)) * way;
  });
  input.work -= input.force.dot(moved) / now_.mass;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Solid &was = solids_[i], &is = solids[i];
    if (!is.yields() || (was.velocity == is.velocity && was.spin == is.spin)) continue;
    input.momentum -= (is.velocity - was.velocity) / is.inverse_mass;
    input.angular_momentum -=
        angular_momentum(is, is.velocity - was.velocity, is.spin - was.spin, particles.place, now_.centre);
    input.energy += kinetic_energy(was) - kinetic_energy(is);
  }
  return input;
}

template <class Real>
bool MomentumKeeper<Real>::all_by_bdf2(const std::vector<Solid>& solids,
                                       const Field<Real>* second_order) const {
  if (!before_.known || second_order == nullptr) return false;
  if (std::any_of(solids.begin(), solids.end(), [](const Solid& solid) { return solid.yields(); })) {
    return false;
  }
  const auto& nodes = second_order->values();
  return std::all_of(nodes.begin(), nodes.end(), [](Real share) { return share > Real(0); });
}

template <class Real>
Freedom::Screw MomentumKeeper<Real>::response(const Particles<Real>& particles, const Forces<Real>& forces,
                                              const Motion& end, const Eigen::Matrix3d& inertia, double h,
                                              const Freedom::Screw& momenta) {
  Eigen::Matrix<double, 6, 6> system =
      h * damping_.matrix(particles, forces, end.centre, hung_ ? forces.soft_pins : nullptr);
  system.topLeftCorner<3, 3>().diagonal().array() += end.mass;
  system.bottomRightCorner<3, 3>() += inertia;
  // Nodes in one line do not turn about it.
  return system.completeOrthogonalDecomposition().solve(momenta);
}

template <class Real>
double MomentumKeeper<Real>::end_substep(Particles<Real>& particles, const Forces<Real>& forces,
                                         const std::vector<Solid>& solids, const VectorField<Real>& start,
                                         const Contact<Real>* contact, const Freedom& freedom, bool rubs,
                                         const Field<Real>* second_order, double h) {
  if (!now_.known) return 1;
  if (rubs || freedom.is_none()) {
    restart();
    return 1;
  }
  const Input given = input(particles, forces, solids, start);
  const Vec3 point = now_.centre;
  Vec3 momentum = now_.momentum + h * given.force + given.momentum;
  Vec3 angular = now_.about(point) + h * given.torque + given.angular_momentum;
  const bool by_bdf2 = !touched_by_body(solids, contact) && all_by_bdf2(solids, second_order);
  if (by_bdf2) {
    momentum = (4 * now_.momentum - before_.momentum + 2 * h * given.force) / 3;
    angular = (4 * now_.about(point) - before_.about(point) + 2 * h * given.torque) / 3;
  }

  const Motion end = motion_of(particles);
  const Vec3 missing = momentum - end.momentum;
  const Vec3 missing_spin = angular - end.about(point) - (end.centre - point).cross(missing);
  const Eigen::Matrix3d inertia = inertia_about(end.centre, particles);
  Freedom::Screw motion = response(particles, forces, end, inertia, by_bdf2 ? 2 * h / 3 : h,
                                   (Freedom::Screw() << missing, missing_spin).finished());
  if (!freedom.is_all()) {
    Freedom::Screw momenta;
    momenta << end.mass * motion.head<3>(), inertia * motion.tail<3>();
    motion = freedom.motion(momenta, end.mass, inertia);
  }
  const Vec3 shift = motion.head<3>();
  Vec3 turn = motion.tail<3>();
  if (!shift.allFinite() || !turn.allFinite()) return 1;
  double excess = 0;  // what the turning needs more than there is, J
  const double linear = end.spin.dot(turn), square = turn.dot(inertia * turn) / 2;
  if (linear + square > 0) {
    const Vec3 mean = (now_.momentum + momentum) / (2 * now_.mass);  // the centre's velocity
    const double had =
        now_.kinetic + forces.sheet->energy(start) + given.work + given.energy - mean.dot(given.momentum);
    const double left = had - end.kinetic - forces.sheet->energy(particles.position);
    const double share = share_within(left + motion_energy(particles, freedom).inner, linear, square);
    turn *= share;
    excess = share * (linear + share * square) - std::max(0.0, left);
  }
  const auto velocity = kernels::components(particles.velocity);
  for_each_node(particles.grid(), [&](std::size_t i, int r, int c) {
    add(velocity, i, Vec3(shift + turn.cross(particles.position_at(r, c) - end.centre)));
  });
  if (!freedom.is_all()) restart();  // a push breaks what BDF2 goes on from
  return take_from_motion(particles, excess, freedom);
}

template class MomentumKeeper<float>;
template class MomentumKeeper<double>;

}  // namespace weft
