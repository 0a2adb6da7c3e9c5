#pragma once
#include <algorithm>
#include <optional>
#include <span>

#include "cloth/air/node_air.h"
#include "cloth/bodies/pinned_node.h"
#include "cloth/core/interrupt.h"
#include "cloth/forces/grab.h"
#include "cloth/forces/soft_pins.h"
#include "cloth/guard/step_guard.h"
#include "cloth/integrators/integrator.h"
#include "cloth/levels/settle.h"
#include "cloth/sheet/tear/walls.h"
#include "cloth/sleep/sleep.h"
#include "cloth/world/colliders.h"

namespace weft {

/// One cloth: its particles at their present level, and all that belongs to that level.
template <class Real>
class Cloth {
 public:
  /// `seed` makes the start's random offsets; `sleep_speed` as in SimulationDescription.
  Cloth(const ClothDescription& description, const std::vector<EffectDescription>& effects,
        const IntegratorDescription& integrator, std::uint64_t seed, double sleep_speed = 0);

  const ClothDescription& description() const { return description_; }
  int level() const { return level_; }
  const Particles<Real>& particles() const { return particles_; }
  /// Whoever writes to them wakes the cloth.
  Particles<Real>& particles() { return particles_; }
  const Sheet<Real>& sheet() const { return sheet_; }
  const Springs<Real>& springs() const { return sheet_.springs(); }
  /// nullptr where plates are not bent.
  const Plate<Real>* plate() const { return sheet_.plate(); }
  /// nullptr where the cloth is not sewn.
  const Seam<Real>* seam() const { return bag_ ? &bag_->seam() : nullptr; }
  /// nullptr where no gas is shut in.
  const Gas<Real>* gas() const { return bag_ ? bag_->gas() : nullptr; }
  /// J, of springs and plate.
  double elastic_energy() const { return sheet_.energy(particles_.position); }
  /// nullptr while the cloth is whole.
  const Walls* walls() const { return walls_ ? &*walls_ : nullptr; }
  double total_mass() const { return total_mass_; }  ///< kg; the same at every level
  ContactCounters contact_counters() const;

  /// Asks for a level, clamped to the cloth's own limits; it is reached before the next step.
  void request_level(int level);
  /// The one asked for, or where it is.
  int wanted_level() const { return pending_level_.value_or(level_); }
  int within_levels(int level) const {
    return std::clamp(level, description_.min_level, description_.max_level);
  }
  /// Splits or merges, one level at a time, to the requested level (Eqs. 8, 9); true if the level changed.
  /// The next step then settles the cloth first, if springs gained or nodes are in solids (settle.h),
  /// whatever integrator makes it.
  bool apply_pending_level();

  /// The next advance() is by `integrator`, which knows nothing of the steps before.
  void set_integrator(const IntegratorDescription& integrator);
  /// Is composed of these effects, as if made with them; what was added besides stays. The cloth wakes, and
  /// its integrator knows nothing of the steps before.
  void set_effects(const std::vector<EffectDescription>& effects);
  /// The same, of effects of the same types in the same order: its integrator goes on from the steps before,
  /// unless the springs are damped otherwise, of which it keeps copies.
  void tune_effects(const std::vector<EffectDescription>& effects);
  /// Is of this material, whose density is as before, from the next step on; its integrator goes on from the
  /// steps before. The cloth wakes, unless that is what it is made of. A stretched one that is made stiffer
  /// holds more energy, and moves.
  void set_material(const Material& material);
  /// A hand takes hold; the cloth wakes. Ids are the caller's and differ.
  void grab(const Grab& grab);
  /// False if there is no such grab.
  bool move_grab(GrabId id, const Vec3& hand);
  bool release(GrabId id);
  /// None unless something is held.
  const std::vector<Grab>& grabs() const;
  /// Holds what is at (u, v), and nodes around it as a pin of the description does, where it is now.
  void pin(const Vec2& at);
  /// Lets go of the pin that holds (u, v), or of the nearest one; false if there is none.
  bool unpin(const Vec2& at);
  /// All that its next step follows from but its effects (world/state.h). Read of a cloth of the same grids
  /// and limits of level, it is that cloth: by its integrator, with what has befallen it, material, pins and
  /// grabs. Gas is left out where nothing shuts it in, and begins to be poured in where only this one has it;
  /// tears stay whatever made them. What is laid out for the sheet stays where the sheet is the same.
  template <class Archive>
  void serialize(Archive& archive);
  /// The state that was read is of a cloth of other effects, by which it had another energy.
  bool of_other_effects(const Cloth& other) const {
    return composed_ != other.composed_ || gravity_ != other.gravity_ ||
           sheet_effects_ != other.sheet_effects_;
  }
  /// Takes hold and lets go of what pins begin and end to hold at `time`, s, when a step begins; the cloth
  /// wakes.
  void change_pins(double time);
  /// As the first step after a change of level begins: pinned nodes that came with a finer level are lifted
  /// out of these solids (lift_nodes.h), and held there.
  void lift_new_pins(const std::vector<Solid>& solids);
  void disturb() { disturbed_ = true; }
  /// Where layers of cloth touch, of which the cloth is a part; kept by the caller. nullptr: nobody looks.
  void set_layers(LayerContacts<Real>* layers, std::size_t part) {
    layers_ = layers;
    layer_part_ = part;
    if (layers == nullptr) sleep_.set_company(Sleep::Company::none);
  }
  /// At a step's end, of dt seconds: nodes that someone has moved since, from `before`, into a solid or
  /// through one are brought back. Returns what met one, and counts it among touches().
  std::vector<Touch> keep_outside(const VectorField<Real>& before, double dt);
  /// Someone has written to particles() since the last step: that state is the last good one now, if it is
  /// good.
  void moved_from_outside();
  /// Adds an effect of the caller's own to the description's. If its forces change while the cloth sleeps it
  /// is the caller who wakes it. Tests inject faults so.
  void add_effect(std::unique_ptr<Effect<Real>> effect);

  /// Its steps are left out, as nothing moves or it rests: substeps is 0 and the state keeps its bits
  /// (sleep.h).
  bool asleep() const { return sleep_.asleep(); }
  void wake() {
    sleep_.wake();
    disturbed_ = true;
  }
  /// Left alone it would sleep, or it stands still.
  bool quiet() const { return sleep_.quiet() || frozen(); }
  void set_company(Sleep::Company company) { sleep_.set_company(company); }
  /// It, for islands of what sleeps together.
  Sleeper sleeper() const { return sleep_.sleeper(particles_); }
  /// While it rests its steps are left out, too, whatever its motion and the wind; not those in which
  /// something moves it: its pins, a hand, a solid or another cloth near it. It goes on from where it was.
  void set_resting(bool resting) { sleep_.set_resting(resting); }
  bool resting() const { return sleep_.resting(); }
  /// The last step was left out for that, though it may move.
  bool left_out() const { return sleep_.left_out(); }
  /// Stands still at its last good state, as no way of stepping it from there gives a good one
  /// (step_guard.h).
  bool frozen() const { return guard_.frozen(); }
  /// Neither, and stepped as it was asked for, not in a safer way for a while.
  bool steps_as_asked() const { return !asleep() && !frozen() && guard_.rung() == Rung::own; }
  bool steps_implicitly() const { return is_implicit(guard_.method()); }
  bool has_moving_pins() const { return pins_.moving(); }
  /// Pins::longest_way, for moving ones alone.
  double way_of_pins(double begin, double end) const { return pins_.longest_way(begin, end); }
  /// False if it has never been in a good state.
  bool sound() const { return guard_.sound(); }
  const GuardCounters& guard_counters() const { return guard_.counters(); }
  /// What the guard did since the last call; cloth and step are for the caller to fill in.
  std::vector<GuardEvent> take_guard_events() { return guard_.take_events(); }

  /// Whether the next step has to settle it first, among these solids; a sleeping one that is wakes.
  bool unsettled(const std::vector<Solid>& solids);
  /// Does so now, before whoever looks at where the step begins; otherwise advance() does.
  void settle_down(const std::vector<Solid>& solids, double time);
  /// Before it: on a coarser level, passes these solids where it did on the finer one (keep_sides.h).
  void keep_sides(const std::vector<Solid>& solids);
  /// The next step begins where the cloth has been settled: where nothing has stopped it.
  bool settled() const { return settled_ != Unsettled::no; }
  /// One step among the solids as they move in it in the world; what the cloth gives them is kept, and theirs
  /// with push_balls(). Several cloths may do it at the same time, each with its share of a ball that they
  /// all touch (Colliders::share).
  AdvanceReport advance(const std::vector<Solid>& solids, const Air& air, double time, double dt);
  /// The same in two: true if the step is made, then of those that are stepped together, whose methods are
  /// implicit if they are several.
  bool begin_advance(const std::vector<Solid>& solids, const Air& air, double time, double dt);
  static std::vector<AdvanceReport> advance_together(std::span<Cloth* const> cloths,
                                                     const std::vector<Solid>& solids, const Air& air,
                                                     double time, double dt);
  /// Of a step that is not made.
  AdvanceReport left_alone() const { return {.nodes_in_contact = nodes_in_contact_}; }
  /// Steps from now on may take at most so much work (interrupt.h); one that would is not made: the cloth
  /// stands still as if no way of stepping it helped. WorkLimit::kNone unless set.
  void set_most_work(double most) { most_work_ = most; }
  double most_work() const { return most_work_; }
  /// That the last step took; 0 if it was left out.
  double work() const { return work_; }
  bool cost_too_much() const { return work_ > most_work_; }
  /// What gave trouble is gone: if it stands still it is tried again in the next step.
  void try_again() { guard_.forgive(); }
  /// Its nodes that touch solids; none if nothing has come near any.
  std::span<const Touch> touches() const {
    return contact_ ? std::span<const Touch>(contact_->touches()) : std::span<const Touch>();
  }
  /// Adds the pinned nodes that solids which yield may meet in the step of `dt` from `time` on, s.
  void add_pins_near(const std::vector<Solid>& solids, double time, double dt,
                     std::vector<PinnedNode>& found);
  /// Where the solids of the next advance touch one another: what of it the cloth's bodies touch is a part of
  /// the advance of an implicit method, and is told the impulse.
  void set_body_touches(const std::vector<BodyTouch>& touches) { body_touches_ = touches; }
  const std::vector<BodyTouch>& body_touches() const { return body_touches_; }
  /// Touches the solid, or will within a step of `dt` seconds if all go on as they go.
  bool meets(const Solid& solid, double dt);
  /// Hands over what the last advance gave to the balls.
  void push_balls(Colliders& colliders) const;

 private:
  /// Takes what the effects say to itself; their objects are the caller's to make.
  void compose(const std::vector<EffectDescription>& effects);
  /// Begins to pour in the gas of `filling_`, if it is not what is there.
  void fill();
  void enter_level(int level, Particles<Real> particles);
  /// A cell's width and height, m.
  Vec2 cell(const Grid& grid) const {
    return description_.size.cwiseQuotient(Vec2(grid.cols - 1, grid.rows - 1));
  }
  double energy_of_nodes() const;  ///< J, of motion and height
  /// The state is the last good one from now on, if it is good.
  void hand_to_guard();
  void make_sheet();
  void take_over_walls();
  /// Breaks what the step has loaded beyond its strength.
  void tear();
  Contact<Real>& contact();
  /// Makes the pins that hold at time_; soft ones that held before keep their places.
  void hold();
  void set_pins();
  /// Of the cloth as it is, beside moving pins and layers.
  Forces<Real> forces(const EffectContext& context);
  /// advance_together(), until all states are good.
  static std::vector<AdvanceReport> advance_soundly(std::span<Cloth* const> cloths,
                                                    const std::vector<Solid>& solids, const Air& air,
                                                    double time, double dt);
  static std::vector<AdvanceReport> attempt(std::span<Cloth* const> cloths, const Air& air, double time,
                                            double dt);
  /// In the step that begins.
  Forces<Real> all_forces(const Air& air, double time, double dt);
  Contact<Real>* contact_in_step();
  void end_advance(const std::vector<Solid>& solids, double time, double dt, AdvanceReport& report);
  /// Whether anything may do work on it in a step of dt seconds: air or a hand, pins or solids that move,
  /// gas, other cloths.
  Drive drive(const Forces<Real>& forces, double dt) const;
  /// Where this cloth feels a wind that differs from node to node, that wind; otherwise null.
  const VectorField<float>* node_air(const Air& air, double time, double dt);
  template <class Archive>
  void serialize_sheet(Archive& archive);
  template <class Archive>
  void serialize_integrator(Archive& archive);
  template <class Archive>
  void serialize_contact(Archive& archive);
  template <class Archive>
  void serialize_soft_pins(Archive& archive);
  template <class Archive>
  void serialize_grabs(Archive& archive);
  /// Nothing remembers a step that was taken back.
  void forget_attempt();
  /// As seen from the cloth's place.
  std::vector<Solid> seen(const std::vector<Solid>& solids) const;

  ClothDescription description_;
  double total_mass_ = 0;
  int level_ = 0;
  std::optional<int> pending_level_;
  std::optional<Particles<Real>> finer_;  ///< as it was on the level that it has left, while whole
  Unsettled unsettled_ = Unsettled::no;   ///< to be settled before the next step
  Unsettled settled_ = Unsettled::no;     ///< in this step already; again, if it is taken back
  int splits_ = 0;                        ///< to finer levels since a step began
  double held_ = 0;                       ///< J, by springs and plate before the last change of level
  double had_ = 0;                        ///< J, all energy then
  bool begins_ = false;                   ///< where its description has put it, which no step has seen
  Particles<Real> particles_;
  Pins<Real> pins_;
  double time_ = 0;        ///< s, at the end of the last step that was made
  Vec3 gravity_{0, 0, 0};  ///< m/s2, of all gravity effects
  SheetEffects sheet_effects_;
  std::optional<InflationEffect> filling_;  ///< InflationEffect is there, and gas is shut in
  std::optional<TearingEffect> tearing_;
  std::optional<Walls> walls_;             ///< made by the first tear; stay if tearing_ goes
  std::shared_ptr<const TornLinks> torn_;  ///< by the walls at this level; nullptr while the cloth is whole
  std::vector<FaceRun> whole_faces_;       ///< of torn_
  Sheet<Real> sheet_;
  std::optional<Bag<Real>> bag_;                                ///< if the cloth is sewn
  std::vector<std::unique_ptr<Effect<Real>>> effects_;          ///< the description's, then what was added
  std::size_t composed_ = 0;                                    ///< of effects_, the description's
  SoftPins<Real>* soft_pins_ = nullptr;                         ///< one of effects_ as long as some hold
  double next_pins_ = std::numeric_limits<double>::infinity();  ///< when pins begin or end to hold next, s
  Grabs<Real>* grabs_ = nullptr;                  ///< one of effects_ as long as something is held
  std::unique_ptr<Integrator<Real>> integrator_;  ///< as guard_ will have it
  StepGuard<Real> guard_;
  Sleep sleep_;
  double most_work_ = WorkLimit::kNone, work_ = 0;
  // As seen from the cloth's place:
  std::vector<Solid> met_;  ///< as they were when the step began
  std::vector<BodyTouch> body_touches_;
  std::vector<Solid> solids_;  ///< as the cloth moves them in the step
  bool disturbed_ = true;      ///< since the last step something has been changed that may give it energy
  int nodes_in_contact_ = 0;   ///< at the end of the last step that was made
  LayerContacts<Real>* layers_ = nullptr;
  std::size_t layer_part_ = 0;
  std::unique_ptr<Contact<Real>> contact_;  ///< made when the scene first has a solid
  std::unique_ptr<NodeAir> node_air_;       ///< made when the wind first differs from node to node
  ContactCounters earlier_contacts_;        ///< at the levels left behind
};

extern template class Cloth<float>;
extern template class Cloth<double>;

}  // namespace weft
