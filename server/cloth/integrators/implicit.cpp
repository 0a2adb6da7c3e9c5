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
  Step step;
  step.method = this;
  step.particles = &particles;
  step.forces = forces;
  step.contact = contact;
  step.solids = &solids;
  advance_together({&step, 1}, time, dt);
  return step.report;
}

template <class Real>
void Implicit<Real>::advance_together(std::span<Step> steps, double time, double dt) {
  int substeps = 0;
  for (Step& step : steps) {
    step.forces.context.time = time;
    substeps = std::max(substeps, step.method->substeps_of(step, dt));
  }
  for (Step& step : steps) {
    step.report.substeps = substeps;
    step.method->begin_step(step, dt);
  }
  LayerContacts<Real>* layers = steps[0].forces.layers;
  for (int substep = 0; substep < substeps; ++substep) {
    const Substep part = Substep::of(substep, substeps, dt);
    const auto begin = Clock::now();
    for (Step& step : steps) {
      step.part = part;
      step.method->meet_solids(step, time, dt);
    }
    if (layers != nullptr) {
      std::vector<const Particles<Real>*> starts;
      starts.reserve(steps.size());
      bool near_rest = true;
      for (const Step& step : steps) {
        starts.push_back(step.particles);
        near_rest = near_rest && step.method->state_->motion.near_rest();
      }
      layers->begin(starts, part, near_rest);
    }
    for (Step& step : steps) step.method->begin_substep(step);
    find_moves(steps);
    const double taken = seconds(Clock::now() - begin);
    for (Step& step : steps) step.report.forces_seconds += taken / static_cast<double>(steps.size());
    if (layers != nullptr) layers->finish(moves_of(steps));
    for (Step& step : steps) step.method->settle_substep(step);
    keep_momentum(steps);
    for (Step& step : steps) step.method->end_substep(step);
  }
  for (Step& step : steps) step.method->end_step(step, dt);
}

template <class Real>
int Implicit<Real>::substeps_of(const Step& step, double dt) {
  const double asked = dt / parameters_.substeps;
  int parts = step.forces.rescued ? 1 : parts_in_strong_air(*step.particles, step.forces, asked);
  if (step.contact != nullptr) {
    const Vec2& size = step.forces.context.cloth->size;
    const Grid& grid = step.particles->grid();
    const double cell = std::min(size.x() / (grid.cols - 1), size.y() / (grid.rows - 1));
    const VectorField<Real>* velocity = &step.particles->velocity;
    if (step.forces.any_slow() && any_with_an_end(*step.solids)) {
      find_velocity_in_air(*step.particles, step.forces, dt, in_air_);
      velocity = &in_air_;
    }
    parts = std::max(parts, parts_beside_fast_solids(*step.particles, *velocity, *step.contact, *step.solids,
                                                     cell, asked, dt));
  }
  return parameters_.substeps * parts;
}

template <class Real>
void Implicit<Real>::begin_step(Step& step, double dt) {
  const Particles<Real>& particles = *step.particles;
  Forces<Real>& forces = step.forces;
  const double h = dt / step.report.substeps;
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
  state_->sound = true;
  body_energy_.begin(particles, forces, *step.solids, dt);
  memory_->ledger.begin_step(particles, forces, memory_->formula.lead() != nullptr ? h / 2 : 0);
  step.unpushed = freedom_of(particles);
  step.freedom = step.unpushed;
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
void Implicit<Real>::begin_substep(Step& step) {
  const Particles<Real>& particles = *step.particles;
  const Forces<Real>& forces = step.forces;
  State& s = *state_;
  s.h = step.part.seconds;
  StepFormula<Real>& formula = memory_->formula;
  formula.begin_substep(particles);
  const auto break_motion = [&](std::size_t node) { formula.break_motion(node); };
  memory_->contacts.for_each_broken(break_motion);
  if (forces.layers != nullptr) forces.layers->for_each_node(forces.part, break_motion);
  formula.prepare();
  const bool solids = !memory_->contacts.empty();
  const bool touched = solids || memory_->contacts.hangs() ||
                       (forces.layers != nullptr && !forces.layers->empty()) ||
                       forces.sheet->torn() != nullptr;
  // A weight on the cloth pulls as many times harder, and what bends the threads that it hangs on turns as
  // much of that pull aside: solved for the cloth's own motion alone, it would swing itself up.
  const double share = memory_->contacts.hung_share(total_mass(particles), *step.solids);
  s.target = s.motion.target(parameters_.tolerance * (touched ? kTouched : 1) * share * share, solids);
  if (memory_->contacts.hangs() && !hung_) {
    memory_->momentum.restart();
  } else {
    memory_->momentum.begin_substep(particles, forces, *step.solids, hung_);
  }
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
  for (const auto& effect : *forces.effects)
    effect->add_stiffness(particles, forces.context, finest.diagonal());
  s.system.couplings().clear();
  if (!memory_->contacts.empty() || memory_->contacts.hangs()) {
    memory_->contacts.add_to(finest.matrix.blocks, s.system.couplings(), s.b, s.system.bodies(),
                             finest.diagonal(), forces.sheet->springs().node_stiffness(), s.piece_mass,
                             s.move);
  }
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
void Implicit<Real>::keep_momentum(std::span<Step> steps) {
  std::vector<typename MomentumKeeper<Real>::Member> members;
  members.reserve(steps.size());
  for (Step& step : steps) {
    Memory& memory = *step.method->memory_;
    members.push_back({&memory.momentum, step.particles, &step.forces, step.solids, &memory.formula.start(),
                       step.contact, &step.now, step.rubs, memory.formula.by_bdf2(), step.part.to,
                       step.hung_torque});
  }
  const double kept = MomentumKeeper<Real>::end_substep(members, steps[0].part.seconds);
  if (kept != 1) steps[0].method->memory_->formula.scale(*steps[0].particles, kept, steps[0].now);
}

template <class Real>
void Implicit<Real>::end_substep(Step& step) {
  const ContactConstraints<Real>& contacts = memory_->contacts;
  StepFormula<Real>& formula = memory_->formula;
  if (step.report.nodes_in_contact > 0 || !contacts.empty()) {
    step.touched = true;
    step.freedom = step.now;
  }
  formula.end_substep(*step.particles);
  if (step.contact == nullptr || !second_order_) return;
  for (const Touch& touch : step.contact->touches()) {
    if (contacts.goes_on(touch)) continue;
    ClothPoint<Real>(touch.point(), *step.particles).for_each_node([&](std::size_t node, double) {
      formula.begin_anew(node);
    });
  }
}

template <class Real>
void Implicit<Real>::end_step(Step& step, double dt) {
  Particles<Real>& particles = *step.particles;
  AdvanceReport& report = step.report;
  const double scale =
      memory_->ledger.end_step(particles, step.forces, dt, step.touched, step.freedom, report);
  // As a whole: the next substep would take a change of the velocity alone for an acceleration that goes on.
  if (scale != 1) memory_->formula.scale(particles, scale, step.freedom);
  report.sound = state_->sound;
  if (step.touched) body_energy_.judge(particles, step.forces, *step.solids, report);
}

template class Implicit<float>;
template class Implicit<double>;

}  // namespace weft
