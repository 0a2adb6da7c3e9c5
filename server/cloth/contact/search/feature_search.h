#pragma once
#include "cloth/contact/constraints/layer_nodes.h"
#include "cloth/contact/search/cell_features.h"

namespace weft {

/// An edge that passes through a triangle with which it shares no node. Indices into LayerNodes.
struct Crossing {
  std::array<std::uint32_t, 2> edge{};
  std::array<std::uint32_t, 2> across{};  ///< third nodes of the triangles beside the edge; the same at a rim
  std::array<std::uint32_t, 3> triangle{};
};

/// Finds the features that come near each other on their ways from LayerNodes::start to ::end, of one cloth
/// and of different ones. A cell is two triangles, as drawn: its diagonal is the one from its top left to its
/// bottom right node. What shares a node is no pair. Of a torn sheet what is drawn has features: whole cells,
/// their edges and nodes; where it is torn it has a border. The order of the pairs follows from the grids
/// alone.
///
/// Cloth can be packed so densely that everything is near everything: of a cell no more than kMostOfCell
/// pairs are found, and kMost in all: of 64 x 64 cells in a point there were 100 million. What is beyond
/// is not felt, and told (crowded).
class FeatureSearch {
 public:
  static constexpr std::size_t kMostOfCell = 1024, kMost = std::size_t{1} << 22;

  /// Cloths of these grids, whole.
  void set_grids(const std::vector<Grid>& grids);
  /// What is cut of a cloth, counted from 0, at its grid.
  void set_torn(std::size_t sheet, const TornLinks& torn);

  /// All pairs that come as near as `margin`, m, and some more. Those of tangled nodes are left out. Valid
  /// until the next call.
  const std::vector<FeaturePair>& find(const LayerNodes& nodes, double margin);
  /// What was found last, for the same starts, with all that come as near as `margin`. What belongs to nodes
  /// whose ends are others by now than can be told from it is found again; if these are many, all is, with
  /// the margin `again`.
  const std::vector<FeaturePair>& found(const LayerNodes& nodes, double margin, double again);
  /// Goes on from what `other` has found: these are its nodes from each `first` on, a whole sheet each.
  void take_over(const FeatureSearch& other, const std::vector<std::uint32_t>& first,
                 const LayerNodes& nodes);
  /// Nothing was found.
  void forget() { margin_ = 0; }
  /// The last search's pairs, valid until the next one, and its margin, m: 0 if nothing was found.
  const std::vector<FeaturePair>& pairs() const { return pairs_; }
  double margin() const { return margin_; }
  /// Of this cloth, counted from 0, the last search left out what was beyond its bounds.
  bool crowded(std::size_t sheet) const { return sheets_[sheet].crowded; }
  /// The pairs of cells that the last search went through, and how many searches there were.
  std::size_t cell_pairs() const { return cell_pairs_; }
  std::size_t searches() const { return searches_; }
  /// Where cloth passes through cloth at `start`.
  std::vector<Crossing> find_crossings(const LayerNodes& nodes);

  /// What lasts from step to step (world/state.h); of the same sheets, cut alike.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(start_, end_, margin_, pairs_, cell_pairs_);
    for (Sheet& sheet : sheets_) archive(sheet.found, sheet.crowded);
  }

 private:
  struct Sheet {
    Sheet(const Grid& grid, std::uint32_t first_node) : tree(grid), first(first_node) {}
    PatchTree tree;
    std::uint32_t first;
    std::vector<std::uint16_t> left;   ///< of each cell's own features, as bits; empty while it is whole
    std::vector<std::uint16_t> found;  ///< pairs of each cell
    std::vector<CellFeatures> features;
    std::vector<std::size_t> seen;  ///< of each cell, the last search that has made its features
    bool crowded = false;
  };
  /// Of a cell above or before another one.
  static bool has_triangles(const Sheet& sheet, int row, int col);
  /// Calls visit(index) for the nodes of all sheets.
  template <class Visit>
  void for_each_node(Visit visit) const;
  bool has_strayed(const FeaturePair& pair) const;
  /// To the ways from `nodes`' starts to end_.
  void fit(Sheet& sheet, const LayerNodes& nodes);
  /// In the search under way; made when first asked for.
  const CellFeatures& features(Sheet& sheet, Cell cell, const LayerNodes& nodes);
  /// Adds what comes as near as margin_ on its ways to end_; of strayed nodes alone, or all.
  void search(const LayerNodes& nodes, bool of_strayed);
  /// Calls visit(sheet a, sheet b) with cells_ for all that come near.
  template <class Visit>
  void for_each_sheets(double margin, Visit visit);

  std::vector<Sheet> sheets_;
  std::vector<Vec3> start_, end_;  ///< of the last search, ends as seen from the common motion
  std::vector<char> strayed_;      ///< nodes that end elsewhere than it saw them
  double margin_ = 0;              ///< of it
  std::vector<std::array<Cell, 2>> cells_;
  std::vector<FeaturePair> pairs_;
  std::size_t cell_pairs_ = 0, searches_ = 0;
};

}  // namespace weft
