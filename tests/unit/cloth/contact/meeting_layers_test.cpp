// Which of a cloth's own features pass through each other on their ways in an implicit substep.
#include "cloth/contact/constraints/meeting_layers.h"

#include "fixtures.h"

namespace weft::test {
namespace {

constexpr double kMeetingGap = 0.01, kMeetingStep = 0.01;  // m; s

/// A strip of 1 x 3 cells of 0.1 m, folded: its last row lies `height` over its first one.
struct FoldedStrip {
  explicit FoldedStrip(double height) {
    const std::array<Vec3, 4> rows{Vec3(0, 0, 0), Vec3(0, 0, 0.1), Vec3(0, 0.05, 0.15),
                                   Vec3(0.02, height, 0.05)};
    each_node(grid, [&](int r, int c) {
      set(sheet.position, r, c, rows[static_cast<std::size_t>(r)] + Vec3(0.1 * c, 0, 0));
      sheet.mass.at(r, c) = sheet.inverse_mass.at(r, c) = 1;
    });
    const std::size_t count = grid.size();
    nodes.first = {0, static_cast<std::uint32_t>(count)};
    nodes.start.assign(count, Vec3(0, 0, 0));
    each_node(grid, [&](int r, int c) { nodes.start[grid.index(r, c)] = get(sheet.position, r, c); });
    nodes.end = nodes.start;
    nodes.velocity.assign(count, Vec3(0, 0, 0));
    nodes.inverse_mass.assign(count, 0);
    each_node(grid, [&](int r, int c) { nodes.inverse_mass[grid.index(r, c)] = 1; });
    nodes.tangled.assign(count, 0);
    search.set_grids({grid});
    search.find(nodes, 8 * kMeetingGap);
    begin();
  }
  void begin() {
    const std::array<const Particles<double>*, 1> starts{&sheet};
    meeting.begin<double>(starts, Substep{0, 1, kMeetingStep}, nodes, search);
  }
  /// With the last row moved by so much.
  std::vector<LayerPair> moved(const Vec3& by) {
    VectorField<double> to = sheet.position;
    for (int c = 0; c < grid.cols; ++c) set(to, 3, c, get(to, 3, c) + by);
    const std::array positions{kernels::components(std::as_const(to))};
    return meeting.find<double>(positions);
  }

  Grid grid = Grid::with_nodes(4, 2);
  Particles<double> sheet{grid};
  LayerNodes nodes;
  FeatureSearch search;
  MeetingLayers meeting{LayerParts({{grid, 0, kMeetingGap}}), LayerParameters{kMeetingGap / 10, 0.5}};
};

TEST(MeetingLayers, AreFoundWhereTheyPassThroughEachOther) {
  FoldedStrip strip(0.02);
  const std::vector<LayerPair> met = strip.moved({0, -0.04, 0});
  ASSERT_FALSE(met.empty());
  bool node_on_triangle = false;
  for (const LayerPair& pair : met) {
    if (pair.features.kind != FeaturePair::Kind::node_triangle) continue;
    // A node of the upper row comes down on the flat first cell.
    if (pair.features.node[0] < strip.grid.index(3, 0)) continue;
    node_on_triangle = true;
    EXPECT_NEAR(pair.normal.y(), 1, 1e-6);
    EXPECT_EQ(pair.gap, kMeetingGap);
  }
  EXPECT_TRUE(node_on_triangle);
}

TEST(MeetingLayers, ThereAreNoneWhereNothingMoves) {
  FoldedStrip strip(0.02);
  EXPECT_TRUE(strip.moved({0, 0, 0}).empty());
  EXPECT_TRUE(strip.moved({0, 0.04, 0}).empty()) << "or where it moves apart";
}

// In a substep it looks four times (DECISIONS.md); the next one begins anew.
TEST(MeetingLayers, AreLookedForOnlySoOftenInASubstep) {
  FoldedStrip strip(0.02);
  for (int round = 0; round < 4; ++round) EXPECT_FALSE(strip.moved({0, -0.04, 0}).empty()) << round;
  EXPECT_TRUE(strip.moved({0, -0.04, 0}).empty());
  strip.begin();
  EXPECT_FALSE(strip.moved({0, -0.04, 0}).empty());
}

}  // namespace
}  // namespace weft::test
