#pragma once
#include <optional>
#include <span>

#include "cloth/contact/constraints/contact_constraints.h"
#include "cloth/integrators/body_energy.h"
#include "cloth/integrators/change_search.h"
#include "cloth/integrators/energy_ledger.h"
#include "cloth/integrators/integrator.h"
#include "cloth/integrators/momentum_keeper.h"
#include "cloth/integrators/motion_scale.h"
#include "cloth/integrators/softened_springs.h"
#include "cloth/integrators/step_formula.h"
#include "cloth/kernels/implicit_kernels.h"

namespace weft {

/// Backward Euler and BDF2 (Hairer and Wanner, Solving Ordinary Differential Equations II, 1996): the new
/// state is found from the forces that act in it, by Newton's method on the nodes' moves. Each iteration
/// linearises springs, effects and contacts and solves one system by multigrid conjugate gradients.
///
/// After it the springs' energy is compared with what the linearisation promised. Off by less than the error
/// allowed, no further iteration is made: a cloth near rest costs one. If it is off by as much as a good part
/// of the motion's energy, or in one spring by many nodes' part of it, if a spring is past a strain limit
/// that it was short of before, if a contact's constraint pulled, if nodes are inside a solid that none
/// holds, if only a share of the change was taken, as contacts that the system did not hold came in its way
/// (best_share), or if the step brings in energy, some further ones are made; if it still brings in energy,
/// the step is taken back and made again by backward Euler with a line search: each change is halved until it
/// brings in none (Nocedal and Wright, Numerical Optimization, 2006, chapter 3). Not searched at once, as a
/// halved change does not keep the momentum.
///
/// If that finds no change at all where one is due, or the system is not finite, the step is not sound.
///
/// Beside a solid that passes the cloth fast for its size a step has more substeps than described
/// (parts_beside_fast_solids).
///
/// Damped springs resist how much longer the substep makes them, by tau / h times their stiffness (backward
/// Euler's rate, with BDF2 too: it takes energy from any motion).
///
/// Cloths that lie on one another are stepped together: their systems are one that the contacts among them
/// couple, solved in the same iterations, and one share of its change is taken by all.
///
/// What solves leave of the momentum of a cloth that nothing holds is given back (MomentumKeeper).
///
/// What formula and solves take from a cloth's energy is given back where nothing but wind drives it, and
/// what they give is taken (EnergyLedger).
///
/// BDF2 also needs the last substep's move and velocity (StepFormula). It begins with one substep of backward
/// Euler, as it does again after restart() and, node by node, where contact begins or ends, which breaks the
/// smooth motion that the formula extrapolates. Where contact with firm solids lasts it goes on.
template <class Real>
class Implicit final : public Integrator<Real> {
 public:
  Implicit(const char* name, const ImplicitParameters& parameters, bool second_order)
      : name_(name), parameters_(parameters), second_order_(second_order) {}
  const char* name() const override { return name_; }
  /// One cloth's step, as Integrator::advance has it.
  struct Step {
    Implicit* method = nullptr;
    Particles<Real>* particles = nullptr;
    Forces<Real> forces;  ///< `layers` are the same of all that are stepped together
    Contact<Real>* contact = nullptr;
    std::vector<Solid>* solids = nullptr;
    AdvanceReport report;

    // While it is made:
    Substep part;
    Freedom unpushed = Freedom::none(), freedom = Freedom::none();  ///< `freedom`: as its last touch left it
    bool touched = false;
    bool rubs = false;  ///< in the substep: something firm takes its momentum
    Freedom now = Freedom::none();
    Vec3 hung_torque{0, 0, 0};  ///< in the substep (ContactConstraints::torque_beside_centres), N m
  };
  AdvanceReport advance(Particles<Real>& particles, Forces<Real> forces, Contact<Real>* contact,
                        std::vector<Solid>& solids, double time, double dt) override;
  /// The steps of cloths that touch one another; they are the parts of their layers, in order. Each takes as
  /// many substeps as the one that needs most.
  static void advance_together(std::span<Step> steps, double time, double dt);
  Implicit* implicit() override { return this; }
  void restart() override {
    state_.reset();
    memory_.reset();
  }
  void stiffness_changed() override { state_.reset(); }
  void torn() override {
    if (memory_) memory_->contacts.forget_points_between();
  }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    bool remembers = memory_.has_value();
    archive(remembers);
    if (Archive::is_loading::value) {
      memory_.reset();
      if (remembers) memory_.emplace(Grid{}, parameters_, second_order_);
    }
    if (memory_) archive(*memory_);
  }

 private:
  /// What a substep leaves to the next one.
  struct Memory {
    Memory(const Grid& grid, const ImplicitParameters& parameters, bool by_second_order)
        : formula(grid, by_second_order), correction(grid, 3), ledger(parameters.liveliness) {}

    StepFormula<Real> formula;
    NodeArrays<Real> correction;  ///< of the last substep's guess by its first solve, m
    ContactConstraints<Real> contacts;
    EnergyLedger<Real> ledger;
    MomentumKeeper<Real> momentum;

    template <class Archive>
    void serialize(Archive& archive) {
      archive(formula, correction, contacts, ledger, momentum);
    }
  };
  /// All else that lives on one grid.
  struct State {
    State(const Grid& grid, const Sheet<Real>& sheet, bool sewn);

    Multigrid<Real> system;
    ConjugateGradients<Real> solver;
    NodeArrays<Real> vectors;
    VectorField<Real> force;
    VectorField<Real> way;  ///< of nodes and moving pins in the substep, m; empty where the sheet is undamped
    kernels::Components<Real> position;  ///< of the iterate, with margins
    kernels::Components<Real> b, change, move;
    double h = 0;                     ///< s, of the last step's substeps
    std::optional<Sheet<Real>> soft;  ///< in place of the cloth's, where that is too stiff for h
    /// Share of their stiffness that softened springs keep. They are allowed that share of the error: they
    /// would stretch by as much more than the cloth's with the same energy.
    double kept_stiffness = 1;
    std::shared_ptr<const TornLinks> torn;  ///< what `piece_mass` is of; nullptr while it is whole
    std::vector<double> piece_mass;         ///< piece_masses; empty while it is whole
    double stretched_to_twice = 0;          ///< J, that all springs hold at their double length
    MotionScale<Real> motion;               ///< as the substep begins
    SolveTarget target;                     ///< of the substep's solves, of this cloth's part
    bool sound = true;                      ///< a move was found in every substep of the step
  };

  /// As long as a step is, s, so many substeps it takes.
  int substeps_of(const Step& step, double dt);
  void begin_step(Step& step, double dt);
  /// Lays out what depends on the springs for substeps of h seconds.
  void measure_sheet(const Sheet<Real>& sheet, const ClothDescription& cloth, const Field<Real>& mass,
                     double h);
  /// Finds the solids that the cloth meets in the substep.
  void meet_solids(Step& step, double time, double dt);
  /// To be solved, with layers as the substep begins.
  void begin_substep(Step& step);
  /// Linearises at the particles' state and assembles the system for the change of the move.
  void assemble(const Particles<Real>& particles, const Forces<Real>& forces);
  /// What the sheet's dampers go by: the nodes' moves so far, and the ways of pins.
  void find_way(const Forces<Real>& forces);
  /// Adds the sheet's damping, by the nodes' moves so far, to the forces.
  void add_damping(const Particles<Real>& particles, const Forces<Real>& forces);
  struct NewtonReport {
    int linear_iterations = 0;
    double brought_in = 0;  ///< energy, J; below 0: given off
    bool found = false;     ///< some change was taken, or none was due
  };
  /// How much of each solve's change is taken (ChangeSearch).
  enum class Take { whole, searched };

  /// Takes the particles from the substep's start to its end.
  static void find_moves(std::span<Step> steps);
  /// Of the substep's solves.
  static SolveTarget target_of(std::span<Step> steps);
  void guess_move();
  static NewtonReport iterate(std::span<Step> steps, SolveTarget& target, Take take);
  static LinearSolveReport solve(std::span<Step> steps, const SolveTarget& target, bool corrected);
  static ChangeReport change(std::span<Step> steps, double decrease, bool searched);
  /// Takes the change of the iteration.
  void move(Particles<Real>& particles);
  /// What contact's linearisation was off by in the iteration, J.
  struct ContactError {
    double all = 0;      ///< of friction and forces
    double begun = 0;    ///< of that, of friction where contact begins
    double pulling = 0;  ///< of springs that were let go or taken back
  };
  ContactError contact_error();
  /// Lets go of nodes that the iteration has drawn off the side of a solid, or holds those that it has put
  /// into one; true if there are any.
  bool let_go(const Particles<Real>& particles);
  /// Holds nodes that the iteration has put into a solid; true if there are more of them than were held.
  bool hold_inside(const Particles<Real>& particles, const Springs<Real>& springs, double missed);
  /// Holds what this iteration would have pass through each other; true if there is any.
  static bool hold_meeting(std::span<Step> steps);
  /// Puts right what the solve has left of contact, and tells the ledger what contact took. True if what
  /// stands firm holds up what the cloth touches, which takes momentum.
  bool resolve_contact(Step& step);
  /// Contact and work, when the moves are found.
  void settle_substep(Step& step);
  static void keep_momentum(std::span<Step> steps);
  void end_substep(Step& step);
  void end_step(Step& step, double dt);
  /// The nodes' moves so far, m.
  static std::vector<kernels::Components<const Real>> moves_of(std::span<Step> steps);

  const char* name_;
  ImplicitParameters parameters_;
  bool second_order_;
  std::optional<State> state_;
  std::optional<Memory> memory_;
  VectorField<Real> in_air_;  ///< find_velocity_in_air of the step
  struct Surroundings {
    Contact<Real>* contact = nullptr;  ///< or none
    const std::vector<Solid>* solids = nullptr;
    Substep substep;
  };
  BodyEnergy<Real> body_energy_;
  Surroundings surroundings_;  ///< in the substep in hand
  bool hung_ = false;          ///< in it, all that soft pins hold is bodies
};

extern template class Implicit<float>;
extern template class Implicit<double>;

}  // namespace weft
