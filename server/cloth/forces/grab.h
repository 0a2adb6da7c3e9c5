#pragma once
#include <vector>

#include "cloth/core/grab_id.h"
#include "cloth/forces/effect.h"

namespace weft {

/// A hand on a cloth: it holds a patch around a point and pulls it to where it is.
struct Grab {
  GrabId id = 0;
  Vec2 at{0.5, 0.5};       ///< (u, v) of the point, in [0, 1]
  Vec3 hand{0, 0, 0};      ///< in the world, m
  double max_force = 100;  ///< N, > 0; what the hand is pulled beyond it slips behind
  template <class Archive>
  void serialize(Archive& archive) {
    archive(id, at, hand, max_force);
  }
};

/// The cloth's grabs, F = k (hand - x) - d v of the patch's mean x and v, as the mouse joints of rigid body
/// engines are (Box2D): a damped spring between each hand and the mean of its patch, of at most max_force.
/// The patch is a hat of 1/16 of the shorter side around the point, or of a cell where those are larger, so
/// that its size does not hang on the level. The spring is so stiff that the whole cloth, hung from it,
/// swings at kFrequency: it hangs g / kFrequency^2 = 2.5 cm below the hand whatever it weighs. Where an
/// explicit substep does not bear the damping, it has less of it.
template <class Real>
class Grabs final : public Effect<Real> {
 public:
  static constexpr double kFrequency = 20;  ///< rad/s
  static constexpr double kPatch = 1.0 / 16;

  const char* name() const override { return "grab"; }
  bool empty() const { return grabs_.empty(); }
  const std::vector<Grab>& all() const { return grabs_; }
  void add(const Grab& grab) { grabs_.push_back(grab); }
  /// Where the hand goes; false if there is no such grab.
  bool move(GrabId id, const Vec3& hand);
  bool release(GrabId id);
  /// Where what would be held at (u, v) is now, in the world, m.
  static Vec3 place(const Particles<Real>& particles, const ClothDescription& cloth, const Vec2& uv);

  void add_forces(const Particles<Real>& particles, const EffectContext& context,
                  VectorField<Real>& force) const override;
  /// Of each pull across its patch, together.
  double tension(const Particles<Real>& particles, const EffectContext& context) const override;
  double max_damping_rate(const Particles<Real>& particles, const EffectContext& context) const override;
  void add_damping(const Particles<Real>& particles, const EffectContext& context,
                   const DampingMatrix<Real>& damping) const override;
  void add_stiffness(const Particles<Real>& particles, const EffectContext& context,
                     Real* stiffness) const override;
  bool holds() const override { return true; }

 private:
  struct Pull {
    Vec3 force;    ///< N
    double share;  ///< of the spring's: below 1 where the hand slips
  };
  Pull pull_of(const Grab& grab, const Particles<Real>& particles, const EffectContext& context) const;
  /// Adds to each node its part, by weight, of what all grabs have that do not slip.
  void add_shares(const Particles<Real>& particles, const EffectContext& context, double of_each,
                  Real* sum) const;
  /// Of the cloth's mass over a node's own, what the node bears of a grab, at most.
  double largest_share(const Particles<Real>& particles, const ClothDescription& cloth) const;

  std::vector<Grab> grabs_;
};

extern template class Grabs<float>;
extern template class Grabs<double>;

}  // namespace weft
