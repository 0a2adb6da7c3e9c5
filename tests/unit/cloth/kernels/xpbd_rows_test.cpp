#include "cloth/kernels/xpbd_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "random_lattice.h"

namespace weft::kernels::xpbd_rows {
namespace {

const Grid kSweptGrid = Grid::with_nodes(5, 23);
using LaneArray = std::vector<double, AlignedAllocator<double>>;

TEST(XpbdRows, RoundsUpToWholeGroups) {
  EXPECT_EQ(round_up(0, 8), 0);
  EXPECT_EQ(round_up(1, 8), 8);
  EXPECT_EQ(round_up(8, 8), 8);
  EXPECT_EQ(round_up(9, 8), 16);
}

/// Takes down which lanes a sweep joins, run by run.
struct Recorder {
  static constexpr bool kDamped = false;
  struct Joined {
    const double *a, *b;
    double share;
  };
  static inline std::vector<std::vector<Joined>> runs;

  static void apply(const Run<double>& run, const XpbdSprings<double>&, std::size_t) {
    std::vector<Joined>& joined = runs.emplace_back();
    joined.reserve(static_cast<std::size_t>(run.count));
    for (int i = 0; i < run.count; ++i) {
      if (run.stiffness[i] != 0) joined.push_back({run.a + i, run.b + i, run.share});
    }
  }
};

/// A sheet of 5 x 23 nodes, one family of springs on it.
struct SweptFamily {
  SweptFamily(int rows, int cols) {
    springs.rows = rows;
    springs.cols = cols;
    springs.rest_length = 0.1 * std::hypot(rows, cols);
    springs.border_row_share = 0.5;
    // By the lane of the left end: where the family's columns go left, that is the second one.
    const int across = std::abs(cols);
    for (int c = 0; c + across < kSweptGrid.cols; ++c) {
      stiffness[static_cast<std::size_t>(layout.lane(c))] = 3 + c;
    }
    springs.stiffness = stiffness.data();
  }
  const double* lane_of(int r, int c) const {
    return sheet.data() + static_cast<std::size_t>(r) * layout.row_size() + layout.lane(c);
  }

  const QuarterRows layout{kSweptGrid};
  XpbdSprings<double> springs;
  LaneArray sheet = LaneArray(layout.size(), 0.0), stiffness = LaneArray(layout.stride, 0.0);
};

// Each spring once, with its share of the stiffness, and no lane twice in a run.
TEST(XpbdRows, ASweepMeetsEachSpringOnce) {
  for (const auto& family : fixture::kLatticeFamilies) {
    SweptFamily swept(family[0], family[1]);
    Recorder::runs.clear();
    sweep<Recorder, false>(swept.layout, swept.springs, swept.sheet.data());
    std::multiset<std::pair<const double*, const double*>> found, expected;
    for (const std::vector<Recorder::Joined>& run : Recorder::runs) {
      std::set<const double*> lanes;
      for (const Recorder::Joined& joined : run) {
        EXPECT_TRUE(lanes.insert(joined.a).second);
        EXPECT_TRUE(lanes.insert(joined.b).second);
        found.emplace(std::min(joined.a, joined.b), std::max(joined.a, joined.b));
        const auto row = static_cast<std::size_t>(joined.a - swept.sheet.data()) / swept.layout.row_size();
        const bool border = family[0] == 0 && (row == 0 || row == 4);
        EXPECT_EQ(joined.share, border ? 0.5 : 1);
      }
    }
    for (int r = 0; r + family[0] < kSweptGrid.rows; ++r) {
      for (int c = 0; c < kSweptGrid.cols; ++c) {
        const int other = c + family[1];
        if (other < 0 || other >= kSweptGrid.cols) continue;
        const double *a = swept.lane_of(r, c), *b = swept.lane_of(r + family[0], other);
        expected.emplace(std::min(a, b), std::max(a, b));
      }
    }
    EXPECT_EQ(found, expected) << family[0] << ", " << family[1];
  }
}

// Two colours: springs of one share no node, so that their order says nothing. Within a row the colours are
// two runs each; between rows those that begin in every other `rows` rows.
TEST(XpbdRows, SpringsOfAColourShareNoNode) {
  for (const auto& family : fixture::kLatticeFamilies) {
    SweptFamily swept(family[0], family[1]);
    Recorder::runs.clear();
    sweep<Recorder, false>(swept.layout, swept.springs, swept.sheet.data());
    const std::size_t a_row = family[1] == 0 ? 1 : 4;
    std::size_t first_colour = 0;
    for (int r = 0; family[0] > 0 && r + family[0] < kSweptGrid.rows; ++r) {
      if (r / family[0] % 2 == 0) first_colour += a_row;
    }
    std::set<const double*> lanes;
    for (std::size_t i = 0; i < Recorder::runs.size(); ++i) {
      if (family[0] == 0 ? i % 2 == 0 : i == first_colour) lanes.clear();
      for (const Recorder::Joined& joined : Recorder::runs[i]) {
        EXPECT_TRUE(lanes.insert(joined.a).second) << family[0] << ", " << family[1];
        EXPECT_TRUE(lanes.insert(joined.b).second) << family[0] << ", " << family[1];
      }
    }
  }
}

/// One spring between the first two lanes of a layout of two rows, each end of its own inverse mass.
struct OneSpring {
  OneSpring(const Vec3& from, const Vec3& to, const Vec3& move_a, const Vec3& move_b) {
    for (int i = 0; i < 3; ++i) {
      put(a, i, from[i]), put(b, i, to[i]);
      put(a, QuarterRows::kMove + i, move_a[i]), put(b, QuarterRows::kMove + i, move_b[i]);
    }
    put(a, QuarterRows::kInverseMass, 2);
    put(b, QuarterRows::kInverseMass, 0.5);
    springs.rest_length = 1;
    springs.limit_length = 1.2;
    springs.excess = 4;
  }
  void put(LaneArray& end, int field, double value) { end[static_cast<std::size_t>(field)] = value; }
  static Vec3 move(const LaneArray& end) {
    return {end[QuarterRows::kMove], end[QuarterRows::kMove + 1], end[QuarterRows::kMove + 2]};
  }
  static Vec3 place(const LaneArray& end) { return Vec3(end[0], end[1], end[2]) + move(end); }
  double length() const { return (place(a) - place(b)).norm(); }
  /// Fields lie one scalar apart, as there is one lane.
  template <class Kind>
  void apply() {
    Kind::apply({a.data(), b.data(), &stiffness, 0.5, &multiplier, 1}, springs, 1);
  }

  LaneArray a = LaneArray(QuarterRows::kFields), b = LaneArray(QuarterRows::kFields);
  double stiffness = 3, multiplier = 0;  // k h^2, of which the run's share is a half
  XpbdSprings<double> springs;
};

// Eq. 26 of Macklin et al.: of the excess length l - l0 the two ends take up k w / (1 + k w), w = 2 + 0.5.
TEST(XpbdRows, AProjectionTakesUpItsShareOfTheStretch) {
  OneSpring spring({0, 0, 0}, {0.6, 0, 0.8}, {0.06, 0, 0.08}, {0.18, 0, 0.24});
  const double stretch = spring.length() - 1;
  EXPECT_NEAR(stretch, 0.2, 1e-15);
  spring.apply<Projection<double, false, false>>();
  EXPECT_NEAR(spring.length() - 1, stretch / (1 + 1.5 * 2.5), 1e-14);
}

// What each end's mass gains the other's loses.
TEST(XpbdRows, AProjectionKeepsMomentum) {
  OneSpring spring({0, 0, 0}, {1.1, 0.2, -0.3}, {0.02, 0.1, 0}, {0, -0.1, 0.05});
  const auto momentum = [&] { return Vec3(spring.move(spring.a) / 2 + spring.move(spring.b) / 0.5); };
  const Vec3 before = momentum();
  spring.springs.damping = 1.5;
  spring.apply<Projection<double, true, true>>();
  EXPECT_LT((momentum() - before).norm(), 1e-15);
  EXPECT_NE(spring.multiplier, 0);
}

// Of tension the larger of two straight lines: past 1.2 m the multiplier that meets k (l - 1 + 4 (l - 1.2)),
// short of it k (l - 1), each with the length that it leaves.
TEST(XpbdRows, ALimitedSpringsTensionIsThatOfTheLengthItIsLeftAt) {
  for (const double stretch : {-0.4, 0.15, 1.0, 3.0}) {
    OneSpring spring({0, 0, 0}, {1 + stretch, 0, 0}, {0, 0, 0}, {0, 0, 0});
    spring.apply<Projection<double, false, true>>();
    const double left = spring.length();
    const double tension = 1.5 * (left - 1 + 4 * std::max(0.0, left - 1.2));
    EXPECT_NEAR(spring.move(spring.a).x(), 2 * tension, 1e-13) << stretch;
    EXPECT_NEAR(spring.move(spring.b).x(), -0.5 * tension, 1e-13) << stretch;
  }
}

TEST(XpbdRows, CoincidentEndsStay) {
  OneSpring spring({1, 2, 3}, {1, 2, 3}, {0, 0, 0}, {0, 0, 0});
  spring.apply<Projection<double, false, true>>();
  EXPECT_TRUE(spring.move(spring.a).isZero(0));
  EXPECT_TRUE(spring.move(spring.b).isZero(0));
}

// gamma / (1 + gamma) = 3/4 of the last multiplier moves the ends by their inverse masses, and is kept.
TEST(XpbdRows, RecallBeginsWithWhatIsKept) {
  OneSpring spring({0, 0, 0}, {0.6, 0, 0.8}, {0, 0, 0}, {0, 0, 0});
  spring.springs.damping = 3;
  spring.multiplier = -0.02;
  spring.apply<Recall<double>>();
  EXPECT_NEAR(spring.multiplier, -0.015, 1e-17);
  EXPECT_LT((spring.move(spring.a) - 2 * 0.015 * Vec3(0.6, 0, 0.8)).norm(), 1e-16);
  EXPECT_LT((spring.move(spring.b) + 0.5 * 0.015 * Vec3(0.6, 0, 0.8)).norm(), 1e-16);
}

// One that turns round begins from zero, and so does one that doubles.
TEST(XpbdRows, RecallForgetsSpringsThatTurnOrDouble) {
  for (const Vec3& move : {Vec3(-2, 0, 0), Vec3(1.1, 0, 0)}) {
    OneSpring spring({0, 0, 0}, {1, 0, 0}, {0, 0, 0}, move);
    spring.springs.damping = 3;
    spring.multiplier = -0.02;
    spring.apply<Recall<double>>();
    EXPECT_EQ(spring.multiplier, 0);
    EXPECT_EQ(spring.move(spring.b), move);
  }
}

}  // namespace
}  // namespace weft::kernels::xpbd_rows
