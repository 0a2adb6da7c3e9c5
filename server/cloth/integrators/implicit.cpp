#include "cloth/integrators/implicit.h"

#include <algorithm>
#include <utility>

#include "cloth/core/clock.h"
#include "cloth/integrators/fast_solids.h"
#include "cloth/integrators/strong_air.h"
#include "cloth/kernels/node_vector.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/motion.h"
#include "cloth/sheet/tear/pieces.h"

namespace weft {
namespace {

/// Share of the tolerance for cloth that something touches, and torn cloth: what a solve takes there from the
/// motion along a surface the ledger gives back to all of the motion, or nobody does.
constexpr double kTouched = 0.2;

template <class Real>
bool needs_blocks(const Forces<Real>& forces) {
  return std::any_of(forces.effects->begin(), forces.effects->end(),
                     [](const auto& effect) { return effect->needs_blocks(); });
}

}  // namespace

template <class Real>
Implicit<Real>::State::State(const Grid& grid, const Sheet<Real>& sheet, bool sewn)
    : system(grid, sheet.springs().has_bending(), sheet.plate(), sewn),
      solver(grid),
      vectors(grid, 12),
      force(grid),
      position(vectors.vector(0)),
      b(vectors.vector(3)),
      change(vectors.vector(6)),
      move(vectors.vector(9)) {}

template <class Real>
AdvanceReport Implicit<Real>::advance(Particles<Real>& particles, Forces<Real> forces, Contact<Real>* contact,
                                      std::vector<Solid>& solids, double time, double dt) {
  AdvanceReport report;
  report.substeps = parameters_.substeps;
  forces.context.time = time;
  const double asked = dt / parameters_.substeps;
  int parts = forces.rescued ? 1 : parts_in_strong_air(particles, forces, asked);
  if (contact != nullptr)
    parts = std::max(parts, parts_beside_fast_solids(particles, *contact, solids, asked, dt));
  report.substeps *= parts;
  const double h = dt / report.substeps;
  begin_step(particles, forces, h);
  state_->sound = true;
  StepFormula<Real>& formula = memory_->formula;
  body_energy_.begin(particles, forces, solids);
  memory_->ledger.begin_step(particles, forces, formula.lead() != nullptr ? h / 2 : 0);
  ContactConstraints<Real>& contacts = memory_->contacts;
  const Freedom unpushed = freedom_of(particles);
  Freedom freedom = unpushed;  // what the last substep in which something touched it left the cloth
  bool touched = false;
  for (int substep = 0; substep < report.substeps; ++substep) {
    const Substep part = Substep::of(substep, report.substeps, dt);
    const auto begin = Clock::now();
    state_->motion.measure(particles);
    if (contact != nullptr) {
      contacts.begin(contact->expect(particles, solids, part), contact->foresee(particles, solids, part),
                     particles, solids, part, state_->motion.near_rest(), state_->system.bodies());
    } else {
      contacts.clear();
      state_->system.bodies().clear();
    }
    surroundings_ = {contact, &solids, part};
    forces.context.time = time + part.to * dt;  // forces act as they are at the substep's end
    forces.context.step = h;
    forces.carry_pins(particles, forces.context.time);
    bool hung = false;  // all that soft pins hold is bodies
    if (forces.soft_pins != nullptr && contact != nullptr) {
      const auto springs = forces.soft_pins->on_bodies(particles, solids, time, dt, part);
      contacts.hang(springs, particles, solids, state_->system.bodies());
      hung = springs.size() == forces.soft_pins->count();
    }
    if (contact != nullptr && contact->body_touches() != nullptr)
      contacts.join(*contact->body_touches(), solids, state_->system.bodies());
    if (forces.layers != nullptr) forces.layers->begin(particles, part, state_->motion.near_rest());
    begin_substep(particles, forces, h);
    if (contacts.hangs() && !hung) {
      memory_->momentum.restart();
    } else {
      memory_->momentum.begin_substep(particles, forces, solids, hung);
    }
    report.linear_iterations += find_move(particles, forces, h);
    bool held_up = false;  // what the cloth touches is pushed by what stands firm, which takes momentum
    const auto moved = Clock::now();
    report.forces_seconds += seconds(moved - begin);
    if (forces.layers != nullptr) forces.layers->finish(state_->move);
    if (contact != nullptr) {
      held_up = contacts.joins() && contacts.add_impulses(state_->system.bodies(), *contact->body_touches());
      const auto& pressed = contacts.finish(state_->move, state_->system.bodies(), solids);
      contacts.keep_velocities(kernels::components(particles.velocity));
      contact->let_slide_off(contacts.not_held());
      contact->trust(contacts.kept_aside());
      resolve_contact(particles, *contact, solids, part, report);
      report.nodes_in_contact += contact->keep(pressed);
      report.contact_seconds += seconds(Clock::now() - moved);
    }
    forces.join(particles);
    if (forces.sheet->damped()) find_way(forces);  // with what the last iteration has added
    memory_->ledger.count_work(particles, forces,
                               {formula.start(), formula.start_velocity(),
                                forces.sheet->damped() ? &state_->way : nullptr, formula.lead(), h});
    Freedom now = unpushed;
    bool rubs = held_up;
    if (contact != nullptr && !unpushed.is_none()) {
      const auto firm = contacts.firm(contact->touches(), particles, solids);
      rubs = rubs || firm.rubs;
      now = rubs ? Freedom::none() : freedom_beside(firm.pushes, particles);
    }
    const double kept = memory_->momentum.end_substep(particles, forces, solids, formula.start(), contact,
                                                      now, rubs, formula.by_bdf2(), h);
    if (kept != 1) formula.scale(particles, kept, now);
    if (report.nodes_in_contact > 0 || !contacts.empty()) {
      touched = true;
      freedom = now;
    }
    end_substep(particles, contact);
  }
  const double scale = memory_->ledger.end_step(particles, forces, dt, touched, freedom, report);
  // As a whole: the next substep would take a change of the velocity alone for an acceleration that goes on.
  if (scale != 1) formula.scale(particles, scale, freedom);
  report.sound = state_->sound;
  if (touched) body_energy_.judge(particles, forces, solids, report);
  return report;
}

template <class Real>
void Implicit<Real>::begin_step(const Particles<Real>& particles, Forces<Real>& forces, double h) {
  const Grid& grid = particles.grid();
  if (!state_ || state_->system.grid() != grid) {
    state_.emplace(grid, *forces.sheet, forces.bag != nullptr);
    if (forces.sheet->damped()) state_->way = VectorField<Real>(grid);
  }
  if (!memory_ || memory_->formula.grid() != grid) memory_.emplace(grid, parameters_, second_order_);
  memory_->formula.begin_step(particles, h);
  const bool tore = state_->soft && state_->soft->torn() != forces.sheet->torn();
  if (state_->h != h || tore) measure_sheet(*forces.sheet, *forces.context.cloth, particles.mass, h);
  if (state_->torn != forces.sheet->torn()) {
    state_->torn = forces.sheet->torn();
    state_->piece_mass = state_->torn ? piece_masses(*state_->torn, particles) : std::vector<double>();
  }
  if (state_->soft) forces.sheet = &*state_->soft;
  if (!forces.holds_gas()) state_->system.set_rank_one(0, {});
  Real* free = state_->system.finest().free();
  const Real* inverse_mass = particles.inverse_mass.row(0);
  const kernels::Components<Real> correction = memory_->correction.vector();
  for (std::size_t i = 0; i < grid.size(); ++i) {
    free[i] = inverse_mass[i] > Real(0) ? Real(1) : Real(0);
    for (Real* component : {correction.x, correction.y, correction.z}) component[i] *= free[i];
  }
}

template <class Real>
void Implicit<Real>::measure_sheet(const Sheet<Real>& sheet, const ClothDescription& cloth,
                                   const Field<Real>& mass, double h) {
  State& s = *state_;
  s.h = h;
  const Springs<Real>& springs = sheet.springs();
  s.soft.reset();
  s.kept_stiffness = 1;
  if (const auto soft = softened_springs(springs, cloth, mass, h)) {
    s.soft = sheet.with(*soft);
    s.kept_stiffness = soft->max_squared_frequency(mass) / springs.max_squared_frequency(mass);
  }
  s.stretched_to_twice = (s.soft ? s.soft->springs() : springs).energy_at_twice(mass.grid());
  s.motion = MotionScale<Real>(springs, mass, h);
}

template <class Real>
void Implicit<Real>::begin_substep(const Particles<Real>& particles, const Forces<Real>& forces, double h) {
  State& s = *state_;
  s.h = h;
  StepFormula<Real>& formula = memory_->formula;
  formula.begin_substep(particles);
  const auto break_motion = [&](std::size_t node) { formula.break_motion(node); };
  memory_->contacts.for_each_broken(break_motion);
  if (forces.layers != nullptr) forces.layers->for_each_node(break_motion);
  formula.prepare();
  const bool solids = !memory_->contacts.empty();
  const bool touched = solids || memory_->contacts.hangs() ||
                       (forces.layers != nullptr && !forces.layers->empty()) ||
                       forces.sheet->torn() != nullptr;
  // A weight on the cloth pulls as many times harder, and what bends the threads that it hangs on turns as
  // much of that pull aside: solved for the cloth's own motion alone, it would swing itself up.
  const double share = memory_->contacts.hung_share(total_mass(particles), *surroundings_.solids);
  s.target = s.motion.target(parameters_.tolerance * (touched ? kTouched : 1) * share * share, solids);
}

template <class Real>
void Implicit<Real>::assemble(const Particles<Real>& particles, const Forces<Real>& forces) {
  State& s = *state_;
  const Grid& grid = particles.grid();
  const std::size_t count = grid.size();
  auto& finest = s.system.finest();

  copy<Real>(kernels::components(particles.position), s.position, count);
  forces.sheet->linearise(grid, s.position, finest.matrix.links, s.h);
  forces.sum(particles, s.force);
  if (forces.sheet->damped()) add_damping(particles, forces);
  if (forces.bag != nullptr) forces.bag->linearise(particles, forces.context.time, s.force, s.system);
  std::fill_n(finest.diagonal(), count, Real(0));
  const bool blocks = !memory_->contacts.empty() || needs_blocks(forces);
  finest.use_blocks(blocks);
  for (const auto& effect : *forces.effects) {
    effect->add_damping(particles, forces.context, {finest.diagonal(), finest.matrix.blocks});
  }

  const kernels::Iterate<Real> iterate{s.move, kernels::components(particles.velocity),
                                       kernels::components(s.force)};
  const kernels::BackwardStep<Real>& step = memory_->formula.coefficients();
  const Real* mass = particles.mass.row(0);
  if (blocks) {
    kernels::assemble_system<Real>(mass, finest.free(), step, iterate, finest.diagonal(),
                                   finest.matrix.blocks, s.b, count);
  } else {
    kernels::assemble_system<Real>(mass, finest.free(), step, iterate, finest.diagonal(), s.b, count);
  }
  s.system.couplings().clear();
  if (!memory_->contacts.empty() || memory_->contacts.hangs()) {
    memory_->contacts.add_to(finest.matrix.blocks, s.system.couplings(), s.b, s.system.bodies(),
                             finest.diagonal(), forces.sheet->springs().node_stiffness(), s.piece_mass,
                             s.move);
  }
  if (forces.layers != nullptr) {
    forces.layers->add_to(s.b, s.system.couplings(), finest.diagonal(), s.move);
  }
  if (forces.bag != nullptr) forces.bag->average(s.b);
  s.system.prepare();
}

template <class Real>
void Implicit<Real>::find_way(const Forces<Real>& forces) {
  State& s = *state_;
  const kernels::Components<Real> way = kernels::components(s.way);
  copy<Real>(s.move, way, s.system.grid().size());
  const double end = forces.context.time;
  forces.for_each_pin_way(end - s.h, end,
                          [&](std::size_t node, const Vec3& moved) { add<Real>(way, node, moved); });
}

template <class Real>
void Implicit<Real>::add_damping(const Particles<Real>& particles, const Forces<Real>& forces) {
  find_way(forces);
  forces.sheet->add_damping_of_way(particles.position, kernels::components(state_->way), state_->h,
                                   state_->force);
}

template <class Real>
void Implicit<Real>::resolve_contact(Particles<Real>& particles, Contact<Real>& contact,
                                     std::vector<Solid>& solids, const Substep& part, AdvanceReport& report) {
  State& s = *state_;
  EnergyLedger<Real>& ledger = memory_->ledger;
  const StepFormula<Real>& formula = memory_->formula;
  double before = 0;
  if (ledger.counts()) {
    before = motion_energy(particles, Freedom::none()).inner;
    ledger.count_contact(
        memory_->contacts.work(s.move,
                               {kernels::components(formula.start_velocity()),
                                kernels::components(std::as_const(particles.velocity)),
                                formula.lead() != nullptr ? formula.lead()->row(0) : nullptr},
                               s.system.bodies()));
  }
  report.nodes_in_contact = contact.resolve(particles, solids, part, &formula.start());
  if (ledger.counts()) ledger.count_contact({before - motion_energy(particles, Freedom::none()).inner, 0});
}

template <class Real>
void Implicit<Real>::end_substep(Particles<Real>& particles, const Contact<Real>* contact) {
  memory_->formula.end_substep(particles);
  if (contact == nullptr || !second_order_) return;
  for (const Touch& touch : contact->touches()) {
    if (memory_->contacts.goes_on(touch)) continue;
    ClothPoint<Real>(touch.point(), particles).for_each_node([&](std::size_t node, double) {
      memory_->formula.begin_anew(node);
    });
  }
}

template class Implicit<float>;
template class Implicit<double>;

}  // namespace weft
