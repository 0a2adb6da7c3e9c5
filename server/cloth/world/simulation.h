#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "cloth/world/cloth.h"
#include "cloth/world/cloth_contact.h"
#include "cloth/world/description.h"

namespace weft {

/// Wall time of the stages of the last step, s. Cloths may be advanced at the same time: `forces` and
/// `contact`, their sums, may then be more than `total`.
struct StepProfile {
  double levels = 0;   ///< split and merge
  double forces = 0;   ///< springs and effects
  double contact = 0;  ///< broad phase and response
  double check = 0;    ///< the step guard: is the state a good one
  double total = 0;
};

/// State of one cloth, for stats.
struct ClothReport {
  int level = 0;
  int substeps = 0;  ///< of the last step
  int nodes_in_contact = 0;
  double kinetic_energy = 0;    ///< J
  double potential_energy = 0;  ///< J, springs and gravity
  StructuralStrain strain;
};

/// A scene being simulated: cloths, balls, wind, and the step. Deterministic: the same description and the
/// same calls between the same steps give the same bits, on any number of threads (parallel.h). Not
/// thread-safe; one owner calls it.
template <class Real>
class Simulation {
 public:
  explicit Simulation(SimulationDescription description);

  const SimulationDescription& description() const { return description_; }
  std::uint64_t step_count() const { return steps_; }
  /// step_count * time_step, counted in whole steps so that it never drifts, s.
  double time() const { return static_cast<double>(steps_) * description_.time_step; }
  /// False if a cloth's very start is not finite: from any other bad state the step guard goes back.
  bool healthy() const;
  /// What the step guard found and did in the last step (step_guard.h); empty if all went well.
  const std::vector<GuardEvent>& guard_events() const { return guard_events_; }
  const StepProfile& profile() const { return profile_; }
  const AdvanceReport& last_advance(std::size_t cloth) const { return last_advance_[cloth]; }

  const std::vector<Cloth<Real>>& cloths() const { return cloths_; }
  std::vector<Cloth<Real>>& cloths() { return cloths_; }
  const Colliders& colliders() const { return colliders_; }
  /// nullptr where cloths pass through themselves.
  const ClothContact<Real>* layers() const { return layers_.get(); }
  const Wind& wind() const { return air_.wind(); }
  /// Those that are simulated now.
  const std::vector<EffectDescription>& effects() const { return effects_; }
  Vec3 gravity() const { return gravity_; }
  /// Energies and strain, computed now: not part of a step.
  ClothReport report(std::size_t cloth) const;
  /// The cloth's centre (mean of its nodes), for Eq. 7.
  Vec3 centre(std::size_t cloth) const;

  // Commands: each takes effect in the next step.
  void request_level(std::size_t cloth, int level) { cloths_[cloth].request_level(level); }
  /// The cloth's steps are left out, or no longer (Cloth::set_resting): for cloths that nobody sees. Until
  /// reset(). Whoever records commands records this one, too.
  void set_resting(std::size_t cloth, bool resting) { cloths_[cloth].set_resting(resting); }
  void set_wind(const Wind& wind) { air_.change(wind, time()); }
  /// How the air moves in one of the wind's zones, m/s.
  void set_wind_zone(std::size_t zone, const Vec3& velocity);
  /// Every cloth is stepped by `integrator` from the next step on; until reset(), which goes back to the
  /// description's.
  void set_integrator(const IntegratorDescription& integrator);
  /// Only these effects are simulated from the next step on, in every cloth and for the balls; until reset(),
  /// which goes back to the description's. Where they are of the types that are simulated already, in the
  /// same order, only their numbers change and integrators go on from the steps before.
  void set_effects(const std::vector<EffectDescription>& effects);
  /// The cloth is of this material, whose density is as before, from the next step on; until reset().
  void set_material(std::size_t cloth, const Material& material) { cloths_[cloth].set_material(material); }
  /// Coulomb's coefficient of a ball, or of an obstacle by its place in Colliders::obstacles(), >= 0; until
  /// reset(). All that sleeps wakes. False if there is no such one.
  bool set_ball_friction(BallId id, double friction);
  bool set_obstacle_friction(std::size_t index, double friction);
  BallId add_ball(const BallDescription& ball) { return colliders_.add(ball); }
  bool move_ball(BallId id, const Vec3& target) { return colliders_.move(id, target); }
  bool throw_ball(BallId id, const Vec3& velocity) { return colliders_.throw_ball(id, velocity); }
  bool remove_ball(BallId id) { return colliders_.remove(id); }
  bool move_obstacle(std::size_t index, const Pose& target) {
    return colliders_.move_obstacle(index, target);
  }
  bool throw_obstacle(std::size_t index, const Vec3& velocity, const Vec3& spin) {
    return colliders_.throw_obstacle(index, velocity, spin);
  }

  /// A hand takes hold of a cloth at (u, v), where it is now unless the hand is elsewhere, and pulls with at
  /// most `max_force`, N.
  GrabId grab(std::size_t cloth, const Vec2& at, const std::optional<Vec3>& hand, double max_force);
  /// The same of a body, by its place in Colliders::obstacles(), at `point` of its own axes from its centre;
  /// nothing if there is no such obstacle, or it is no body.
  std::optional<GrabId> grab_obstacle(std::size_t index, const Vec3& point, const std::optional<Vec3>& hand,
                                      double max_force);
  bool move_grab(GrabId id, const Vec3& hand);
  bool release(GrabId id);
  void pin(std::size_t cloth, const Vec2& at) { cloths_[cloth].pin(at); }
  bool unpin(std::size_t cloth, const Vec2& at) { return cloths_[cloth].unpin(at); }

  /// The state of `other`, which is of the same scene, whatever has happened in it, on any number of threads:
  /// the next steps give the same bits as there. Effects stay its own, so that one step can be made with and
  /// without them. What is left of an effect it has not: tears stay, they are the cloth's shape; gas is let
  /// out without one that shuts it in. What only it has begins anew. Effects by Cloth::add_effect stay where
  /// they were added.
  ///
  /// Throws std::invalid_argument if cloths, obstacles or time steps differ; it is left as it was.
  void take_state(const Simulation& other);
  /// The same but for balls, obstacles and the hands on them: those stay its own, if it has any. Pins fixed
  /// to an obstacle that it has not stand still.
  void take_cloths(const Simulation& other);

  /// Air, cloths and layers; colliders; and what is told of the last step (state.h).
  template <class Archive>
  void serialize(Archive& archive);

  /// One fixed step of description().time_step seconds. Throws Interrupted (interrupt.h) if it is
  /// interrupted.
  void step();
  /// Back to the description's start, at the description's initial levels.
  void reset();

 private:
  template <class Archive>
  void serialize_cloths(Archive& archive);
  /// The step, or the first of so many parts that are left of it (step_parts.h), from `time` on.
  void step_part(double time, double dt, int parts_left);
  /// Takes of the effects what is the whole scene's: gravity for the balls, contact between cloths.
  void compose(const std::vector<EffectDescription>& effects);
  /// Contact between cloths begins anew, if there is any.
  void make_layers(const std::optional<ClothContactEffect>& contact);
  /// All cloths, for islands of what sleeps together.
  std::vector<Sleeper> sleepers() const;
  /// Dynamic balls and bodies meet each other and what is in their way.
  /// Friction between those that the cloths' steps have `pushed` apart has that, too.
  void meet_bodies(const std::vector<PinnedNode>& pins, double dt,
                   const std::vector<BodyTouch>* pushed = nullptr);
  /// After meet_bodies: tells cloths that solve for bodies where these touch one another.
  void join_bodies();
  /// Gathers what the cloths' steps have pushed them apart by.
  void add_body_impulses();
  /// Tells the balls how many cloths will touch them.
  void share_balls(double dt);
  /// Calls work(i) for each of so many cloths, or groups of them, side by side where that helps.
  template <class Work>
  void for_each(std::size_t count, const Work& work);
  /// Those that have to settle do so before contact between cloths looks where they are: what the step then
  /// keeps apart would else be held in a shape that is not settled.
  void settle_cloths(double time, double dt);
  /// All cloths through the step, as it is for each of them alone.
  void advance_cloths(double time, double dt);
  void collect_guard_events();

  SimulationDescription description_;
  std::vector<EffectDescription> effects_;  ///< those that are simulated
  Vec3 gravity_{0, 0, 0};
  Air air_;
  Colliders colliders_;
  std::vector<Cloth<Real>> cloths_;
  std::unique_ptr<ClothContact<Real>> layers_;     ///< if the scene lists cloth_contact
  std::vector<BodyTouch> touches_;                 ///< in the step
  std::unique_ptr<BodyCollision> body_collision_;  ///< made when something may first meet
  std::vector<AdvanceReport> last_advance_;
  std::uint64_t steps_ = 0;
  GrabId next_grab_ = 1;
  std::vector<GuardEvent> guard_events_;
  StepProfile profile_;
};

extern template class Simulation<float>;
extern template class Simulation<double>;

}  // namespace weft
