#pragma once
#include <vector>

#include "cloth/contact/constraints/body_spring.h"
#include "cloth/core/substep.h"
#include "cloth/forces/effect.h"
#include "cloth/shapes/solid.h"
#include "cloth/sheet/pins.h"

namespace weft {

/// Largest stiffness of all pins on a body, of its mass / step^2: at the rim of a ball, which has inverse
/// masses of 3.5 / m there, a quarter of what is stable.
inline constexpr double kPinBound = 0.25;

/// Pins with a stiffness: each of a region's nodes is drawn by an undamped spring to where a stiff pin would
/// hold it, F_i = k m_i / m (place_i - x_i), with k the region's stiffness and m the mass of all its nodes.
/// Shares by mass make the pin the same at every level: what it holds hangs W / k below its places, and
/// swings with 2 pi sqrt(m / k) where nothing but its own nodes swings.
template <class Real>
class SoftPins final : public Effect<Real> {
 public:
  SoftPins() = default;
  /// Of regions that have a stiffness, as the particles are at `time`, s. Their nodes' places are where these
  /// are, and as far from there as `pulls` says, m: one of each region.
  SoftPins(const std::vector<PinRegion>& regions, const std::vector<Vec3>& pulls, double time,
           const Particles<Real>& particles);

  const char* name() const override { return "soft_pin"; }
  /// From the region's nodes to their places at `time`, s, the mean by mass, m: a change of level keeps it. 0
  /// of a region that is not among these.
  Vec3 pull(const PinRegion& region, const Particles<Real>& particles, double time) const;
  /// As Pins::begin_step.
  bool begin_step(const std::vector<Solid>& solids, double time, double dt) {
    return places_of_.moving() && places_of_.begin_step(places_, solids, time, dt);
  }

  /// Those on solids that yield, as seen in a substep of the step that has begun, from `time` on: with the
  /// nodes where they are, and the places where they are at its end. The solids are as the cloth sees them.
  std::vector<BodySpring> on_bodies(const Particles<Real>& particles, const std::vector<Solid>& solids,
                                    double time, double dt, const Substep& substep);
  /// Of all its springs.
  std::size_t count() const {
    std::size_t sum = 0;
    for (const Held& held : held_) sum += held.springs.size();
    return sum;
  }
  /// Explicit methods: a step of `dt` to `time`, s, has been made among the solids, which are as the cloth
  /// leaves them and sees them: those that yield get the impulse of the force at its end, against the pins'
  /// pull. Summed over steps that is what the cloth gets, but for a step's force at either end: nothing
  /// drifts. Stable as a spring is that is stepped by symplectic Euler's method, while k dt^2 < 4 m at the
  /// body's points; a scene holds kPinBound.
  void push(const Particles<Real>& particles, std::vector<Solid>& solids, double time, double dt) const;

  /// Calls visit(node, stiffness), in N/m, for each of its springs: for methods that take them implicitly.
  template <class Visit>
  void for_each_stiffness(Visit visit) const {
    for (const Held& held : held_) {
      for (const Spring& spring : held.springs) visit(spring.node, spring.stiffness);
    }
  }
  /// Calls visit(node, place) for each in the same order: where it draws the node at `time`, s, in the world,
  /// m.
  template <class Visit>
  void for_each_place(double time, Visit visit) const {
    move_places(time);
    for_each_stiffness([&](std::size_t node, double) { visit(node, place_of(node)); });
  }

  void add_forces(const Particles<Real>& particles, const EffectContext& context,
                  VectorField<Real>& force) const override;
  /// Of each region's pull across it, together.
  double tension(const Particles<Real>& particles, const EffectContext& context) const override;
  /// A spring of frequency w asks no more of an explicit step than a damping rate of w.
  double max_damping_rate(const Particles<Real>& particles, const EffectContext& context) const override;
  /// Its stiffness, which in a step of h weighs as much as a damping of h times it.
  void add_damping(const Particles<Real>& particles, const EffectContext& context,
                   const DampingMatrix<Real>& damping) const override;

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(held_, places_of_, places_);
  }

 private:
  struct Spring {
    std::size_t node;
    double stiffness;  ///< N/m
    template <class Archive>
    void serialize(Archive& archive) {
      archive(node, stiffness);
    }
  };
  struct Held {
    PinRegion region;
    std::vector<Spring> springs;
    template <class Archive>
    void serialize(Archive& archive) {
      archive(region, springs);
    }
  };
  /// Calls visit(spring, from the node to its place, m) for all of a region.
  template <class Visit>
  void for_each_spring(const Held& held, const Particles<Real>& particles, Visit visit) const;
  Vec3 place_of(std::size_t node) const {
    const VectorField<Real>& at = places_.position;
    return places_.place + Vec3(at.x.values()[node], at.y.values()[node], at.z.values()[node]);
  }
  void move_places(double time) const {
    if (places_of_.moving()) places_of_.carry(places_, time);
  }

  std::vector<Held> held_;
  Pins<Real> places_of_;  ///< holds places_ where stiff pins would hold the cloth
  mutable Particles<Real> places_;
};

extern template class SoftPins<float>;
extern template class SoftPins<double>;

}  // namespace weft
