#pragma once
#include <vector>

#include "cloth/contact/constraints/body_spring.h"
#include "cloth/core/substep.h"
#include "cloth/forces/effect.h"
#include "cloth/forces/pin_places.h"
#include "cloth/shapes/solid.h"

namespace weft {

/// Largest stiffness of all pins on a body, of its mass / step^2: at the rim of a ball, which has inverse
/// masses of 3.5 / m there, a quarter of what is stable.
inline constexpr double kPinBound = 0.25;

/// Pins with a stiffness: each of a region's nodes is drawn by an undamped spring to where a stiff pin would
/// hold it (PinPlaces), F_i = k m_i / m (place_i - x_i), with k the region's stiffness and m the mass of all
/// its nodes. Shares by mass make the pin the same at every level: what it holds hangs W / k below its
/// places, and swings with 2 pi sqrt(m / k) where nothing but its own nodes swings.
template <class Real>
class SoftPins final : public Effect<Real> {
 public:
  SoftPins() = default;
  /// Of regions that have a stiffness, as the particles are at `time`, s. Those that are among the pins of
  /// `before` keep their places, whatever its level was; the others take hold of where their nodes are.
  SoftPins(const std::vector<PinRegion>& regions, double time, const Particles<Real>& particles,
           const SoftPins* before = nullptr);

  const char* name() const override { return "soft_pin"; }
  /// As Pins::begin_step.
  bool begin_step(const std::vector<Solid>& solids, double time, double dt) {
    bool moves = false;
    for (Held& held : held_) moves = held.places.begin_step(solids, time, dt) || moves;
    return moves;
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
  /// body's points; scene files are held to kPinBound there.
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
    for (const Held& held : held_) {
      held.places.carry(time);
      for (const Spring& spring : held.springs) visit(spring.node, held.places.at(spring.place));
    }
  }

  void add_forces(const Particles<Real>& particles, const EffectContext& context,
                  VectorField<Real>& force) const override;
  /// Of each region's pull across it, together.
  double tension(const Particles<Real>& particles, const EffectContext& context) const override;
  /// A spring of frequency w asks no more of an explicit step than a damping rate of w.
  double max_damping_rate(const Particles<Real>& particles, const EffectContext& context) const override;
  void add_stiffness(const Particles<Real>& particles, const EffectContext& context,
                     Real* stiffness) const override;
  bool holds() const override { return true; }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(held_);
  }

 private:
  struct Spring {
    std::size_t node;
    double stiffness;  ///< N/m
    PinPlaces::Stencil place;
    template <class Archive>
    void serialize(Archive& archive) {
      archive(node, stiffness, place);
    }
  };
  struct Held {
    PinRegion region;
    PinPlaces places;
    std::vector<Spring> springs;
    template <class Archive>
    void serialize(Archive& archive) {
      archive(region, places, springs);
    }
  };
  /// Calls visit(spring, from the node to its place at `time`, s, m) for all of a region.
  template <class Visit>
  static void for_each_spring(const Held& held, const Particles<Real>& particles, double time, Visit visit);
  /// The one of this region; nullptr if there is none.
  const Held* of(const PinRegion& region) const;

  std::vector<Held> held_;
};

extern template class SoftPins<float>;
extern template class SoftPins<double>;

}  // namespace weft
