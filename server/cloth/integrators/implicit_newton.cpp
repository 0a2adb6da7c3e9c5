/// Implicit's Newton iterations: one linearisation after the other, until the move is found.
#include <algorithm>
#include <limits>
#include <optional>

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
/// Further rounds that hold nodes which the last iteration has moved into a solid: projection after the step
/// would add energy.
constexpr int kRounds = 4;
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
void Implicit<Real>::find_moves(std::span<Step> steps) {
  for (Step& step : steps) step.method->guess_move();
  SolveTarget target = target_of(steps);
  const NewtonReport report = iterate(steps, target, Take::whole);
  int iterations = report.linear_iterations;
  if (report.brought_in > 0) {
    for (Step& step : steps) {
      StepFormula<Real>& formula = step.method->memory_->formula;
      formula.return_to_start(*step.particles);
      // Past motion says little about what follows: from here on as backward Euler, the next substep too.
      formula.break_all();
      formula.prepare();
      step.method->guess_move();
    }
    const NewtonReport searched = iterate(steps, target, Take::searched);
    iterations += searched.linear_iterations;
    for (Step& step : steps) step.method->state_->sound = step.method->state_->sound && searched.found;
  }
  for (Step& step : steps) step.report.linear_iterations += iterations;
}

template <class Real>
SolveTarget Implicit<Real>::target_of(std::span<Step> steps) {
  // Fine enough for each that moves, or for all where none does.
  const bool rest = std::all_of(steps.begin(), steps.end(),
                                [](const Step& step) { return step.method->state_->motion.near_rest(); });
  std::optional<SolveTarget> finest;
  for (const Step& step : steps) {
    const State& s = *step.method->state_;
    if (s.motion.near_rest() != rest) continue;
    if (!finest) finest = s.target;
    finest->least = std::min(finest->least, s.target.least);
    finest->share = std::min(finest->share, s.target.share);
    finest->most = std::min(finest->most, s.target.most);
  }
  return *finest;
}

template <class Real>
void Implicit<Real>::guess_move() {
  // Every node goes on as it went.
  State& s = *state_;
  const std::size_t count = s.system.grid().size();
  clear(s.move, count);
  s.system.bodies().reset();
  kernels::scaled_difference<Real>(kernels::components(memory_->formula.start_velocity()), s.move,
                                   static_cast<Real>(s.h), s.change, count);
}

template <class Real>
auto Implicit<Real>::iterate(std::span<Step> steps, SolveTarget& target, Take take) -> NewtonReport {
  LayerContacts<Real>* layers = steps[0].forces.layers;
  NewtonReport report;
  bool heap = false;  // of cloth on a solid
  int iterations = 0, nodes = 0;
  for (const Step& step : steps) {
    const bool touches = !step.method->memory_->contacts.empty();
    heap = heap || (step.forces.layered && touches);
    iterations = std::max(iterations, step.method->parameters_.newton_iterations);
    nodes += step.particles->grid().nodes();
  }
  int rounds = 0;
  bool corrected = true;
  for (int left = iterations; left > -kSpareSearches; --left) {
    const LinearSolveReport solved = solve(steps, target, corrected);
    corrected = false;
    target = {.least = solved.target};
    double decrease = solved.decrease;
    bool free = layers == nullptr;  // it touches nothing
    for (Step& step : steps) {
      State& s = *step.method->state_;
      decrease += s.system.bodies().find_changes(s.change);
      free = free && step.method->memory_->contacts.empty();
    }
    const bool stray = left <= -kWholeSpareIterations && free;
    for (Step& step : steps) step.method->state_->motion.found(decrease);
    const ChangeReport changed = change(steps, decrease, stray || take == Take::searched);
    double motion = 0, all_motion = 0, kinetic = 0;
    ContactError contact;
    bool fine = true;
    for (Step& step : steps) {
      Implicit& method = *step.method;
      method.move(*step.particles);
      const State& s = *method.state_;
      all_motion += s.motion.energy();
      motion += s.kept_stiffness * s.motion.energy();
      fine = fine && s.motion.fine();
      const ContactError of_step = method.contact_error();
      contact.all += of_step.all;
      contact.begun += of_step.begun;
      contact.pulling += of_step.pulling;
    }
    report.linear_iterations += solved.iterations;
    report.brought_in += solved.finite ? changed.brought_in : std::numeric_limits<double>::infinity();
    const bool found = changed.taken || decrease <= kMissedShare * all_motion;
    report.found = report.found || (solved.finite && found);
    if (layers != nullptr) contact.pulling += layers->release_pulling(moves_of(steps));
    const double error = std::max(changed.error + contact.all, contact.pulling);
    const bool rough = changed.largest * static_cast<double>(nodes) > kRoughSpring * motion;
    const double allowed = left > 1 || rough || fine
                               ? solved.target
                               : std::max(solved.target, (heap ? kRoughHeap : kRough) * motion);
    bool known = contact.begun <= solved.target || left <= 1 - kFrictionIterations;
    if (!known) {
      for (const Step& step : steps) kinetic += kinetic_energy(*step.particles);
      known = contact.begun <= kRoughFriction * kinetic;
    }
    const bool done = report.brought_in <= 0 && error <= allowed && known && changed.struck <= kStruck;
    const bool last = left <= 1 - (stray && rough ? kSpareSearches : kSpareIterations);
    const auto any = [&](const auto& of_step) {
      bool found_any = false;
      for (Step& step : steps) found_any = of_step(step) || found_any;
      return found_any;
    };
    const auto enters = [&](Step& step) {
      return step.method->hold_inside(*step.particles, step.forces.sheet->springs(), allowed);
    };
    const auto changes_hands = [&](Step& step) {
      return step.method->let_go(*step.particles) || enters(step);
    };
    if (!last && (!done || any(changes_hands))) continue;
    const bool meet = layers != nullptr && hold_meeting(steps);
    const bool enter = last && report.brought_in <= 0 && rounds++ < kRounds && any(enters);
    if (!meet && !enter) break;
    left = std::max(left, kMoreIterations - kSpareIterations);
  }
  return report;
}

template <class Real>
LinearSolveReport Implicit<Real>::solve(std::span<Step> steps, const SolveTarget& target, bool corrected) {
  LayerContacts<Real>* layers = steps[0].forces.layers;
  SystemCouplings<Real> between;
  std::vector<LayerSystem<Real>> systems;
  systems.reserve(steps.size());
  int iterations = 0;
  for (Step& step : steps) {
    State& s = *step.method->state_;
    check_interrupt(kWorkOfNewton * static_cast<double>(s.system.grid().size()));
    step.method->assemble(*step.particles, step.forces);
    systems.push_back({s.b, &s.system.couplings(), s.system.finest().diagonal(), s.move});
    iterations = std::max(iterations, step.method->parameters_.linear_iterations);
  }
  if (layers != nullptr) layers->add_to(systems, between);
  std::vector<kernels::Components<Real>> corrections;
  corrections.reserve(steps.size());
  for (Step& step : steps) corrections.push_back(step.method->memory_->correction.vector());
  std::vector<SystemPart<Real>> parts;
  parts.reserve(steps.size());
  for (std::size_t k = 0; k < steps.size(); ++k) {
    State& s = *steps[k].method->state_;
    if (steps[k].forces.bag != nullptr) steps[k].forces.bag->average(s.b);
    s.system.prepare();
    parts.push_back({&s.solver, &s.system, s.b, s.change, corrected ? &corrections[k] : nullptr});
  }
  return ConjugateGradients<Real>::solve(parts, between, target, iterations);
}

template <class Real>
ChangeReport Implicit<Real>::change(std::span<Step> steps, double decrease, bool searched) {
  std::vector<ChangedPart<Real>> parts;
  parts.reserve(steps.size());
  for (Step& step : steps) {
    State& s = *step.method->state_;
    parts.push_back({step.forces, step.method->memory_->contacts, s.system, s.position, s.move, s.change,
                     s.stretched_to_twice});
  }
  ChangeSearch<Real> search(std::move(parts), steps[0].forces.layers);
  return searched ? search.take_searched(decrease) : search.take_whole(decrease);
}

template <class Real>
void Implicit<Real>::move(Particles<Real>& particles) {
  State& s = *state_;
  const StepFormula<Real>& formula = memory_->formula;
  const std::size_t count = particles.grid().size();
  s.system.bodies().take_changes();
  kernels::move_nodes<Real>(
      formula.coefficients(),
      {s.system.finest().free(), kernels::components(formula.start()), s.change, s.move,
       kernels::components(particles.position), kernels::components(particles.velocity)},
      count);
  clear(s.change, count);
}

template <class Real>
std::vector<kernels::Components<const Real>> Implicit<Real>::moves_of(std::span<Step> steps) {
  std::vector<kernels::Components<const Real>> moves;
  moves.reserve(steps.size());
  for (const Step& step : steps) moves.push_back(step.method->state_->move);
  return moves;
}

template void Implicit<float>::find_moves(std::span<Step>);
template SolveTarget Implicit<float>::target_of(std::span<Step>);
template void Implicit<float>::guess_move();
template auto Implicit<float>::iterate(std::span<Step>, SolveTarget&, Take) -> NewtonReport;
template LinearSolveReport Implicit<float>::solve(std::span<Step>, const SolveTarget&, bool);
template ChangeReport Implicit<float>::change(std::span<Step>, double, bool);
template void Implicit<float>::move(Particles<float>&);
template auto Implicit<float>::moves_of(std::span<Step>) -> std::vector<kernels::Components<const float>>;
template void Implicit<double>::find_moves(std::span<Step>);
template SolveTarget Implicit<double>::target_of(std::span<Step>);
template void Implicit<double>::guess_move();
template auto Implicit<double>::iterate(std::span<Step>, SolveTarget&, Take) -> NewtonReport;
template LinearSolveReport Implicit<double>::solve(std::span<Step>, const SolveTarget&, bool);
template ChangeReport Implicit<double>::change(std::span<Step>, double, bool);
template void Implicit<double>::move(Particles<double>&);
template auto Implicit<double>::moves_of(std::span<Step>) -> std::vector<kernels::Components<const double>>;

}  // namespace weft
