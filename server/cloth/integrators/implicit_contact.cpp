/// Implicit's contact: what a substep meets, holds and lets go of in its iterations, and puts right after
/// them.
#include "cloth/core/clock.h"
#include "cloth/integrators/implicit.h"
#include "cloth/kernels/node_vector.h"
#include "cloth/sheet/diagnostics.h"
#include "cloth/sheet/motion.h"

namespace weft {

template <class Real>
void Implicit<Real>::meet_solids(Step& step, double time, double dt) {
  Particles<Real>& particles = *step.particles;
  Forces<Real>& forces = step.forces;
  Contact<Real>* contact = step.contact;
  std::vector<Solid>& solids = *step.solids;
  const Substep& part = step.part;
  ContactConstraints<Real>& contacts = memory_->contacts;
  AttachedBodies<Real>& bodies = state_->system.bodies();
  state_->motion.measure(particles);
  if (contact != nullptr) {
    contacts.begin(contact->expect(particles, solids, part), contact->foresee(particles, solids, part),
                   particles, solids, part, state_->motion.near_rest(), bodies);
  } else {
    contacts.clear();
    bodies.clear();
  }
  surroundings_ = {contact, &solids, part};
  forces.context.time = time + part.to * dt;  // forces act as they are at the substep's end
  forces.carry_pins(particles, forces.context.time);
  hung_ = false;
  if (forces.soft_pins != nullptr && contact != nullptr) {
    const auto springs = forces.soft_pins->on_bodies(particles, solids, time, dt, part);
    contacts.hang(springs, particles, solids, bodies);
    hung_ = springs.size() == forces.soft_pins->count();
  }
  if (contact != nullptr && contact->body_touches() != nullptr)
    contacts.join(*contact->body_touches(), solids, bodies);
}

template <class Real>
auto Implicit<Real>::contact_error() -> ContactError {
  State& s = *state_;
  ContactError error;
  if (!memory_->contacts.empty()) {
    const auto misjudged = memory_->contacts.error(s.move, s.system.bodies());
    error.all = misjudged.all;
    error.begun = misjudged.begun;
    error.pulling = memory_->contacts.release_pulling(s.move, s.system.bodies());
  }
  error.pulling += s.system.bodies().misjudged();
  return error;
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
bool Implicit<Real>::hold_meeting(std::span<Step> steps) {
  std::vector<kernels::Components<const Real>> positions;
  positions.reserve(steps.size());
  for (const Step& step : steps)
    positions.push_back(kernels::components(std::as_const(step.particles->position)));
  LayerContacts<Real>& layers = *steps[0].forces.layers;
  if (!layers.hold_meeting(positions, moves_of(steps))) return false;
  for (const Step& step : steps) {
    StepFormula<Real>& formula = step.method->memory_->formula;
    layers.for_each_node(step.forces.part, [&](std::size_t node) { formula.break_motion(node); });
    formula.prepare();
  }
  return true;
}

template <class Real>
bool Implicit<Real>::resolve_contact(Step& step) {
  State& s = *state_;
  Particles<Real>& particles = *step.particles;
  Contact<Real>& contact = *step.contact;
  ContactConstraints<Real>& contacts = memory_->contacts;
  EnergyLedger<Real>& ledger = memory_->ledger;
  const StepFormula<Real>& formula = memory_->formula;
  const bool held_up = contacts.joins() && contacts.add_impulses(s.system.bodies(), *contact.body_touches());
  const auto& pressed = contacts.finish(s.move, s.system.bodies(), *step.solids);
  contacts.keep_velocities(kernels::components(particles.velocity));
  contact.let_slide_off(contacts.not_held());
  contact.trust(contacts.kept_aside());
  double before = 0;
  if (ledger.counts()) {
    before = motion_energy(particles, Freedom::none()).inner;
    ledger.count_contact(contacts.work(s.move,
                                       {kernels::components(formula.start_velocity()),
                                        kernels::components(std::as_const(particles.velocity)),
                                        formula.lead() != nullptr ? formula.lead()->row(0) : nullptr},
                                       s.system.bodies()));
  }
  step.report.nodes_in_contact = contact.resolve(particles, *step.solids, step.part, &formula.start());
  if (ledger.counts()) ledger.count_contact({before - motion_energy(particles, Freedom::none()).inner, 0});
  step.report.nodes_in_contact += contact.keep(pressed);
  return held_up;
}

template <class Real>
void Implicit<Real>::settle_substep(Step& step) {
  Particles<Real>& particles = *step.particles;
  const Forces<Real>& forces = step.forces;
  const ContactConstraints<Real>& contacts = memory_->contacts;
  const StepFormula<Real>& formula = memory_->formula;
  step.rubs = false;
  if (step.contact != nullptr) {
    const auto begin = Clock::now();
    step.rubs = resolve_contact(step);
    step.report.contact_seconds += seconds(Clock::now() - begin);
  }
  forces.join(particles);
  if (forces.sheet->damped()) find_way(forces);  // with what the last iteration has added
  memory_->ledger.count_work(
      particles, forces,
      {formula.start(), formula.start_velocity(), forces.sheet->damped() ? &state_->way : nullptr,
       formula.lead(), step.part.seconds});
  step.hung_torque =
      contacts.torque_beside_centres(state_->move, particles, *step.solids, state_->system.bodies());
  step.now = step.unpushed;
  if (step.contact != nullptr && !step.unpushed.is_none()) {
    const auto firm = contacts.firm(step.contact->touches(), particles, *step.solids);
    step.rubs = step.rubs || firm.rubs;
    step.now = step.rubs ? Freedom::none() : freedom_beside(firm.pushes, particles);
  }
}

template void Implicit<float>::meet_solids(Step&, double, double);
template auto Implicit<float>::contact_error() -> ContactError;
template bool Implicit<float>::let_go(const Particles<float>&);
template bool Implicit<float>::hold_inside(const Particles<float>&, const Springs<float>&, double);
template bool Implicit<float>::hold_meeting(std::span<Step>);
template bool Implicit<float>::resolve_contact(Step&);
template void Implicit<float>::settle_substep(Step&);
template void Implicit<double>::meet_solids(Step&, double, double);
template auto Implicit<double>::contact_error() -> ContactError;
template bool Implicit<double>::let_go(const Particles<double>&);
template bool Implicit<double>::hold_inside(const Particles<double>&, const Springs<double>&, double);
template bool Implicit<double>::hold_meeting(std::span<Step>);
template bool Implicit<double>::resolve_contact(Step&);
template void Implicit<double>::settle_substep(Step&);

}  // namespace weft
