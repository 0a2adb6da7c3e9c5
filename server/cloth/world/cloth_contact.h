#pragma once
#include <memory>
#include <vector>

#include "cloth/contact/constraints/layer_contacts.h"
#include "cloth/contact/recovery/collision_net.h"
#include "cloth/contact/recovery/layer_order.h"
#include "cloth/core/disjoint_sets.h"
#include "cloth/core/effect_description.h"

namespace weft {

template <class Real>
class Cloth;

/// Contact of a scene's cloths with themselves and with one another (ClothContactEffect), around their steps.
///
/// Before them the pairs are found that lie or will lie nearer than the thickness, of a node on a triangle,
/// to an implicit step, the nearest on each side alone. Cloths that pairs join and whose methods are implicit
/// make a group, which is stepped as one (LayerContacts); others take their pairs into their own steps.
/// Groups are stepped side by side. After them all the net (CollisionNet) stops what they missed, over all
/// cloths together and in one order, whatever the threads.
///
/// The thickness is held to half a cell: at a level so fine that cells are smaller, neighbours on a flat
/// sheet would push each other.
///
/// Cloth may begin entangled, and merges and solids that leave it no other way may make it so; nothing else
/// does: what a merge puts through each other is led back into its order (keep_order), and the net stops what
/// settling would move through other cloth, too. Nodes of triangles that an edge passes through are left
/// alone, by contact and net, and led out of each other (untangling_moves) until none does. Torn cells are
/// not there (FeatureSearch).
template <class Real>
class ClothContact {
 public:
  explicit ClothContact(const ClothContactEffect& parameters) : parameters_(parameters) {}

  const ClothContactEffect& parameters() const { return parameters_; }

  /// Before cloths settle (levels/settle.h), some of them, each as if it were alone: leads what is entangled
  /// out of each other.
  void begin_settling(std::vector<Cloth<Real>>& cloths);
  /// After it, as after a step of dt seconds, but all keep the velocities that they have.
  void end_settling(std::vector<Cloth<Real>>& cloths, double dt);
  /// Before the cloths' step of dt seconds: finds the pairs, and says who keeps whom from sleep.
  void begin_step(std::vector<Cloth<Real>>& cloths, double dt);
  /// Hands the pairs to the cloths, in groups of those that are stepped together; `steps` says of each
  /// whether its step is made.
  void make_groups(std::vector<Cloth<Real>>& cloths, const std::vector<char>& steps);
  /// Each by its cloths, in order.
  const std::vector<std::vector<std::size_t>>& groups() const { return groups_; }
  /// After it: moves nodes on, with their velocities, where cloth would have passed through cloth; but none
  /// into a solid or through one.
  void end_step(std::vector<Cloth<Real>>& cloths, double dt);

  /// What lasts from step to step (world/state.h), among these cloths, whose own state is there.
  template <class Archive>
  void serialize(Archive& archive, std::vector<Cloth<Real>>& cloths);

  /// Nodes that are left alone, as the last step began.
  int tangled_nodes() const { return tangled_; }
  /// Fastest that a cloth goes past or towards another one that it is near, as the last step began, in the
  /// narrower of their cells a second.
  double cells_passed() const { return cells_passed_; }
  /// In the last step more of the cloth lay in one place than is kept apart (FeatureSearch).
  bool crowded(std::size_t cloth) const { return crowded_[cloth] != 0; }

 private:
  void lay_out(std::vector<Cloth<Real>>& cloths);
  /// What lies over each other is of these grids.
  bool laid_out(const std::vector<Cloth<Real>>& cloths) const;
  /// Takes over what was torn since the last step.
  void take_over_tears(const std::vector<Cloth<Real>>& cloths);
  void take_over_tears(const std::vector<Cloth<Real>>& cloths, std::size_t cloth);
  void read(const std::vector<Cloth<Real>>& cloths, std::vector<Vec3>& positions) const;
  void read_masses(const std::vector<Cloth<Real>>& cloths);
  /// To the net, what goes on lying on solids is harder to move: it cannot give way into them.
  void weigh_down(const std::vector<Cloth<Real>>& cloths);
  void untangle(std::vector<Cloth<Real>>& cloths);
  /// The net, over the nodes' ways.
  void stop_what_meets(std::vector<Cloth<Real>>& cloths, double dt);
  /// What the net has moved, in the cloths. True if solids were in its way: then those nodes are where they
  /// let them, here as well, and harder to move.
  bool move_on(std::vector<Cloth<Real>>& cloths, double dt);
  void find_pairs(std::vector<Cloth<Real>>& cloths, double dt);
  /// Lays out the contacts of these groups; what was remembered of each cloth stays.
  void set_groups(std::vector<std::vector<std::size_t>> groups, std::vector<Cloth<Real>>& cloths);
  /// The contacts of the cloth's group, in which it is the part.
  LayerContacts<Real>& contacts_of(std::size_t cloth) { return *contacts_[place_[cloth].group]; }
  std::size_t part_of(std::size_t cloth) const { return place_[cloth].part; }
  /// Tells the cloths in what company they are; islands are of those that pairs join.
  void let_sleep(std::vector<Cloth<Real>>& cloths, DisjointSets& islands) const;
  /// Of a pair of two cloths, for cells_passed().
  double pass(const LayerPair& pair) const;
  /// A sleeping cloth that it joins is to wake.
  bool rouses(const LayerPair& pair) const;
  std::size_t sheet_of(std::uint32_t node) const;

  ClothContactEffect parameters_;
  std::vector<Grid> grids_;
  std::vector<double> gaps_;                            ///< of each cloth, m
  std::vector<double> cells_;                           ///< of each cloth, the shorter side, m
  std::vector<std::shared_ptr<const TornLinks>> torn_;  ///< of each cloth; nullptr while it is whole
  LayerNodes nodes_;
  FeatureSearch search_;
  CollisionNet net_{0};
  /// A pair for the cloths that step implicitly, or for the others.
  struct FoundPair {
    LayerPair pair;
    bool implicitly = false;
    template <class Archive>
    void serialize(Archive& archive) {
      archive(pair, implicitly);
    }
  };
  /// Pairs of cloths at these grids, by the nodes that they have now.
  std::vector<OrderedLayers> layers_now(const std::vector<FoundPair>& pairs,
                                        const std::vector<Grid>& grids) const;
  /// Leads them apart where merges have put them through each other.
  void keep_order(const std::vector<OrderedLayers>& layers, std::vector<Cloth<Real>>& cloths);

  std::vector<FoundPair> pairs_;  ///< of the step
  /// Of a cloth among the groups.
  struct Place {
    std::size_t group = 0, part = 0;
  };
  std::vector<std::vector<std::size_t>> groups_;                ///< of cloths
  std::vector<Place> place_;                                    ///< of each cloth
  std::vector<std::unique_ptr<LayerContacts<Real>>> contacts_;  ///< of each group
  std::vector<char> pressed_;   ///< by node, by another cloth, in the step before the last
  std::vector<char> on_solid_;  ///< by node, as the last step ended
  std::vector<char> left_out_;  ///< by cloth, the step before the last, as it was told to rest
  std::vector<char> crowded_;   ///< by cloth, in the last step
  bool found_ = false;          ///< pairs, at these levels
  double cells_passed_ = 0;
  bool may_be_tangled_ = true;
  int tangled_ = 0;
};

extern template class ClothContact<float>;
extern template class ClothContact<double>;

}  // namespace weft
