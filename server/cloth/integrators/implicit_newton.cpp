/// Implicit's Newton iterations: one linearisation after the other, until the move is found.
#include <algorithm>
#include <limits>

#include "cloth/core/interrupt.h"
#include "cloth/integrators/change_search.h"
#include "cloth/integrators/implicit.h"
#include "cloth/kernels/node_vector.h"
#include "cloth/sheet/diagnostics.h"

namespace weft {
namespace {

/// Newton iterations added at most when those asked for are rough or gain energy, and after contacts were
/// added.
constexpr int kSpareIterations = 8, kMoreIterations = 3;
/// A linearisation whose error exceeds this share of the kinetic energy is repeated. Near rest the error may
/// not exceed that of a solve.
constexpr double kRough = 0.2;
/// The same for friction where contact begins, of the kinetic energy found: there nothing tells beforehand
/// how hard the nodes are pressed. That is repeated so many times at most.
constexpr double kRoughFriction = 0.05;
constexpr int kFrictionIterations = 5;
/// The same for a sheet in contact with itself that lies on a solid.
constexpr double kRoughHeap = 0.02;
/// Further rounds that hold nodes of such a sheet which the last iteration has moved into a solid: projection
/// after the step would add energy.
constexpr int kHeapRounds = 4;
/// Largest error of the linearisation in a single spring, in nodes' shares of the kinetic energy: a fold that
/// runs through a stiff sheet would overstretch the few springs in it.
constexpr double kRoughSpring = 8;
/// Share of its length by which a spring may end beyond a strain limit that it was short of: the limit's
/// stiffness was not in the system.
constexpr double kStruck = 0.01;
/// Spare iterations that take whole changes. Those after them are searched, since Newton's method then
/// alternates between states that each linearisation misjudges. Not in contact, which the search does not
/// know.
constexpr int kWholeSpareIterations = 4;
/// Number of searched iterations while a spring is misjudged by kRoughSpring.
constexpr int kSpareSearches = 24;
/// A change that is dropped does not matter if it lowers the energy by less than this share of the motion's.
constexpr double kMissedShare = 1e-3;
/// Work of a linearisation and of judging its change, a node (WorkLimit).
constexpr double kWorkOfNewton = 10;

}  // namespace

template <class Real>
int Implicit<Real>::find_move(Particles<Real>& particles, const Forces<Real>& forces, double h) {
  State& s = *state_;
  guess_move(h);
  NewtonReport report = iterate(particles, forces, Take::whole);
  if (report.brought_in <= 0) return report.linear_iterations;
  memory_->formula.return_to_start(particles);
  // Past motion says little about what follows: from here on as backward Euler, the next substep too.
  memory_->formula.break_all();
  memory_->formula.prepare();
  guess_move(h);
  const NewtonReport searched = iterate(particles, forces, Take::searched);
  s.sound = s.sound && searched.found;
  return report.linear_iterations + searched.linear_iterations;
}

template <class Real>
void Implicit<Real>::guess_move(double h) {
  // Every node goes on as it went.
  State& s = *state_;
  const std::size_t count = s.system.grid().size();
  clear(s.move, count);
  s.system.bodies().reset();
  kernels::scaled_difference<Real>(kernels::components(memory_->formula.start_velocity()), s.move,
                                   static_cast<Real>(h), s.change, count);
}

template <class Real>
auto Implicit<Real>::iterate(Particles<Real>& particles, const Forces<Real>& forces, Take take)
    -> NewtonReport {
  State& s = *state_;
  const StepFormula<Real>& formula = memory_->formula;
  const std::size_t count = particles.grid().size();
  NewtonReport report;
  const bool heap = forces.layered && !memory_->contacts.empty();
  int heap_rounds = 0;
  const kernels::Components<Real> recycled = memory_->correction.vector();
  const kernels::Components<Real>* correction = &recycled;
  for (int left = parameters_.newton_iterations; left > -kSpareSearches; --left) {
    check_interrupt(kWorkOfNewton * static_cast<double>(count));
    assemble(particles, forces);
    const LinearSolveReport solved =
        s.solver.solve(s.system, s.b, s.change, s.target, parameters_.linear_iterations, correction);
    correction = nullptr;
    s.target = {.least = solved.target};
    const double decrease = solved.decrease + s.system.bodies().find_changes(s.change);
    s.motion.found(decrease);
    const bool stray =
        left <= -kWholeSpareIterations && memory_->contacts.empty() && forces.layers == nullptr;
    ChangeSearch<Real> search(forces, memory_->contacts, s.system, {s.position, s.move, s.change},
                              s.stretched_to_twice);
    const ChangeReport changed =
        stray || take == Take::searched ? search.take_searched(decrease) : search.take_whole(decrease);
    s.system.bodies().take_changes();
    kernels::move_nodes<Real>(
        formula.coefficients(),
        {s.system.finest().free(), kernels::components(formula.start()), s.change, s.move,
         kernels::components(particles.position), kernels::components(particles.velocity)},
        count);
    clear(s.change, count);
    report.linear_iterations += solved.iterations;
    report.brought_in += solved.finite ? changed.brought_in : std::numeric_limits<double>::infinity();
    const bool found = changed.taken || decrease <= kMissedShare * s.motion.energy();
    report.found = report.found || (solved.finite && found);
    double error = changed.error, pulling = 0, begun = 0;
    if (!memory_->contacts.empty()) {
      const auto misjudged = memory_->contacts.error(s.move, s.system.bodies());
      error += misjudged.all;
      begun = misjudged.begun;
      pulling += memory_->contacts.release_pulling(s.move, s.system.bodies());
    }
    pulling += s.system.bodies().misjudged();
    if (forces.layers != nullptr) pulling += forces.layers->release_pulling(s.move);
    error = std::max(error, pulling);
    const double motion = s.kept_stiffness * s.motion.energy();
    const bool rough = changed.largest * static_cast<double>(s.system.grid().nodes()) > kRoughSpring * motion;
    const bool fine = left > 1 || rough || s.motion.fine();
    const double allowed =
        fine ? solved.target : std::max(solved.target, (heap ? kRoughHeap : kRough) * motion);
    const bool known = begun <= solved.target || left <= 1 - kFrictionIterations ||
                       begun <= kRoughFriction * kinetic_energy(particles);
    const bool done = report.brought_in <= 0 && error <= allowed && known && changed.struck <= kStruck;
    const bool last = left <= 1 - (stray && rough ? kSpareSearches : kSpareIterations);
    if (!last && (!done || let_go(particles) || hold_inside(particles, forces.sheet->springs(), allowed)))
      continue;
    if (!forces.layered) break;
    const bool meet = forces.layers != nullptr && hold_meeting(particles, *forces.layers);
    const bool enter =
        heap && heap_rounds++ < kHeapRounds && hold_inside(particles, forces.sheet->springs(), allowed);
    if (!meet && !enter) break;
    left = std::max(left, kMoreIterations - kSpareIterations);
  }
  return report;
}

template <class Real>
bool Implicit<Real>::let_go(const Particles<Real>& particles) {
  State& s = *state_;
  return !memory_->contacts.empty() &&
         memory_->contacts.let_go_of_slid_off(particles, *surroundings_.solids, s.move, s.system.bodies());
}

template <class Real>
bool Implicit<Real>::hold_inside(const Particles<Real>& particles, const Springs<Real>& springs,
                                 double missed) {
  const auto& [contact, solids, part] = surroundings_;
  if (contact == nullptr) return false;
  State& s = *state_;
  AttachedBodies<Real>& bodies = s.system.bodies();
  const std::vector<Solid> bent =
      bodies.empty() ? std::vector<Solid>{} : memory_->contacts.bent(*solids, bodies);
  const std::vector<Solid>& now = bodies.empty() ? *solids : bent;
  if (!memory_->contacts.hold_inside(contact->inside(particles, now, part),
                                     contact->passed(particles, memory_->formula.start(), now, part),
                                     particles, now, s.move, bodies, springs.node_stiffness(), missed))
    return false;
  if (contact->body_touches() != nullptr) memory_->contacts.join(*contact->body_touches(), *solids, bodies);
  memory_->contacts.for_each_broken([&](std::size_t node) { memory_->formula.break_motion(node); });
  memory_->formula.prepare();
  return true;
}

template <class Real>
bool Implicit<Real>::hold_meeting(const Particles<Real>& particles, LayerContacts<Real>& layers) {
  State& s = *state_;
  if (!layers.hold_meeting(kernels::components(particles.position), s.move)) return false;
  layers.for_each_node([&](std::size_t node) { memory_->formula.break_motion(node); });
  memory_->formula.prepare();
  return true;
}

template int Implicit<float>::find_move(Particles<float>&, const Forces<float>&, double);
template void Implicit<float>::guess_move(double);
template auto Implicit<float>::iterate(Particles<float>&, const Forces<float>&, Take) -> NewtonReport;
template bool Implicit<float>::let_go(const Particles<float>&);
template bool Implicit<float>::hold_inside(const Particles<float>&, const Springs<float>&, double);
template bool Implicit<float>::hold_meeting(const Particles<float>&, LayerContacts<float>&);
template int Implicit<double>::find_move(Particles<double>&, const Forces<double>&, double);
template void Implicit<double>::guess_move(double);
template auto Implicit<double>::iterate(Particles<double>&, const Forces<double>&, Take) -> NewtonReport;
template bool Implicit<double>::let_go(const Particles<double>&);
template bool Implicit<double>::hold_inside(const Particles<double>&, const Springs<double>&, double);
template bool Implicit<double>::hold_meeting(const Particles<double>&, LayerContacts<double>&);

}  // namespace weft
