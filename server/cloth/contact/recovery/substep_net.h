#pragma once
#include "cloth/contact/search/feature_search.h"
#include "cloth/core/particles.h"
#include "cloth/core/substep.h"

namespace weft {

/// Keeps one cloth's features apart at every substep of an explicit step: what CollisionNet moves after the
/// step stretches springs without doing work, and so adds energy.
///
/// Features lie apart as a substep begins. Those whose nearest points would come nearer than the gap along
/// the line between them are held by inelastic impulses, pair by pair in a few rounds (Bridson, Fedkiw,
/// Anderson, Robust Treatment of Collisions, Contact and Friction for Cloth Animation, 2002, section 7.4), as
/// many of them as are found in the step's searches; the rest is left to CollisionNet.
///
/// The step's own search serves, along the ways that the velocities predict, until nodes leave these by more
/// than its margin. Then it is made again, twice a step at most: in a rope that is wrung too tight to be
/// held, more searches cost three times as much and hold it hardly better.
class SubstepNet {
 public:
  /// Features are kept `gap` apart, m.
  SubstepNet(const Grid& grid, double gap) : gap_(gap) { search_.set_grids({grid}); }

  /// What is cut of the cloth.
  void set_torn(const TornLinks& torn) { search_.set_torn(0, torn); }
  /// A step begins. `found` is the search of all cloths for it, from nodes.start to nodes.end; this cloth's
  /// nodes are those from `first` to `end`, and have `inverse_mass`, 1/kg, be it that it woke in the step.
  void begin_step(const LayerNodes& nodes, const std::vector<double>& inverse_mass,
                  const FeatureSearch& found, std::uint32_t first, std::uint32_t end);
  /// At a substep's end: moves nodes on, and changes their velocities.
  template <class Real>
  void apply(Particles<Real>& particles, const Substep& substep);

  /// What lasts from step to step (world/state.h).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(own_, pairs_, margin_, found_at_, searches_, found_start_, found_end_);
  }

 private:
  /// A pair that comes near in the substep, as it begins.
  struct Near {
    std::array<std::uint32_t, 4> node{};
    std::array<double, 4> weight{};
    Vec3 normal;          ///< from the second feature's nearest point to the first's
    double distance = 0;  ///< between them, m
    double mobility = 0;  ///< inverse mass along the normal, 1/kg
  };
  /// How far each node went in the substep, as seen from the common motion.
  void measure_ways();
  /// Nodes are so near to where the last search saw them that no pair is missing.
  bool covered(double to) const;
  void search(const Substep& substep);
  /// Bound on how much nearer the pair comes in the substep, m.
  double nearing(const FeaturePair& pair) const;
  void collect();
  bool push_apart(const Near& near);

  double gap_;
  LayerNodes own_;  ///< on their ways in the substep
  FeatureSearch search_;
  std::vector<FeaturePair> pairs_;             ///< their distances are lower bounds as the substep begins
  double margin_ = 0;                          ///< with which they were found, m
  double found_at_ = 0;                        ///< share of the step
  int searches_ = 0;                           ///< in this step
  std::vector<Vec3> found_start_, found_end_;  ///< the nodes' ways, as the search saw them
  std::vector<double> way_;                    ///< of each node in the substep, m
  std::vector<Near> near_;
};

}  // namespace weft
