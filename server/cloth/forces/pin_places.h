#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "cloth/core/particles.h"
#include "cloth/sheet/pins.h"

namespace weft {

/// Where a soft pin draws the cloth: the places that its nodes had when it took hold, at the level of then.
/// They go with its path, its motion, its obstacle or its ball, and stay what they are at every level:
/// between them a place is bilinear in theirs, and beyond the outermost it goes on as between the first and
/// the last of a row.
template <class Real>
class PinPlaces {
 public:
  PinPlaces() = default;
  /// Takes hold: of the places that the region's nodes have at `time`, s.
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
  /// Of what is at u and v, in [0, 1].
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
  double first_u_ = 0, first_v_ = 0;  ///< of the first row and column of nodes
  double step_u_ = 1, step_v_ = 1;    ///< from one to the next
  Pins<Real> pins_;                   ///< on a grid of the region's nodes alone
  mutable Particles<Real> places_;
};

extern template class PinPlaces<float>;
extern template class PinPlaces<double>;

}  // namespace weft
