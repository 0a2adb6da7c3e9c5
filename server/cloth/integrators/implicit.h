#pragma once
#include <optional>

#include "cloth/contact/constraints/contact_constraints.h"
#include "cloth/integrators/energy_ledger.h"
#include "cloth/integrators/integrator.h"
#include "cloth/integrators/momentum_keeper.h"
#include "cloth/integrators/motion_scale.h"
#include "cloth/integrators/softened_springs.h"
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
/// What solves leave of the momentum of a cloth that nothing holds is given back (MomentumKeeper).
///
/// What formula and solves take from a cloth's energy is given back where nothing but wind drives it, and
/// what they give is taken (EnergyLedger).
///
/// BDF2 also needs the last substep's move and velocity. It keeps them itself and begins with one substep of
/// backward Euler, as it does again after restart() and, node by node, where contact begins or ends, which
/// breaks the smooth motion that the formula extrapolates. Where contact with firm solids lasts it goes on.
template <class Real>
class Implicit final : public Integrator<Real> {
 public:
  Implicit(const char* name, const ImplicitParameters& parameters, bool second_order)
      : name_(name), parameters_(parameters), second_order_(second_order) {}
  const char* name() const override { return name_; }
  AdvanceReport advance(Particles<Real>& particles, Forces<Real> forces, Contact<Real>* contact,
                        std::vector<Solid>& solids, double time, double dt) override;
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
      if (remembers) memory_.emplace(Grid{}, parameters_);
    }
    if (memory_) archive(*memory_);
  }

 private:
  /// What a substep leaves to the next one.
  struct Memory {
    Memory(const Grid& grid, const ImplicitParameters& parameters)
        : second_order(grid),
          last_move(grid),
          last_velocity(grid),
          correction(grid, 3),
          ledger(parameters.liveliness) {}

    Field<Real> second_order;  ///< 1 where the last substep's move and velocity may be used, else 0
    VectorField<Real> last_move, last_velocity;
    NodeArrays<Real> correction;  ///< of the last substep's guess by its first solve, m
    double h = 0;                 ///< s, of the last substep
    ContactConstraints<Real> contacts;
    EnergyLedger<Real> ledger;
    MomentumKeeper<Real> momentum;

    /// The node's next substep is one of backward Euler.
    template <class Archive>
    void serialize(Archive& archive) {
      archive(second_order, last_move, last_velocity, correction, h, contacts, ledger, momentum);
    }

    void begin_anew(std::size_t node) { second_order.row(0)[node] = Real(0); }
  };
  /// All else that lives on one grid.
  struct State {
    State(const Grid& grid, const Sheet<Real>& sheet, bool sewn);

    Multigrid<Real> system;
    ConjugateGradients<Real> solver;
    NodeArrays<Real> numbers, vectors;
    VectorField<Real> start, start_velocity, force;
    /// By how many seconds places run ahead of speeds (EnergyLedger): of backward Euler, unless a node is
    /// held.
    std::optional<Field<Real>> lead;
    VectorField<Real> way;  ///< of nodes and moving pins in the substep, m; empty where the sheet is undamped
    kernels::BackwardStep<Real> step;
    kernels::Components<Real> position;  ///< of the iterate, with margins
    kernels::Components<Real> b, change, move;
    std::vector<OneSidedSpring> one_sided;  ///< those of a change
    double h = 0;                           ///< s, of the last step's substeps
    std::optional<Sheet<Real>> soft;        ///< in place of the cloth's, where that is too stiff for h
    /// Share of their stiffness that softened springs keep. They are allowed that share of the error: they
    /// would stretch by as much more than the cloth's with the same energy.
    double kept_stiffness = 1;
    std::shared_ptr<const TornLinks> torn;  ///< what `piece_mass` is of; nullptr while it is whole
    std::vector<double> piece_mass;         ///< piece_masses; empty while it is whole
    double stretched_to_twice = 0;          ///< J, that all springs hold at their double length
    MotionScale<Real> motion;               ///< as the substep begins
    SolveTarget target;                     ///< of the substep's solves
    bool smooth = true;                     ///< the substep was not taken back
    bool sound = true;                      ///< a move was found in every substep of the step
  };

  void begin_step(const Particles<Real>& particles, Forces<Real>& forces, double h);
  /// Lays out what depends on the springs for substeps of h seconds.
  void measure_sheet(const Sheet<Real>& sheet, const ClothDescription& cloth, const Field<Real>& mass,
                     double h);
  void begin_substep(const Particles<Real>& particles, const Forces<Real>& forces, double h);
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
  struct ChangeReport {
    double brought_in = 0;  ///< energy, J
    /// How far the springs' and the gas's linearisation is off, or what is left to gain, J.
    double error = 0;
    double largest = 0;  ///< of that, in one spring, J
    double struck = 0;   ///< SpringModelError's
    bool taken = true;   ///< not dropped
    bool wild = false;   ///< brings in far more than was to be gained
  };
  /// Makes of the system's solution, which gains `decrease`, J, by the linearisation, the change to take.
  using Change = ChangeReport (Implicit::*)(const Forces<Real>& forces, double decrease);

  /// Takes the particles from the substep's start to its end. Returns the linear iterations.
  int find_move(Particles<Real>& particles, const Forces<Real>& forces, double h);
  void begin_formula(double h);
  void guess_move(double h);
  NewtonReport iterate(Particles<Real>& particles, const Forces<Real>& forces, Change change);
  /// Contact broke the node's motion in this substep: it goes by backward Euler, without a past.
  void break_motion(std::size_t node) {
    memory_->begin_anew(node);
    if (state_->lead) state_->lead->row(0)[node] = Real(0);
  }
  /// Lets go of nodes that the iteration has drawn off the side of a solid; true if there are any.
  bool let_go(const Particles<Real>& particles);
  /// Holds nodes that the iteration has put into a solid; true if there are more of them than were held.
  bool hold_inside(const Particles<Real>& particles, const Springs<Real>& springs, double missed);
  /// Holds what this iteration would have pass through each other; true if there is any.
  bool hold_meeting(const Particles<Real>& particles, LayerContacts<Real>& layers);
  /// Less than the whole where contacts come in its way, or where it is wild.
  ChangeReport whole_change(const Forces<Real>& forces, double decrease);
  ChangeReport searched_change(const Forces<Real>& forces, double decrease);
  /// Of the change as it is.
  ChangeReport model_change(const Forces<Real>& forces, double decrease) const;
  void scale_change(double share);
  /// Puts right what the solve has left of contact, and tells the ledger what contact took.
  void resolve_contact(Particles<Real>& particles, Contact<Real>& contact, std::vector<Solid>& solids,
                       const Substep& part, AdvanceReport& report);
  void end_substep(Particles<Real>& particles, const Contact<Real>* contact, double h);

  const char* name_;
  ImplicitParameters parameters_;
  bool second_order_;
  std::optional<State> state_;
  std::optional<Memory> memory_;
  struct Surroundings {
    Contact<Real>* contact = nullptr;  ///< or none
    const std::vector<Solid>* solids = nullptr;
    Substep substep;
  };
  Surroundings surroundings_;  ///< in the substep in hand
};

extern template class Implicit<float>;
extern template class Implicit<double>;

}  // namespace weft
