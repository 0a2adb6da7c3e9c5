#include "cloth/integrators/momentum_keeper.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "cloth/contact/constraints/contact_constraints.h"
#include "cloth/core/small_system.h"
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

/// Of a body that moves like this at `to`, share of the step, about a point in the world, seen from `place`.
Vec3 angular_momentum(const Solid& solid, double to, const Vec3& velocity, const Vec3& spin,
                      const Vec3& place, const Vec3& point) {
  Vec3 sum = (place + solid.at(to) - point).cross(velocity / solid.inverse_mass);
  if (solid.yields_turning()) sum += solid.inverse_inertia.inverse() * spin;
  return sum;
}

/// Of a sheet and the gas that is shut in it, J.
template <class Real>
double inner_energy(const Forces<Real>& forces, const VectorField<Real>& position) {
  const double of_gas = forces.holds_gas() ? forces.bag->gas()->energy(position, forces.context.time) : 0;
  return forces.sheet->energy(position) + of_gas;
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
  return (forces.layers == nullptr || !forces.layers->meets_outsiders()) && forces.sheet->torn() == nullptr &&
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
bool MomentumKeeper<Real>::is_drawn(const Member& member) {
  const Effect<Real>* hung = member.keeper->hung_ ? member.forces->soft_pins : nullptr;
  return std::any_of(member.forces->effects->begin(), member.forces->effects->end(),
                     [&](const auto& effect) { return effect.get() != hung && effect->holds(); });
}

template <class Real>
void MomentumKeeper<Real>::Motion::join(const Motion& other) {
  known = known && other.known;
  const Motion one = *this;
  mass = one.mass + other.mass;
  centre = (one.mass * one.centre + other.mass * other.centre) / mass;
  momentum = one.momentum + other.momentum;
  const Vec3 mean = momentum / mass;
  spin.setZero();
  kinetic = 0;
  for (const Motion* each : {&one, &other}) {
    const Vec3 beside = each->momentum - each->mass * mean;
    spin += each->spin + (each->centre - centre).cross(beside);
    kinetic += each->kinetic + beside.squaredNorm() / (2 * each->mass);
  }
}

template <class Real>
void MomentumKeeper<Real>::Input::operator+=(const Input& other) {
  force += other.force;
  torque += other.torque;
  work += other.work;
  moved += other.moved;
  momentum += other.momentum;
  angular_momentum += other.angular_momentum;
  energy += other.energy;
}

template <class Real>
auto MomentumKeeper<Real>::input(const Member& member, const Vec3& centre) -> Input {
  const Particles<Real>& particles = *member.particles;
  const Forces<Real>& forces = *member.forces;
  const Grid& grid = particles.grid();
  if (force_.grid() != grid) force_ = VectorField<Real>(grid);
  forces.sum_effects(particles, force_, hung_ ? forces.soft_pins : nullptr);
  Input input;
  const auto each_force = kernels::components(std::as_const(force_));
  const auto from = kernels::components(*member.start),
             to = kernels::components(std::as_const(particles.position));
  for_each_node(grid, [&](std::size_t i, int r, int c) {
    const Vec3 f = at(each_force, i), way = at(to, i) - at(from, i);
    input.force += f;
    input.torque += (particles.position_at(r, c) - centre).cross(f);
    input.work += f.dot(way);
    input.moved += double(particles.mass.at(r, c)) * way;
  });
  input.torque += member.hung_torque;
  const std::vector<Solid>& solids = *member.solids;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Solid &was = solids_[i], &is = solids[i];
    if (!is.yields() || (was.velocity == is.velocity && was.spin == is.spin)) continue;
    input.momentum -= (is.velocity - was.velocity) / is.inverse_mass;
    input.angular_momentum -= angular_momentum(is, member.to, is.velocity - was.velocity, is.spin - was.spin,
                                               particles.place, centre);
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
Freedom::Screw MomentumKeeper<Real>::response(std::span<const Member> members, const Motion& end,
                                              const Eigen::Matrix3d& inertia, double h,
                                              const Freedom::Screw& momenta) {
  Eigen::Matrix<double, 6, 6> system = Eigen::Matrix<double, 6, 6>::Zero();
  for (const Member& member : members) {
    MomentumKeeper& keeper = *member.keeper;
    system += h * keeper.damping_.matrix(*member.particles, *member.forces, end.centre, h,
                                         keeper.hung_ ? member.forces->soft_pins : nullptr);
  }
  system.topLeftCorner<3, 3>().diagonal().array() += end.mass;
  system.bottomRightCorner<3, 3>() += inertia;
  // Nodes in one line do not turn about it.
  return least_solution(system, momenta);
}

template <class Real>
void MomentumKeeper<Real>::go_on(Particles<Real>& particles, const Vec3& centre, const Vec3& shift,
                                 const Vec3& turn) {
  const Eigen::Matrix3d turned = Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()).toRotationMatrix() -
                                 Eigen::Matrix3d::Identity();
  const auto position = kernels::components(particles.position);
  for_each_node(particles.grid(), [&](std::size_t i, int r, int c) {
    add(position, i, Vec3(shift + turned * (particles.position_at(r, c) - centre)));
  });
}

template <class Real>
double MomentumKeeper<Real>::end_substep(std::span<const Member> members, double h) {
  if (std::any_of(members.begin(), members.end(),
                  [](const Member& each) { return !each.keeper->now_.known; }))
    return 1;
  const Member& first = members[0];
  const bool alone = members.size() == 1;
  Motion now = first.keeper->now_, before = first.keeper->before_, end = motion_of(*first.particles);
  bool free = true, by_bdf2 = true, drawn = false;
  for (const Member& member : members) {
    if (&member != &first) {
      now.join(member.keeper->now_);
      before.join(member.keeper->before_);
      end.join(motion_of(*member.particles));
    }
    free = free && !member.rubs && !member.freedom->is_none() && (alone || member.freedom->is_all());
    drawn = drawn || is_drawn(member);
    by_bdf2 = by_bdf2 && !touched_by_body(*member.solids, member.contact) &&
              member.keeper->all_by_bdf2(*member.solids, member.second_order);
  }
  const auto restart_all = [&] {
    for (const Member& member : members) member.keeper->restart();
  };
  // What is drawn has to be moved as well, which would push it into what it touches.
  const bool touches = !alone || (first.contact != nullptr && !first.contact->touches().empty());
  if (!free || (drawn && touches)) {
    restart_all();
    return 1;
  }
  // A hand's place does not go on with the cloth, so that what a hand draws turns about a fixed point. Other
  // cloth turns about its own centre at the substep's end, where gravity has no lever.
  const Vec3 point = drawn ? now.centre : end.centre;
  const auto turning = [&](const Motion& motion) { return drawn ? motion.about(point) : motion.spin; };
  Input given;
  for (const Member& member : members) given += member.keeper->input(member, point);
  Vec3 momentum = now.momentum + h * given.force + given.momentum;
  Vec3 angular = turning(now) + h * given.torque + given.angular_momentum;
  if (by_bdf2) {
    momentum = (4 * now.momentum - before.momentum + 2 * h * given.force) / 3;
    angular = (4 * turning(now) - turning(before) + 2 * h * given.torque) / 3;
  }

  const Vec3 missing = momentum - end.momentum;
  const Vec3 missing_spin = angular - turning(end) - (end.centre - point).cross(missing);
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (const Member& member : members) inertia += inertia_about(end.centre, *member.particles);
  const double lasts = by_bdf2 ? 2 * h / 3 : h;  // what moves by dv is dv times that farther, by the formula
  Freedom::Screw motion =
      response(members, end, inertia, lasts, (Freedom::Screw() << missing, missing_spin).finished());
  const Freedom& freedom = *first.freedom;  // of several: all
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
    const Vec3 mean = (now.momentum + momentum) / (2 * now.mass);  // the centre's velocity
    const double work = given.work - given.force.dot(given.moved) / now.mass;
    double had = now.kinetic, left = -end.kinetic;
    for (const Member& member : members) {
      had += inner_energy(*member.forces, *member.start);
      left -= inner_energy(*member.forces, member.particles->position);
    }
    left += had + work + given.energy - mean.dot(given.momentum);
    // Of several, whose contact takes energy, none is taken from what they do beside one another.
    const double inner = alone ? motion_energy(*first.particles, freedom).inner : 0;
    const double share = share_within(left + inner, linear, square);
    turn *= share;
    excess = alone ? share * (linear + share * square) - std::max(0.0, left) : 0;
  }
  for (const Member& member : members) {
    const auto velocity = kernels::components(member.particles->velocity);
    for_each_node(member.particles->grid(), [&](std::size_t i, int r, int c) {
      add(velocity, i, Vec3(shift + turn.cross(member.particles->position_at(r, c) - end.centre)));
    });
  }
  if (drawn) go_on(*first.particles, end.centre, lasts * shift, lasts * turn);
  if (!freedom.is_all()) restart_all();  // a push breaks what BDF2 goes on from
  return alone ? take_from_motion(*first.particles, excess, freedom) : 1;
}

template class MomentumKeeper<float>;
template class MomentumKeeper<double>;

}  // namespace weft
