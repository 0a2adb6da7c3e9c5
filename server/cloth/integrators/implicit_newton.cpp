/// Implicit's Newton iterations: one linearisation after the other, until the move is found.
#include <algorithm>
#include <limits>

#include "cloth/integrators/implicit.h"
#include "cloth/interrupt.h"
#include "cloth/solver/node_vector.h"

namespace weft {
namespace {

/// Newton iterations added at most when those asked for are rough or bring in energy: half a turn a frame
/// takes one, a crumpled sheet all.
constexpr int kSpareIterations = 8, kMoreIterations = 3;
/// A linearisation off by more than this share of the motion's energy is made again; at 0.1 rad a frame it is
/// not. Near rest none may be off by more than a solve.
constexpr double kRough = 0.2;
/// Where a sheet that meets itself lies on something: what a linearisation misses there heaps fold up with. A
/// square that falls on its edge rose by up to 0.03 J of the 0.54 that it has, in eight falls at two levels.
constexpr double kRoughHeap = 0.02;
/// Further rounds in which a heap's nodes that the last iteration has put into a solid are held. Without,
/// what puts them out of it brings in up to 0.006 J there.
constexpr int kHeapRounds = 4;
/// Nor is one off by more than so many nodes' share of that energy in a single spring: a fold that runs
/// through a stiff sheet would stretch the few springs in it far beyond their strain. A curtain, a flag or a
/// drape stays below 2; a cushion blown up at one blow does not, and takes a tenth more iterations meanwhile.
constexpr double kRoughSpring = 8;
/// Nor is one by which a spring ends this share of its length past a strain limit that it was short of: the
/// limit's stiffness was not in the system. A sheet of limit 5 % that is jerked at 10 m/s (S21, BDF2 at level
/// 6 and 15 Hz) was left 6.6 % past it; in 16 runs of tolerances 0.2 % apart it was stretched by 11.6 % in
/// 12, and is by at most 10.0 %, mostly 8.2 %. With 0.04 mostly 9.6 %.
constexpr double kStruck = 0.01;
/// Spare iterations that take whole changes. Those after them are searched, as Newton's method then runs to
/// and fro between states that each linearisation misjudges: unsearched, a ribbon with cells of 1 : 100 is
/// left with a spring stretched by 31 %. Not in contact, which the search does not know.
constexpr int kWholeSpareIterations = 4;
/// While the searched ones leave one spring misjudged by kRoughSpring there are so many spare ones: where
/// they ended after 8, that spring was left as it was. Of 48 falls of that ribbon (S12, backward Euler at
/// level 6 and 30 Hz, tolerances 0.2 % apart) 8 ended up with one stretched by more than 5 %, up to 11.6 %;
/// now none does, at most 4.6 %, in no more linear iterations. To search from the first spare one on is no
/// way: BDF2 then overstretches the ribbon at level 5 and 15 Hz in 5 of 20 falls, in none if not.
constexpr int kSpareSearches = 24;
/// A whole change that brings in so many times what it was to gain, and strains all springs by this on
/// average, is wild, and is halved until it is not: the next linearisations take long to find back, and what
/// is held apart meanwhile meets nowhere else. A light strip without stiffness to shear (6e5 N/m) that lies
/// in folds at rest got 85 J so; it has no more than 0.0001. A flag in the wind takes 0.95 times the
/// instructions, other presets as many as before. Less strain is not wild: a stiff sheet that comes to rest
/// (S1a, 1e7 N/m) needs whole changes, and takes 10 s with them, 23 s without.
constexpr double kWild = 10, kWildStrain = 0.01;
/// A shorter share of a change is none.
constexpr double kSmallestShare = 1e-4;
/// A change that lowers the energy by less than this share of the motion's is not missed when it is dropped.
constexpr double kMissedShare = 1e-3;

/// Of energies that are added up and taken from each other, in units of the scalar's last digit: what cannot
/// be told from a gain is none that may be taken. A flat sheet of 0.3 m and 6e5 N/m at rest had 5 J after a
/// second, of forces that are nothing but rounding: the first change stretches it by metres.
constexpr double kRounding = 4;
/// The same of what a solve gains: its directions gain and lose far more than their sum, each to the last
/// digit. Two crumpled sheets at rest (1e5 times what is left, each iteration) got 3.5 mJ where 0.9 are
/// allowed.
constexpr double kSolveRounding = 300;

/// Of a linearisation and what is asked of its change, a node (WorkLimit).
constexpr double kWorkOfNewton = 10;

}  // namespace

template <class Real>
auto Implicit<Real>::iterate(Particles<Real>& particles, const Forces<Real>& forces, Change change)
    -> NewtonReport {
  State& s = *state_;
  const std::size_t count = particles.grid().size();
  NewtonReport report;
  const bool heap = forces.layered && !memory_->contacts.empty();
  int heap_rounds = 0;
  for (int left = parameters_.newton_iterations; left > -kSpareSearches; --left) {
    check_interrupt(kWorkOfNewton * static_cast<double>(count));
    assemble(particles, forces);
    const LinearSolveReport solved =
        s.solver.solve(s.system, s.b, s.change, s.target, parameters_.linear_iterations);
    s.target = {.least = solved.target};
    const double decrease = solved.decrease + s.system.bodies().find_changes(s.change);
    s.motion.found(decrease);
    const bool stray =
        left <= -kWholeSpareIterations && memory_->contacts.empty() && forces.layers == nullptr;
    const ChangeReport changed =
        stray ? searched_change(forces, decrease) : (this->*change)(forces, decrease);
    s.system.bodies().take_changes();
    kernels::move_nodes<Real>(
        s.step,
        {s.system.finest().free(), kernels::components(s.start), s.change, s.move,
         kernels::components(particles.position), kernels::components(particles.velocity)},
        count);
    clear(s.change, count);
    report.linear_iterations += solved.iterations;
    report.brought_in += solved.finite ? changed.brought_in : std::numeric_limits<double>::infinity();
    const bool found = changed.taken || decrease <= kMissedShare * s.motion.energy();
    report.found = report.found || (solved.finite && found);
    double error = changed.error, pulling = 0;
    if (!memory_->contacts.empty()) pulling += memory_->contacts.release_pulling(s.move, s.system.bodies());
    if (forces.layers != nullptr) pulling += forces.layers->release_pulling(s.move);
    error = std::max(error, pulling);
    const double motion = s.kept_stiffness * s.motion.energy();
    const bool rough = changed.largest * static_cast<double>(s.system.grid().nodes()) > kRoughSpring * motion;
    const bool fine = left > 1 || rough || s.motion.fine();
    const double allowed =
        fine ? solved.target : std::max(solved.target, (heap ? kRoughHeap : kRough) * motion);
    const bool done = report.brought_in <= 0 && error <= allowed && changed.struck <= kStruck;
    const bool last = left <= 1 - (stray && rough ? kSpareSearches : kSpareIterations);
    if (!last && (!done || let_go(particles) || hold_inside(particles, *forces.springs, allowed))) continue;
    if (!forces.layered) break;
    const bool meet = forces.layers != nullptr && hold_meeting(particles, *forces.layers);
    const bool enter =
        heap && heap_rounds++ < kHeapRounds && hold_inside(particles, *forces.springs, allowed);
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
  if (!memory_->contacts.hold_inside(contact->inside(particles, now, part), particles, now, s.move, bodies,
                                     springs.node_stiffness(), missed))
    return false;
  memory_->contacts.for_each_node([&](std::size_t node) { memory_->begin_anew(node); });
  begin_formula(s.h);
  return true;
}

template <class Real>
bool Implicit<Real>::hold_meeting(const Particles<Real>& particles, LayerContacts<Real>& layers) {
  State& s = *state_;
  if (!layers.hold_meeting(kernels::components(particles.position), s.move)) return false;
  layers.for_each_node([&](std::size_t node) { memory_->begin_anew(node); });
  begin_formula(s.h);
  return true;
}

template <class Real>
void Implicit<Real>::scale_change(double share) {
  State& s = *state_;
  for (Real* component : {s.change.x, s.change.y, s.change.z}) {
    std::transform(component, component + s.system.grid().size(), component,
                   [part = static_cast<Real>(share)](Real x) { return part * x; });
  }
  s.system.bodies().scale_changes(share);
}

template <class Real>
auto Implicit<Real>::whole_change(const Forces<Real>& forces, double decrease) -> ChangeReport {
  State& s = *state_;
  s.one_sided.clear();
  if (!memory_->contacts.empty())
    memory_->contacts.append_springs(s.move, s.change, s.system.bodies(), s.one_sided);
  if (forces.layers != nullptr) forces.layers->append_springs(s.move, s.change, s.one_sided);
  double share = s.one_sided.empty() ? 1 : best_share(s.one_sided, decrease);
  if (share < 1) scale_change(share);
  for (;;) {
    const double left_over = (1 - share) * (1 - share) * decrease;
    const ChangeReport report = model_change(forces, decrease - left_over);
    if (!report.wild || share < kSmallestShare)
      return {report.brought_in, std::max(report.error, left_over), report.largest, report.struck};
    scale_change(0.5);
    share /= 2;
  }
}

template <class Real>
auto Implicit<Real>::model_change(const Forces<Real>& forces, double decrease) const -> ChangeReport {
  kernels::SpringModelError error =
      forces.springs->model_error(state_->system.grid(), state_->position, state_->change);
  if (forces.gas != nullptr) {
    const double gas = forces.gas->model_error(state_->position, state_->change);
    error.sum += gas;
    error.magnitude += std::abs(gas);
  }
  const double rounding = double(std::numeric_limits<Real>::epsilon()) *
                          (kRounding * error.magnitude + kSolveRounding * decrease);
  return {.brought_in = error.sum - decrease + rounding,
          .error = error.magnitude,
          .largest = error.largest,
          .struck = error.struck,
          .wild = error.sum - decrease > kWild * decrease &&
                  error.sum > kWildStrain * kWildStrain * state_->stretched_to_twice + rounding};
}

template <class Real>
auto Implicit<Real>::searched_change(const Forces<Real>& forces, double decrease) -> ChangeReport {
  const kernels::Components<Real> change = state_->change;
  for (double share = 1; share > kSmallestShare; share /= 2) {
    // A share of the change has share (2 - share) of the decrease.
    const ChangeReport report = model_change(forces, share * (2 - share) * decrease);
    if (report.brought_in <= 0) return report;
    scale_change(0.5);
  }
  clear(change, state_->system.grid().size());
  state_->system.bodies().scale_changes(0);
  return {.taken = false};
}

template auto Implicit<float>::iterate(Particles<float>&, const Forces<float>&, Change) -> NewtonReport;
template bool Implicit<float>::let_go(const Particles<float>&);
template bool Implicit<float>::hold_inside(const Particles<float>&, const Springs<float>&, double);
template bool Implicit<float>::hold_meeting(const Particles<float>&, LayerContacts<float>&);
template void Implicit<float>::scale_change(double);
template auto Implicit<float>::whole_change(const Forces<float>&, double) -> ChangeReport;
template auto Implicit<float>::model_change(const Forces<float>&, double) const -> ChangeReport;
template auto Implicit<float>::searched_change(const Forces<float>&, double) -> ChangeReport;
template auto Implicit<double>::iterate(Particles<double>&, const Forces<double>&, Change) -> NewtonReport;
template bool Implicit<double>::let_go(const Particles<double>&);
template bool Implicit<double>::hold_inside(const Particles<double>&, const Springs<double>&, double);
template bool Implicit<double>::hold_meeting(const Particles<double>&, LayerContacts<double>&);
template void Implicit<double>::scale_change(double);
template auto Implicit<double>::whole_change(const Forces<double>&, double) -> ChangeReport;
template auto Implicit<double>::model_change(const Forces<double>&, double) const -> ChangeReport;
template auto Implicit<double>::searched_change(const Forces<double>&, double) -> ChangeReport;

}  // namespace weft
