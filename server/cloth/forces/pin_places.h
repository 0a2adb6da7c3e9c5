#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "cloth/core/particles.h"
#include "cloth/sheet/pins.h"

namespace weft {

/// Where a soft pin draws the cloth: the places that the nodes in its region, and those around it, had when
/// it took hold, at the level of then. They go with its path, its motion, its obstacle or its ball, and stay
/// what they are at every level: between them a place is bilinear in theirs.
class PinPlaces {
 public:
  PinPlaces() = default;
  /// Takes hold of where the particles are at `time`, s.
  template <class Real>
  PinPlaces(const PinRegion& region, double time, const Particles<Real>& particles);

  /// A place by its shares of four of those that were taken.
  struct Stencil {
    std::array<std::size_t, 4> index{};
    std::array<double, 4> share{};
    template <class Archive>
    void serialize(Archive& archive) {
      archive(index, share);
    }
  };
  /// Of what is at u and v, in [0, 1]; of what is outside of all places that of the nearest border.
  Stencil stencil(double u, double v) const;
  /// In the world, m, at the time they were carried to.
  Vec3 at(const Stencil& stencil) const;

  bool moving() const { return pins_.moving(); }
  /// As Pins::begin_step.
  bool begin_step(const std::vector<Solid>& solids, double time, double dt) {
    return moving() && pins_.begin_step(places_, solids, time, dt);
  }
  /// To where they are at `time`, s, within the step that has begun.
  void carry(double time) const {
    if (moving()) pins_.carry(places_, time);
  }

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(first_u_, first_v_, step_u_, step_v_, pins_, places_);
  }

 private:
  double first_u_ = 0, first_v_ = 0;  ///< of the first row and column of places
  double step_u_ = 1, step_v_ = 1;    ///< from one to the next
  Pins<double> pins_;                 ///< on a grid of these places alone
  mutable Particles<double> places_;  ///< in the world
};

extern template PinPlaces::PinPlaces(const PinRegion&, double, const Particles<float>&);
extern template PinPlaces::PinPlaces(const PinRegion&, double, const Particles<double>&);

}  // namespace weft
