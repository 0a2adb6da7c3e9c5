#include "cloth/integrators/implicit.h"

#include <algorithm>
#include <chrono>

namespace weft {
namespace {

using Clock = std::chrono::steady_clock;
double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

template <class Real>
void copy(kernels::Components<const Real> from, kernels::Components<Real> to, std::size_t count) {
  std::copy_n(from.x, count, to.x);
  std::copy_n(from.y, count, to.y);
  std::copy_n(from.z, count, to.z);
}

template <class Real>
void clear(kernels::Components<Real> field, std::size_t count) {
  for (Real* component : {field.x, field.y, field.z}) std::fill_n(component, count, Real(0));
}

template <class Real>
bool needs_blocks(const Forces<Real>& forces) {
  return std::any_of(forces.effects->begin(), forces.effects->end(),
                     [](const auto& effect) { return effect->needs_blocks(); });
}

}  // namespace

template <class Real>
Implicit<Real>::State::State(const Grid& grid, bool has_bending)
    : system(grid, has_bending),
      solver(grid),
      numbers(grid, 2),
      vectors(grid, 24),
      start(grid),
      start_velocity(grid),
      force(grid),
      step{numbers[0], vectors.vector(0), vectors.vector(3)},
      second_order(numbers[1]),
      last_move(vectors.vector(6)),
      last_velocity(vectors.vector(9)),
      position(vectors.vector(12)),
      b(vectors.vector(15)),
      change(vectors.vector(18)),
      move(vectors.vector(21)) {}

template <class Real>
AdvanceReport Implicit<Real>::advance(Particles<Real>& particles, Forces<Real> forces,
                                      BallContact<Real>* contact, std::vector<Ball>& balls, double time,
                                      double dt) {
  AdvanceReport report;
  report.substeps = parameters_.substeps;
  const double h = dt / parameters_.substeps;
  begin_step(particles, *forces.springs);
  ContactConstraints<Real>& contacts = state_->contacts;
  for (int substep = 0; substep < parameters_.substeps; ++substep) {
    const Substep part = Substep::of(substep, parameters_.substeps, dt);
    const auto begin = Clock::now();
    if (contact != nullptr) {
      contacts.begin(contact->touches(), particles, balls, part);
    } else {
      contacts.clear();
    }
    forces.context.time = time + part.to * dt;  // forces act as they are at the substep's end
    begin_substep(particles, h);
    for (int iteration = 0; iteration < parameters_.newton_iterations; ++iteration) {
      assemble(particles, forces);
      report.linear_iterations += solve(particles, h).iterations;
      kernels::move_nodes<Real>(
          state_->step,
          {state_->system.finest().free(), kernels::components(state_->start), state_->change, state_->move,
           kernels::components(particles.position), kernels::components(particles.velocity)},
          particles.grid().size());
      clear(state_->change, particles.grid().size());
    }
    const auto moved = Clock::now();
    report.forces_seconds += seconds(moved - begin);
    if (contact != nullptr) {
      contacts.finish(state_->move, balls);
      report.nodes_in_contact = contact->resolve(particles, balls, part);
      report.contact_seconds += seconds(Clock::now() - moved);
    }
    end_substep(particles, contact, h);
  }
  return report;
}

template <class Real>
void Implicit<Real>::begin_step(const Particles<Real>& particles, const Springs<Real>& springs) {
  const Grid& grid = particles.grid();
  if (!state_ || state_->system.grid() != grid) state_.emplace(grid, springs.has_bending());
  Real* free = state_->system.finest().free();
  const Real* inverse_mass = particles.inverse_mass.row(0);
  for (std::size_t i = 0; i < grid.size(); ++i) free[i] = inverse_mass[i] > Real(0) ? Real(1) : Real(0);
}

template <class Real>
void Implicit<Real>::begin_substep(const Particles<Real>& particles, double h) {
  State& s = *state_;
  const std::size_t count = particles.grid().size();
  const kernels::Components<const Real> velocity = kernels::components(particles.velocity);
  s.contacts.for_each_node([&](std::size_t node) { s.second_order[node] = Real(0); });
  kernels::begin_backward_step<Real>(s.second_order, velocity, s.last_move, s.last_velocity,
                                     static_cast<Real>(h), s.step, count);
  copy<Real>(kernels::components(particles.position), kernels::components(s.start), count);
  copy<Real>(velocity, kernels::components(s.start_velocity), count);
  // The guess: every node goes on as it went.
  clear(s.move, count);
  kernels::scaled_difference<Real>(velocity, s.move, static_cast<Real>(h), s.change, count);
}

template <class Real>
void Implicit<Real>::assemble(const Particles<Real>& particles, const Forces<Real>& forces) {
  State& s = *state_;
  const Grid& grid = particles.grid();
  const std::size_t count = grid.size();
  auto& finest = s.system.finest();

  copy<Real>(kernels::components(particles.position), s.position, count);
  forces.springs->linearise(grid, s.position, finest.matrix.links);
  forces.sum(particles, s.force);
  std::fill_n(finest.diagonal(), count, Real(0));
  const bool blocks = !s.contacts.empty() || needs_blocks(forces);
  finest.use_blocks(blocks);
  for (const auto& effect : *forces.effects) {
    effect->add_damping(particles, forces.context, {finest.diagonal(), finest.matrix.blocks});
  }

  const kernels::Iterate<Real> iterate{s.move, kernels::components(particles.velocity),
                                       kernels::components(s.force)};
  const Real* mass = particles.mass.row(0);
  if (blocks) {
    kernels::assemble_system<Real>(mass, finest.free(), s.step, iterate, finest.diagonal(),
                                   finest.matrix.blocks, s.b, count);
  } else {
    kernels::assemble_system<Real>(mass, finest.free(), s.step, iterate, finest.diagonal(), s.b, count);
  }
  if (!s.contacts.empty()) {
    s.contacts.add_to(finest.matrix.blocks, s.b, finest.diagonal(), forces.springs->node_stiffness(), s.move);
  }
  s.system.prepare();
}

template <class Real>
LinearSolveReport Implicit<Real>::solve(const Particles<Real>& particles, double h) {
  State& s = *state_;
  // The error allowed, as a kinetic energy: of the speed the nodes have or, at rest, of what gravity gives
  // them in a substep.
  const Grid& grid = particles.grid();
  const double speed_given = standard_gravity().norm() * h;
  double mass = 0;
  for (const Real node : particles.mass.values()) mass += static_cast<double>(node);
  const double scale =
      kernels::weighted_square<Real>(particles.mass.row(0), kernels::components(s.start_velocity), grid) +
      mass * speed_given * speed_given;
  return s.solver.solve(s.system, s.b, s.change, parameters_.tolerance * parameters_.tolerance * scale,
                        parameters_.linear_iterations);
}

template <class Real>
void Implicit<Real>::end_substep(Particles<Real>& particles, const BallContact<Real>* contact, double h) {
  State& s = *state_;
  const std::size_t count = particles.grid().size();
  kernels::scaled_difference<Real>(kernels::components(particles.velocity),
                                   kernels::components(s.start_velocity), static_cast<Real>(1 / h),
                                   kernels::components(particles.acceleration), count);
  if (!second_order_) return;
  kernels::scaled_difference<Real>(kernels::components(particles.position), kernels::components(s.start),
                                   Real(1), s.last_move, count);
  copy<Real>(kernels::components(s.start_velocity), s.last_velocity, count);
  std::fill_n(s.second_order, count, Real(1));
  if (contact == nullptr) return;
  for (const Touch& touch : contact->touches()) s.second_order[touch.node] = Real(0);
}

template class Implicit<float>;
template class Implicit<double>;

}  // namespace weft
