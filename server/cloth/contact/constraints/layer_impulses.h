#pragma once
#include <array>
#include <vector>

#include "cloth/contact/constraints/layer_pair.h"
#include "cloth/contact/recovery/substep_net.h"

namespace weft {

/// The contacts of one cloth with itself and others as impulses, in an explicit substep: pairs nearer than
/// their gap lose the speed at which they approach, rub by Coulomb's friction, are led apart by a share of
/// what they lack, and are slowed where they separate slowly. What that misses within the cloth SubstepNet
/// holds.
///
/// From substep to substep the other cloths' nodes keep the velocity that the impulses give them. Otherwise
/// two sheets on each other would swap velocities for ever.
template <class Real>
class LayerImpulses {
 public:
  /// Of the cloth whose nodes begin at `first`. `found` is the search that the steps' pairs come from. It and
  /// the nodes are kept by reference.
  LayerImpulses(const LayerNodes& nodes, const FeatureSearch& found, const Grid& grid, std::uint32_t first,
                const LayerParameters& parameters);

  /// What is cut of the cloth.
  void set_torn(const TornLinks& torn) { substep_net_.set_torn(torn); }
  /// At a substep's end, with the pairs of the step that have nodes of the cloth. Adds what other cloths gave
  /// each of its nodes to `given`, N s.
  void resolve(Particles<Real>& particles, const Substep& substep, const std::vector<LayerPair>& pairs,
               std::vector<Vec3>& given);

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(others_, inverse_mass_, substep_net_);
  }

 private:
  /// A node of another cloth, as the step foresees it: nothing but this cloth's layers and what withstood
  /// them before (LayerNodes::support) acts on it, and where it lies on a solid neither.
  struct Other {
    std::uint32_t node;
    Vec3 position, velocity;
    double inverse_mass;  ///< 1/kg
    template <class Archive>
    void serialize(Archive& archive) {
      archive(node, position, velocity, inverse_mass);
    }
  };
  /// A pair's nodes at the substep's end.
  struct Ends {
    FourPoints position, velocity;       ///< in the world, m; m/s
    std::array<double, 4> inverse_mass;  ///< 1/kg
  };
  /// How they touch.
  struct Touching {
    Vec3 normal;
    double share;  ///< inverse mass along it, 1/kg (PairShare::bounded)
    double lack;   ///< of their gap, m
  };
  /// In a substep: of what pairs lack they are led apart, and of what they separate slowly with they lose.
  struct Shares {
    double led_apart, slowed;
  };
  /// What a pair's nodes get, each by its weight.
  struct Hit {
    Vec3 impulse;  ///< N s
    Vec3 push;     ///< that leads them apart, kg m
  };
  /// Those of the step's pairs, as it begins.
  void find_others(const std::vector<LayerPair>& pairs);
  /// To a substep's end, but for what the layers do in it.
  void move_others(const Substep& substep);
  Other& other(std::uint32_t node);
  bool own(std::uint32_t node) const { return node >= first_ && node < end_; }
  Ends ends_of(const LayerPair& pair, const Particles<Real>& particles);
  /// In a substep of h seconds.
  Hit hit(const Ends& ends, const Nearness& near, const Touching& touching, const Shares& shares,
          double h) const;
  void give(const Hit& hit, const LayerPair& pair, const Nearness& near, const Ends& ends,
            Particles<Real>& particles, std::vector<Vec3>& given);

  const LayerNodes* nodes_;
  const FeatureSearch* found_;
  std::uint32_t first_, end_;  ///< of this cloth's nodes
  double friction_;
  std::vector<Other> others_;         ///< of the step's pairs, by node
  std::vector<double> inverse_mass_;  ///< of this cloth's nodes in the step, 1/kg
  SubstepNet substep_net_;
};

extern template class LayerImpulses<float>;
extern template class LayerImpulses<double>;

}  // namespace weft
